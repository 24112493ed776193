// SPDX-License-Identifier: LGPL-2.1-or-later
// Writes to a bucket of NATS's key-value store without waiting: answers come later, and a silent
// server delays no thread.
#pragma once
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "ext/nats/answers.h"
#include "ext/nats/nats_ptr.h"

namespace lidar::worker {

/// For one thread.
class LeaseStore {
 public:
  struct Answer {
    std::uint64_t ticket = 0;
    std::optional<std::uint64_t> revision;  // of the stored entry; empty: refused
    std::optional<std::uint64_t> newest;    // revision that caused a refusal, if known
  };

  /// The bucket may be created later. Throws std::runtime_error.
  LeaseStore(natsConnection* connection, const std::string& bucket);

  /// Replaces the entry of `key` whose revision is `replaces`; 0: there must be no entry.
  void Write(std::uint64_t ticket, const std::string& key, std::uint64_t replaces,
             const std::string& text);
  std::optional<Answer> NextAnswer(std::chrono::milliseconds timeout);

  /// The subject of a key, or of all keys: ">".
  static std::string Subject(const std::string& bucket, const std::string& key);

 private:
  natsConnection* const connection_;
  const std::string bucket_;
  const std::optional<nats::AnswerSubjects> subjects_;
  lidar::nats::SubscriptionPtr answers_;
};

/// Returns the content of JetStream's answer, without the ticket; nothing for other messages.
std::optional<LeaseStore::Answer> ParseAnswer(const std::string& text);

}  // namespace lidar::worker
