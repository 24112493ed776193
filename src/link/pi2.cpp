// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/link/pi2.h"

#include <algorithm>

namespace lidar::link {
namespace {

/// The controller restarts if the link was idle for this time.
constexpr Duration kForget = std::chrono::seconds{1};

bool IsL4s(Ecn ecn) { return ecn == Ecn::kEct1 || ecn == Ecn::kCe; }

Verdict Signal(Ecn ecn) { return ecn == Ecn::kNotEct ? Verdict::kDrop : Verdict::kMark; }

/// Returns the classic signal, whose probability is the square of the base probability (RFC 9332,
/// section 2.4).
Verdict Classic(Ecn ecn, double p, Random* random) {
  return random->Chance(p * p) ? Signal(ecn) : Verdict::kPass;
}

class Pi2 final : public Aqm {
 public:
  Pi2(const Pi2Config& config, Random random)
      : config_(config), controller_(config), random_(random) {}

  Verdict OnDequeue(Time now, Duration sojourn, const Packet& packet) override {
    controller_.Update(now, sojourn);
    const double p = controller_.p();
    if (!config_.knows_l4s || !IsL4s(packet.ecn)) return Classic(packet.ecn, p, &random_);
    return random_.Chance(std::min(1.0, config_.k * p)) ? Verdict::kMark : Verdict::kPass;
  }

 private:
  Pi2Config config_;
  PiController controller_;
  Random random_;
};

class DualPi2 final : public Queue {
 public:
  DualPi2(const Pi2Config& config, Random random)
      : config_(config), controller_(config), random_(random) {}

  void Push(const Waiting& waiting) override {
    (IsL4s(waiting.packet.ecn) ? l4s_ : classic_).Push(waiting);
  }

  Leaving Pop(Time now) override {
    const Time l4s = l4s_.Oldest();
    const Time classic = classic_.Oldest();
    const bool take_l4s = classic == Time::max() || l4s <= classic + config_.t_shift;
    controller_.Update(now, classic < now ? now - classic : Duration{0});
    Leaving leaving = (take_l4s && !l4s_.empty() ? l4s_ : classic_).Pop(now);
    leaving.verdict = Decide(now - leaving.waiting.entered, leaving.waiting.packet.ecn);
    return leaving;
  }

  Time Oldest() const override { return std::min(l4s_.Oldest(), classic_.Oldest()); }
  std::size_t packets() const override { return l4s_.packets() + classic_.packets(); }
  DataSize size() const override { return l4s_.size() + classic_.size(); }

 private:
  Verdict Decide(Duration sojourn, Ecn ecn) {
    const double p = controller_.p();
    if (!IsL4s(ecn)) return Classic(ecn, p, &random_);
    const double ramp =
        std::clamp(Seconds(sojourn - config_.low) / Seconds(config_.high - config_.low), 0.0, 1.0);
    return random_.Chance(std::max(ramp, std::min(1.0, config_.k * p))) ? Verdict::kMark
                                                                        : Verdict::kPass;
  }

  Pi2Config config_;
  PiController controller_;
  Random random_;
  FifoQueue l4s_{NoAqm()};
  FifoQueue classic_{NoAqm()};
};

}  // namespace

void PiController::Update(Time now, Duration qdelay) {
  if (!started_ || now - next_ > kForget) {
    started_ = true;
    next_ = now + config_.t_update;
    p_ = 0;
    previous_ = qdelay;
    return;
  }
  for (; next_ <= now; next_ += config_.t_update) {
    const double error = Seconds(qdelay - config_.target);
    const double trend = Seconds(qdelay - previous_);
    p_ = std::clamp(p_ + config_.alpha_per_s * error + config_.beta_per_s * trend, 0.0, 1.0);
    previous_ = qdelay;
  }
}

std::unique_ptr<Aqm> Pi2Aqm(const Pi2Config& config, Random random) {
  return std::make_unique<Pi2>(config, random);
}
std::unique_ptr<Queue> DualPi2Queue(const Pi2Config& config, Random random) {
  return std::make_unique<DualPi2>(config, random);
}

}  // namespace lidar::link
