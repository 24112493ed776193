// SPDX-License-Identifier: LGPL-2.1-or-later
// The subjects on which answers to published messages arrive, and the meaning of JetStream's
// answers.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "ext/nats/nats_ptr.h"

namespace lidar::nats {

/// The reply subjects of published messages. They share a unique prefix. The sender chooses the
/// last word for each message.
class AnswerSubjects {
 public:
  /// Makes subjects with a new prefix. Returns nothing if memory is short.
  static std::optional<AnswerSubjects> Make();

  std::string Of(const std::string& word) const { return prefix_ + word; }
  std::string Of(std::uint64_t number) const { return Of(std::to_string(number)); }
  std::string All() const { return prefix_ + "*"; }
  /// Returns the last word of the subject of `answer`, or an empty text if the subject has another
  /// prefix.
  std::string_view WordOf(natsMsg* answer) const;

 private:
  explicit AnswerSubjects(std::string prefix) : prefix_(std::move(prefix)) {}
  std::string prefix_;
};

/// Converts `text` to a number. Returns nothing if `text` is not a number or if the number is too
/// large.
std::optional<std::uint64_t> ToNumber(std::string_view text);

/// Returns the reason why JetStream did not store a message. The reason is empty if JetStream
/// stored the message.
std::string ErrorOfAck(natsMsg* answer);
/// Returns true if JetStream refused the message because it exceeds the stream's max_msg_size.
bool IsTooLarge(natsMsg* answer);

}  // namespace lidar::nats
