// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/link/oracle.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>

namespace lidar::link {
namespace {

constexpr Duration kTick = std::chrono::microseconds{500};

class Sender {
 public:
  explicit Sender(const OracleConfig& config)
      : config_(config),
        period_(1 / (config.scans_per_second * config.slices_per_scan)),
        bits_(config.rate.bits_per_second() * period_),
        scans_(static_cast<std::size_t>(
            std::ceil(Seconds(config.duration) * config.scans_per_second) + 1)) {}

  void Step(double now, double bits) {
    if (now >= static_cast<double>(made_) * period_) {
      queue_.push_back({made_ / config_.slices_per_scan, made_ % config_.slices_per_scan == 0,
                        static_cast<double>(made_) * period_, bits_});
      ++made_;
    }
    while (!queue_.empty() && bits > 0) {
      Slice& head = queue_.front();
      if (!IsWanted(head, now)) {
        queue_.pop_front();
        continue;
      }
      const double sent = std::min(bits, head.bits_left);
      head.bits_left -= sent;
      bits -= sent;
      if (head.bits_left <= kRounding) Arrive(now);
    }
  }

  OracleResult Finish() {
    result_.scans =
        static_cast<std::uint64_t>(Seconds(config_.duration) * config_.scans_per_second);
    for (const Scan& scan : scans_) result_.complete += scan.arrived == config_.slices_per_scan;
    std::sort(result_.latency_ms.begin(), result_.latency_ms.end());
    return std::move(result_);
  }

 private:
  static constexpr double kRounding = 1e-6;  // bits
  struct Slice {
    std::uint64_t scan = 0;
    bool first = false;
    double captured = 0;
    double bits_left = 0;
  };
  struct Scan {
    std::uint32_t arrived = 0;
    bool dropped = false;
  };

  /// Returns false for slices of dropped scans. A scan is dropped only before its first bit is
  /// sent. Otherwise the scan is finished.
  bool IsWanted(const Slice& slice, double now) {
    Scan& scan = scans_[slice.scan];
    const bool begins = slice.first && slice.bits_left >= bits_;
    if (begins && now - slice.captured > Seconds(config_.max_age) &&
        queue_.size() > config_.slices_per_scan)
      scan.dropped = true;
    return !scan.dropped;
  }

  void Arrive(double now) {
    const Slice& head = queue_.front();
    ++scans_[head.scan].arrived;
    result_.latency_ms.push_back((now - head.captured) * 1e3 + Milliseconds(config_.rtt) / 2);
    queue_.pop_front();
  }

  OracleConfig config_;
  double period_;  // time between slices [s]
  double bits_;    // bits of a slice
  std::vector<Scan> scans_;
  std::deque<Slice> queue_;
  std::uint64_t made_ = 0;
  OracleResult result_;
};

/// The links, each behind a pacer that sends at the rate which the link had `delay` earlier. A
/// slice is delivered when both the pacer and the link have finished it.
class PacedLinks {
 public:
  PacedLinks(const std::vector<Capacity>& links, Duration delay)
      : links_(links), delay_(delay), free_(links.size()), ends_(links.size()) {}

  /// Sends a slice that is made at `now`. Returns the time at which it is delivered, or nothing if
  /// no link delivers it by `deadline`.
  std::optional<Duration> Send(Duration now, Duration deadline, DataSize size, Bonding bonding) {
    for (std::size_t i = 0; i < links_.size(); ++i) ends_[i] = Ends(i, now, size);
    const auto first = std::min_element(
        ends_.begin(), ends_.end(), [](const Times& a, const Times& b) { return a.link < b.link; });
    if (first == ends_.end() || first->link > deadline) return std::nullopt;
    const auto best = static_cast<std::size_t>(first - ends_.begin());
    for (std::size_t i = 0; i < links_.size(); ++i)
      if (i == best || (bonding == Bonding::kOnEach && ends_[i].link <= deadline))
        free_[i] = ends_[i];
    return first->link;
  }

 private:
  struct Times {
    Duration pacer{0}, link{0};
  };

  Times Ends(std::size_t i, Duration now, DataSize size) const {
    const Duration start = std::max(now, free_[i].pacer);
    const Duration known = links_[i].Finish(start - delay_, size);
    const Duration pacer = known < Duration::max() - delay_ ? known + delay_ : Duration::max();
    return {pacer, std::max(pacer, links_[i].Finish(std::max(start, free_[i].link), size))};
  }

  const std::vector<Capacity>& links_;
  Duration delay_;
  std::vector<Times> free_;  // times at which pacers and links become free
  std::vector<Times> ends_;  // times at which pacers and links finish the slice
};

bool IsEmpty(const OracleConfig& c) {
  return !(c.rate > DataRate{}) || !(c.scans_per_second > 0) || c.slices_per_scan == 0;
}

}  // namespace

double OracleResult::Latency(double percent) const {
  if (latency_ms.empty()) return 0;
  const auto index =
      static_cast<std::size_t>(percent / 100 * static_cast<double>(latency_ms.size()));
  return latency_ms[std::min(index, latency_ms.size() - 1)];
}

OracleResult AskOracle(const Capacity& capacity, const OracleConfig& config) {
  if (IsEmpty(config)) return {};
  Sender sender(config);
  for (Duration t{0}; t < config.duration; t += kTick)
    sender.Step(Seconds(t), capacity.RateAt(t).bits_per_second() * config.share * Seconds(kTick));
  return sender.Finish();
}

OracleResult AskOracleOfLinks(const std::vector<Capacity>& links, const OracleConfig& config,
                              Bonding bonding) {
  if (IsEmpty(config)) return {};
  OracleResult result;
  result.scans = static_cast<std::uint64_t>(Seconds(config.duration) * config.scans_per_second);
  const double period = 1 / (config.scans_per_second * config.slices_per_scan);
  const DataSize size = config.rate * FromSeconds(period);
  PacedLinks paced(links, config.known_after);
  for (std::uint64_t scan = 0; scan < result.scans; ++scan) {
    std::uint32_t whole = 0;
    for (std::uint32_t i = 0; i < config.slices_per_scan; ++i) {
      const Duration now =
          FromSeconds(static_cast<double>(scan * config.slices_per_scan + i) * period);
      const auto end = paced.Send(now, now + config.max_age - config.rtt / 2, size, bonding);
      if (!end) continue;
      ++whole;
      result.latency_ms.push_back(Milliseconds(*end - now) + Milliseconds(config.rtt) / 2);
    }
    result.complete += whole == config.slices_per_scan;
  }
  std::sort(result.latency_ms.begin(), result.latency_ms.end());
  return result;
}

}  // namespace lidar::link
