// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/ouster/capture_index.h"

#include <algorithm>

namespace lidar::ouster {
namespace {

constexpr Duration kEntryInterval = std::chrono::milliseconds(100);
constexpr int kDatagramsPerQuestion = 256;

}  // namespace

bool CaptureIndex::ReadUntil(Duration time, const std::function<bool()>& go_on) {
  for (int n = 0; reader_ && (!first_ || duration() < time); ++n) {
    if (n % kDatagramsPerQuestion == 0 && !go_on()) return false;
    const auto offset = reader_->Offset();
    const auto captured = reader_->Next();
    if (!captured) {
      reader_.reset();
      return true;
    }
    if (first_ && offset &&
        (entries_.empty() || duration() - entries_.back().time > kEntryInterval))
      entries_.push_back({duration(), *offset});
    if (!first_) first_ = captured->time;
    last_ = std::max({last_, *first_, captured->time});
  }
  return true;
}

std::optional<std::int64_t> CaptureIndex::OffsetBefore(Duration time) const {
  const auto after = std::lower_bound(entries_.begin(), entries_.end(), time,
                                      [](const Entry& e, Duration t) { return e.time < t; });
  if (after == entries_.begin()) return std::nullopt;
  return std::prev(after)->offset;
}

}  // namespace lidar::ouster
