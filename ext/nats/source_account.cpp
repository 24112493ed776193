// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/nats/source_account.h"

namespace lidar::nats {

SourceCounters SourceAccount::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

void SourceAccount::Reset() {
  places_ = {};
  const std::lock_guard lock(mutex_);
  counters_ = {};
}

void SourceAccount::Count(std::uint64_t SourceCounters::*counter) {
  const std::lock_guard lock(mutex_);
  ++(counters_.*counter);
}

void SourceAccount::NoteTaken(std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  ++counters_.messages;
  counters_.bytes += bytes;
}

void SourceAccount::NoteSubscriber(const Subscriber& subscriber) {
  const ConnectionState now = subscriber.connection();
  const std::lock_guard lock(mutex_);
  counters_.connected = now.connected();
  counters_.reconnects = now.connections > 0 ? now.connections - 1 : 0;
  counters_.overruns = subscriber.overruns();
  counters_.damaged_formats = subscriber.damaged_formats();
}

void SourceAccount::NoteStop() {
  const std::lock_guard lock(mutex_);
  counters_.connected = false;
}

SourceAccount::Verdict SourceAccount::NotePlace(const Place& place, bool shared) {
  const PlaceBook::Verdict verdict = places_.Note(place);
  const std::lock_guard lock(mutex_);
  if (verdict.again) ++counters_.again;
  if (verdict.late) ++counters_.late;
  if (verdict.again || shared) return {verdict.again, false};
  counters_.lost += verdict.missing;
  if (verdict.fills_gap && counters_.lost > 0) --counters_.lost;
  return {false, verdict.missing > 0};
}

}  // namespace lidar::nats
