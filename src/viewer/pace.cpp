// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/viewer/pace.h"

#include <algorithm>

namespace lidar::viewer {
namespace {

/// A delay that is at most this much longer than the shortest delay confirms the shortest delay. A
/// page draws only once per frame of the display.
constexpr Duration kSameDelay = std::chrono::milliseconds(20);
/// A scan may exceed max-bitrate by the data of this time, because a scan is sent at once.
constexpr Duration kCredit = std::chrono::milliseconds(100);

}  // namespace

bool Pace::MayBegin(Time now) {
  Refill(now);
  if (max_bitrate_ > DataRate() && credit_ < DataSize()) return false;
  if (sent_.empty()) return true;
  if (!shortest_) return begun_ < kFirstScans;
  return now - shortest_at_ <= kDelayMemory && !IsLate(now);
}

bool Pace::IsLate(Time now) const {
  if (sent_.empty()) return false;
  if (now - sent_.front().at > kPatience) return true;
  return shortest_ && unacknowledged_ / rate() > *shortest_ + kSlack;
}

void Pace::OnSent(Time now, SliceId slice, DataSize size) {
  const bool alone = sent_.empty();
  if (alone) acknowledged_at_ = now;
  if (alone || sent_.back().slice.scan != slice.scan) ++begun_;
  sent_.push_back({slice, size, now, acknowledged_, acknowledged_at_, alone});
  unacknowledged_ += size;
  Spend(now, size);
}

void Pace::OnDrawn(Time now, SliceId slice) {
  const auto named = std::find_if(sent_.rbegin(), sent_.rend(), [slice](const Sent& s) {
    return s.slice.scan == slice.scan && s.slice.index == slice.index;
  });
  if (named == sent_.rend()) return;
  const Sent newest = *named;
  const bool alone = sent_.front().alone;
  const auto end = named.base();
  for (auto it = sent_.begin(); it != end; ++it) {
    acknowledged_ += it->size;
    unacknowledged_ -= it->size;
  }
  sent_.erase(sent_.begin(), end);
  acknowledged_at_ = now;
  LearnDelay(now, now - newest.at, alone);
  const Duration since = now - newest.acknowledged_at;
  if (since > Duration::zero())
    LearnRate(now, (acknowledged_ - newest.acknowledged_before) / since);
}

/// Updates the shortest delay. If the shortest delay is old, a delay that was measured without
/// other traffic replaces it, even if the new delay is longer.
void Pace::LearnDelay(Time now, Duration delay, bool alone) {
  const bool is_old = now - shortest_at_ > kDelayMemory && alone;
  if (shortest_ && !is_old && delay > *shortest_ + kSameDelay) return;
  shortest_ = shortest_ && !is_old ? std::min(*shortest_, delay) : delay;
  shortest_at_ = now;
}

void Pace::LearnRate(Time now, DataRate rate) {
  while (!rate_.empty() && rate_.back().rate <= rate) rate_.pop_back();
  rate_.push_back({rate, now});
  while (rate_.size() > 1 && now - rate_.front().at > kRateMemory) rate_.pop_front();
}

void Pace::Refill(Time now) {
  if (now <= filled_) return;
  const DataSize most = max_bitrate_ * kCredit;
  const DataSize gained =
      max_bitrate_ * std::min<Duration>(now - filled_, std::chrono::seconds(60));
  credit_ = std::min(credit_ + gained, most);
  filled_ = now;
}

void Pace::Spend(Time now, DataSize size) {
  if (max_bitrate_ <= DataRate()) return;
  Refill(now);
  credit_ -= size;
}

}  // namespace lidar::viewer
