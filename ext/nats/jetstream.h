// SPDX-License-Identifier: LGPL-2.1-or-later
// Streams of JetStream: what the server keeps on its disk.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "ext/nats/nats_ptr.h"
#include "src/base/time.h"

namespace lidar::nats {

struct StreamSettings {
  std::string name;             // empty: nothing is kept
  Duration max_age{};           // 0: no limit
  std::uint64_t max_bytes = 0;  // 0: no limit
  unsigned replicas = 1;        // servers of a cluster that keep a copy
  std::string subjects;         // a pattern; empty: those of its maker
};

constexpr std::int64_t kRequestTimeoutMs = 1'000;

JetStreamPtr OpenJetStream(natsConnection* connection);

/// Makes the stream, or changes one that is there, so that it keeps `subjects`. False, and `why`,
/// where the server does not do it.
bool EnsureStream(jsCtx* js, const StreamSettings& settings,
                  const std::vector<std::string>& subjects, std::string* why);

/// Whether `pattern`, which may have wildcards, covers `subject`, which may have them, too.
bool Covers(const std::string& pattern, const std::string& subject);

/// What is wrong with the name of a stream, a consumer or a queue group; empty: nothing.
std::string CheckName(const std::string& name);

}  // namespace lidar::nats
