// SPDX-License-Identifier: LGPL-2.1-or-later
// Our own subjects, on which answers to messages come back, and what answers of JetStream say.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "ext/nats/nats_ptr.h"

namespace lidar::nats {

/// Each message names one of them, which ends with a word of the sender's.
class AnswerSubjects {
 public:
  /// None where memory is short.
  static std::optional<AnswerSubjects> Make();

  std::string Of(const std::string& word) const { return prefix_ + word; }
  std::string Of(std::uint64_t number) const { return Of(std::to_string(number)); }
  std::string All() const { return prefix_ + "*"; }
  /// What an answer is to; empty where it is none.
  std::string_view WordOf(natsMsg* answer) const;

 private:
  explicit AnswerSubjects(std::string prefix) : prefix_(std::move(prefix)) {}
  std::string prefix_;
};

/// All of `text` as a number.
std::optional<std::uint64_t> ToNumber(std::string_view text);

/// Why JetStream did not store a message; empty: it did.
std::string ErrorOfAck(natsMsg* answer);

}  // namespace lidar::nats
