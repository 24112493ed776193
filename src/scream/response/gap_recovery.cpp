// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/scream/response/gap_recovery.h"

#include <algorithm>
#include <utility>

namespace lidar::scream {
namespace {

/// A link that carries less than this part of its earlier capacity is in a gap.
constexpr double kGapPart = 0.25;
/// A longer gap is the link's new capacity.
constexpr Duration kLongestMemory = 3s;
constexpr Duration kLongestGap = 10s;
/// Delay without a queue, apart from a few packets that came together.
constexpr Duration kNoQueue = 5ms;
/// Part of the missing window that is restored each round trip while nothing measures the link.
constexpr double kUnprovenPart = 0.5;
constexpr double kRestoredPart = 0.9;

}  // namespace

std::optional<GapRecovery::Restart> GapRecovery::Update(Time now, const PathModel& path,
                                                        DataSize ref_wnd) {
  if (!p_.extensions.gaps) return std::nullopt;
  const auto rate = path.busy_run().latest_capacity();
  if (Slow(rate)) BelieveLess();
  if (path.hole_in_report() || Slow(rate)) NoteSign(now);
  if (!last_sign_) {
    const bool calm = path.queue_delay().qdelay() < path.BusyQdelay(now);
    if (calm) Remember(path, ref_wnd);
    return std::nullopt;
  }
  if (now - *last_sign_ > kLongestMemory || now - first_sign_ > kLongestGap) before_.reset();
  if (!before_) last_sign_.reset();
  if (!last_sign_ || path.hole_in_report()) return std::nullopt;
  const auto window = rate ? Measured(*rate, path) : Unproven(now, path, ref_wnd);
  if (!window) return std::nullopt;
  Restart restart = before_->state;
  restart.window = std::max(ref_wnd, std::min(*window, before_->state.window));
  unproven_ = rate ? std::nullopt : std::optional(restart.window);
  if (rate || restart.window >= before_->state.window * kRestoredPart) last_sign_.reset();
  last_restart_ = now;
  return restart;
}

bool GapRecovery::Slow(std::optional<DataRate> rate) const {
  return before_ && rate && *rate < before_->rate * kGapPart;
}

/// A restored window ended behind a slow link: lowers the remembered rate.
void GapRecovery::BelieveLess() {
  const auto tried = std::exchange(unproven_, std::nullopt);
  if (!tried || *tried >= before_->state.window) return;
  before_->rate = before_->rate * (*tried / before_->state.window);
  before_->state.window = *tried;
}

void GapRecovery::NoteSign(Time now) {
  if (!last_sign_) first_sign_ = now;
  last_sign_ = now;
}

void GapRecovery::Remember(const PathModel& path, DataSize ref_wnd) {
  unproven_.reset();
  before_ = Before{{ref_wnd, path.rtt().smoothed(), path.l4s_alpha().value()},
                   ref_wnd / path.rtt().smoothed() / p_.target_rate_divisor};
}

std::optional<DataSize> GapRecovery::Measured(DataRate rate, const PathModel& path) const {
  if (rate < before_->rate * kGapPart) return std::nullopt;
  return rate * path.rtt().min() * p_.target_rate_divisor;
}

std::optional<DataSize> GapRecovery::Unproven(Time now, const PathModel& path,
                                              DataSize ref_wnd) const {
  // Packets before the newest may have marks from the gap.
  const bool calm = path.queue_delay().qdelay() < kNoQueue && !path.newest_marked();
  if (!calm || now - last_restart_ < path.rtt().min()) return std::nullopt;
  return ref_wnd + (before_->state.window - ref_wnd) * kUnprovenPart;
}

}  // namespace lidar::scream
