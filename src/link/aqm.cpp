// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/link/aqm.h"

namespace lidar::link {
namespace {

class None final : public Aqm {
 public:
  Verdict OnDequeue(Time, Duration, const Packet&) override { return Verdict::kPass; }
};

class Step final : public Aqm {
 public:
  explicit Step(Duration threshold) : threshold_(threshold) {}
  Verdict OnDequeue(Time, Duration sojourn, const Packet& packet) override {
    return packet.ecn == Ecn::kEct1 && sojourn > threshold_ ? Verdict::kMark : Verdict::kPass;
  }

 private:
  Duration threshold_;
};

class Ramp final : public Aqm {
 public:
  Ramp(Duration low, Duration high, Random random) : low_(low), high_(high), random_(random) {}
  Verdict OnDequeue(Time, Duration sojourn, const Packet& packet) override {
    if (packet.ecn != Ecn::kEct1 || sojourn <= low_) return Verdict::kPass;
    if (sojourn >= high_) return Verdict::kMark;
    return random_.Chance(Seconds(sojourn - low_) / Seconds(high_ - low_)) ? Verdict::kMark
                                                                           : Verdict::kPass;
  }

 private:
  Duration low_;
  Duration high_;
  Random random_;
};

}  // namespace

std::unique_ptr<Aqm> NoAqm() { return std::make_unique<None>(); }
std::unique_ptr<Aqm> StepAqm(Duration threshold) { return std::make_unique<Step>(threshold); }
std::unique_ptr<Aqm> RampAqm(Duration low, Duration high, Random random) {
  return std::make_unique<Ramp>(low, high, random);
}

}  // namespace lidar::link
