// SPDX-License-Identifier: LGPL-2.1-or-later
// Subjects on which answers to our messages arrive, and the meaning of JetStream's answers.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "ext/nats/nats_ptr.h"

namespace lidar::nats {

/// A message names one of these subjects for its answer. The sender chooses the last word.
class AnswerSubjects {
 public:
  /// Returns nothing if memory is short.
  static std::optional<AnswerSubjects> Make();

  std::string Of(const std::string& word) const { return prefix_ + word; }
  std::string Of(std::uint64_t number) const { return Of(std::to_string(number)); }
  std::string All() const { return prefix_ + "*"; }
  /// Returns the word of the message that `answer` belongs to; empty if `answer` has another
  /// subject.
  std::string_view WordOf(natsMsg* answer) const;

 private:
  explicit AnswerSubjects(std::string prefix) : prefix_(std::move(prefix)) {}
  std::string prefix_;
};

/// Returns `text` as a number, or nothing if other characters are in it.
std::optional<std::uint64_t> ToNumber(std::string_view text);

/// The reason why JetStream did not store a message; empty if it did.
std::string ErrorOfAck(natsMsg* answer);
/// Returns true if the message exceeds the stream's max_msg_size.
bool IsTooLarge(natsMsg* answer);

}  // namespace lidar::nats
