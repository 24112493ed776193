// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/sim/late_sender.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>
#include <vector>

#include "src/sim/simulation.h"

namespace lidar::loop {
namespace {

constexpr Duration kTick = std::chrono::microseconds{500};
constexpr double kPacketBits = 9600;
/// The rate at which the sender's queue drains, relative to the known capacity.
constexpr double kPacing = 1.25;

/// All times are in seconds, and all sizes are in bits.
class LateSender {
 public:
  explicit LateSender(const LateSenderConfig& config)
      : c_(config),
        period_(1 / (config.scans_per_second * config.slices_per_scan)),
        scans_(static_cast<std::size_t>(
            std::ceil(Seconds(config.duration) * config.scans_per_second) + 1)) {}

  void Step(double now, double rate, double known_rate) {
    Capture(now, known_rate);
    while (!acked_.empty() && acked_.front().at <= now) {
      in_flight_ -= acked_.front().bits;
      acked_.pop_front();
    }
    Send(now, known_rate);
    Carry(now, rate * Seconds(kTick));
    usable_ += std::min(rate, c_.max.bits_per_second()) * Seconds(kTick);
  }

  LateSenderReport Finish() {
    LateSenderReport report;
    for (const Scan& scan : scans_) {
      report.complete += scan.arrived == c_.slices_per_scan;
      report.in_time += scan.in_time == c_.slices_per_scan;
    }
    report.utilisation = carried_ / usable_;
    report.queue_p95_ms = scream::test::Summarise(std::move(queue_ms_)).p95;
    return report;
  }

 private:
  struct Slice {
    std::uint64_t scan = 0;
    double captured = 0;
    double bits_left = 0;
    bool begun = false;
  };
  struct Packet {
    double bits = 0;
    double bits_left = 0;
    double sent = 0;
    Slice slice;  // copy of the slice when this packet was sent
  };
  struct Ack {
    double at = 0;
    double bits = 0;
  };
  struct Scan {
    std::uint32_t arrived = 0;
    std::uint32_t in_time = 0;
  };

  void Capture(double now, double known_rate) {
    if (now < static_cast<double>(made_) * period_) return;
    const double rate =
        std::clamp(c_.share * known_rate, c_.min.bits_per_second(), c_.max.bits_per_second());
    waiting_.push_back({made_++ / c_.slices_per_scan, now, rate * period_});
  }

  void Send(double now, double known_rate) {
    const auto late = [&](const Slice& slice) {
      return !slice.begun && now - slice.captured > Seconds(c_.max_queue_delay);
    };
    while (!waiting_.empty() && late(waiting_.front())) waiting_.pop_front();
    const double window = std::max(known_rate * Seconds(c_.rtt), kPacketBits);
    allowed_ = std::min(
        allowed_ + std::max(known_rate, c_.min.bits_per_second()) * kPacing * Seconds(kTick),
        2 * kPacketBits);
    while (!waiting_.empty()) {
      Slice& slice = waiting_.front();
      const double bits = std::min(kPacketBits, slice.bits_left);
      if (bits > allowed_ || (in_flight_ > 0 && in_flight_ + bits > window)) return;
      slice.begun = true;
      slice.bits_left -= bits;
      allowed_ -= bits;
      in_flight_ += bits;
      network_.push_back({bits, bits, now, slice});
      if (slice.bits_left <= 0) waiting_.pop_front();
    }
  }

  void Carry(double now, double bits) {
    while (!network_.empty() && bits > 0) {
      Packet& packet = network_.front();
      const double carried = std::min(bits, packet.bits_left);
      packet.bits_left -= carried;
      bits -= carried;
      if (packet.bits_left > 0) return;
      carried_ += packet.bits;
      acked_.push_back({now + Seconds(c_.rtt), packet.bits});
      queue_ms_.push_back((now - packet.sent) * 1e3);
      if (packet.slice.bits_left <= 0) Arrive(now + Seconds(c_.rtt) / 2, packet.slice);
      network_.pop_front();
    }
  }

  void Arrive(double at, const Slice& slice) {
    Scan& scan = scans_[slice.scan];
    ++scan.arrived;
    scan.in_time += at - slice.captured <= Seconds(c_.max_age);
  }

  const LateSenderConfig c_;
  const double period_;  // time between slices
  std::vector<Scan> scans_;
  std::deque<Slice> waiting_;
  std::deque<Packet> network_;
  std::deque<Ack> acked_;
  std::vector<double> queue_ms_;
  std::uint64_t made_ = 0;
  double in_flight_ = 0;
  double allowed_ = 0;  // bits that may be sent now
  double carried_ = 0, usable_ = 0;
};

}  // namespace

LateSenderReport SendLate(const link::Capacity& capacity, const LateSenderConfig& config) {
  LateSender sender(config);
  for (Duration t{0}; t < config.duration; t += kTick) {
    const Duration known = std::max(Duration{0}, t - config.rtt);
    sender.Step(Seconds(t), capacity.RateAt(t).bits_per_second(),
                capacity.RateAt(known).bits_per_second());
  }
  return sender.Finish();
}

}  // namespace lidar::loop
