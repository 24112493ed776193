// SPDX-License-Identifier: LGPL-2.1-or-later
// Streams of JetStream, which the server keeps on its disk.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "ext/nats/nats_ptr.h"
#include "src/base/time.h"

namespace lidar::nats {

struct StreamSettings {
  std::string name;             // empty: no stream
  Duration max_age{};           // 0: no limit
  std::uint64_t max_bytes = 0;  // 0: no limit
  unsigned replicas = 1;        // number of servers of a cluster that keep a copy
  std::string subjects;         // a pattern; empty: the subjects of the sink
};

constexpr std::int64_t kRequestTimeoutMs = 1'000;

JetStreamPtr OpenJetStream(natsConnection* connection);

/// Makes the stream `settings.name`. If the stream exists, changes it to keep `subjects`, too.
/// Returns false and sets `why` if the server refuses.
bool EnsureStream(jsCtx* js, const StreamSettings& settings,
                  const std::vector<std::string>& subjects, std::string* why);

/// Returns true if `pattern` matches all subjects that `subject` matches. Both may have wildcards.
bool Covers(const std::string& pattern, const std::string& subject);

/// Returns what is wrong with the name of a stream, a consumer or a queue group, or an empty text
/// if nothing is wrong.
std::string CheckName(const std::string& name);

}  // namespace lidar::nats
