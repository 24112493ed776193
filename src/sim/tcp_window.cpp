// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/sim/tcp_window.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace lidar::scream::test {
namespace {

constexpr double kMinWindow = 2;

class Reno final : public TcpWindow {
 public:
  void OnAck(Time, Duration, bool) override { window += 1 / window; }
  void OnLoss() override { window = std::max(kMinWindow, window / 2); }
  void OnTimeout() override { window = kMinWindow; }
};

/// Cubic, with the names that RFC 9438 uses.
class Cubic final : public TcpWindow {
 public:
  void OnAck(Time now, Duration rtt, bool) override {
    if (!epoch_) StartEpoch(now);
    const double t = Seconds(now - *epoch_);
    w_est_ += (w_est_ < cwnd_prior_ ? kAlpha : 1.0) / window;
    if (At(t) < w_est_) {
      window = w_est_;
      return;
    }
    const double target = std::clamp(At(t + Seconds(rtt)), window, 1.5 * window);
    window += (target - window) / window;
  }
  void OnLoss() override {
    cwnd_prior_ = window;
    w_max_ = window < w_max_ ? window * (1 + kBeta) / 2 : window;  // fast convergence
    window = std::max(kMinWindow, window * kBeta);
    epoch_.reset();
  }
  void OnTimeout() override {
    OnLoss();
    window = kMinWindow;
  }

 private:
  static constexpr double kC = 0.4;
  static constexpr double kBeta = 0.7;
  static constexpr double kAlpha = 3 * (1 - kBeta) / (1 + kBeta);

  void StartEpoch(Time now) {
    epoch_ = now;
    w_est_ = window;
    w_max_ = std::max(w_max_, window);
    k_ = std::cbrt((w_max_ - window) / kC);
  }
  double At(double t) const { return kC * std::pow(t - k_, 3) + w_max_; }

  std::optional<Time> epoch_;
  double w_max_ = 0, k_ = 0, w_est_ = 0, cwnd_prior_ = 0;
};

/// Prague. If the round trip is short, the window grows only as fast as with the virtual RTT. A
/// mark reduces the window by half of the fraction of marked packets.
class Prague final : public TcpWindow {
 public:
  void OnAck(Time now, Duration rtt, bool ce) override {
    Count(now, rtt, ce);
    if (!ce) {
      const double ratio = std::min(1.0, Seconds(rtt) / Seconds(kVirtualRtt));
      window += ratio * ratio / window;
    } else if (!reduced_ || now - *reduced_ >= rtt) {
      reduced_ = now;
      window = std::max(kMinWindow, window * (1 - alpha_ / 2));
    }
  }
  void OnLoss() override { window = std::max(kMinWindow, window / 2); }
  void OnTimeout() override { window = kMinWindow; }
  void OnFirstMark() override {
    alpha_ = 1;
    window = std::max(kMinWindow, window / 2);
  }

 private:
  static constexpr Duration kVirtualRtt = std::chrono::milliseconds(25);
  static constexpr double kGain = 1.0 / 16;

  void Count(Time now, Duration rtt, bool ce) {
    ++acked_;
    marked_ += ce;
    if (!round_) round_ = now;
    if (now - *round_ < std::max(rtt, kVirtualRtt)) return;
    alpha_ += kGain * (marked_ / acked_ - alpha_);
    acked_ = marked_ = 0;
    round_ = now;
  }

  double alpha_ = 0;
  double acked_ = 0, marked_ = 0;
  std::optional<Time> round_, reduced_;
};

}  // namespace

std::unique_ptr<TcpWindow> MakeTcpWindow(TcpKind kind) {
  switch (kind) {
    case TcpKind::kReno:
      return std::make_unique<Reno>();
    case TcpKind::kCubic:
      return std::make_unique<Cubic>();
    case TcpKind::kPrague:
      break;
  }
  return std::make_unique<Prague>();
}

}  // namespace lidar::scream::test
