// SPDX-License-Identifier: LGPL-2.1-or-later
// Writes to a bucket of NATS's key-value store. Does not wait for the answers, so that a silent
// server delays no thread.
#pragma once
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "ext/nats/answers.h"
#include "ext/nats/nats_ptr.h"

namespace lidar::worker {

/// Writes entries, and receives the answers later. Only one thread may use it.
class LeaseStore {
 public:
  struct Answer {
    std::uint64_t ticket = 0;
    // The revision of the stored entry. Empty if the write was refused.
    std::optional<std::uint64_t> revision;
    // The newest revision of the entry, which caused the refusal, if known.
    std::optional<std::uint64_t> newest;
  };

  /// The bucket need not exist yet. Throws std::runtime_error if NATS cannot be used.
  LeaseStore(natsConnection* connection, const std::string& bucket);

  /// Replaces the entry of `key` if the newest revision of this entry is `replaces`. If `replaces`
  /// is 0, writes the entry only if there is none yet.
  void Write(std::uint64_t ticket, const std::string& key, std::uint64_t replaces,
             const std::string& text);
  std::optional<Answer> NextAnswer(std::chrono::milliseconds timeout);

  /// Returns the subject of `key`. The key ">" stands for all keys.
  static std::string Subject(const std::string& bucket, const std::string& key);

 private:
  natsConnection* const connection_;
  const std::string bucket_;
  const std::optional<nats::AnswerSubjects> subjects_;
  lidar::nats::SubscriptionPtr answers_;
};

/// Parses an answer of JetStream, except for the ticket. Returns nothing for other messages.
std::optional<LeaseStore::Answer> ParseAnswer(const std::string& text);

}  // namespace lidar::worker
