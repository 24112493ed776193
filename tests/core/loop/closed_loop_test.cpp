// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests that rates do not swing in the whole loop: SCReAM sets a target, the rate controller spends
// the target on slices, and the link carries them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <memory>
#include <numeric>
#include <vector>

#include "src/rate/model_file.h"
#include "src/rate/rate_controller.h"
#include "src/sim/simulation.h"
#include "src/sim/synthetic_codec.h"

namespace lidar {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Time kOrigin{seconds(100)};
constexpr double kScansPerSecond = 10;
constexpr double kPayloadShare = 0.96;  // of a packet is payload; the rest is headers

/// Encodes slices to a target rate, as dracoenc does.
class Encoder {
 public:
  explicit Encoder(std::uint32_t slices)
      : slices_(slices),
        codec_(CodecOf(slices)),
        controller_(Limits(), rate::MakeBuiltInModel(rate::RateModel::kAdaptive)) {}

  /// Encodes the next slice. `wire` is the target, including headers.
  scream::test::EncodedFrame Next(DataRate wire) {
    controller_.SetTarget(wire * kPayloadShare);
    const auto features = codec_.Features(scan_, slice_);
    const rate::Decision decision = controller_.NextSlice(features);
    rate::EncodedSize encoded;
    if (!decision.skip) {
      encoded = codec_.Encode(features, decision.settings, decision.keep_fraction);
      if (const auto again = controller_.OnEncoded(encoded)) {
        encoded = codec_.Encode(features, *again, decision.keep_fraction);
        controller_.OnEncoded(encoded);
      }
    }
    slice_ = (slice_ + 1) % slices_;
    if (slice_ == 0) ++scan_;
    const double bytes = static_cast<double>(encoded.size.bytes()) / kPayloadShare;
    return {DataSize::Bytes(static_cast<std::int64_t>(bytes)), std::nullopt};
  }

 private:
  static rate::SyntheticCodec::Parameters CodecOf(std::uint32_t slices) {
    rate::SyntheticCodec::Parameters p;
    p.slices = slices;
    p.bits_per_return = 10;  // This is 6 Mbit/s at a step of 1 cm.
    return p;
  }
  static rate::ControllerParameters Limits() {
    rate::ControllerParameters p;
    p.limits.finest_step_m = 0.001;
    p.limits.coarsest_step_m = 0.04;
    return p;
  }

  std::uint32_t slices_;
  rate::SyntheticCodec codec_;
  rate::RateController controller_;
  std::uint32_t scan_ = 0;
  std::uint32_t slice_ = 0;
};

scream::test::SimulationConfig Path(link::Capacity capacity, std::uint32_t slices, bool encoder) {
  scream::test::SimulationConfig config;
  config.forward.origin = kOrigin;
  config.forward.capacity = std::move(capacity);
  config.forward.delay = milliseconds(20);
  config.forward.aqm.kind = link::AqmConfig::Kind::kRamp;
  config.return_delay = milliseconds(20);
  config.duration = seconds(70);
  config.sample_interval = milliseconds(100);
  scream::test::FlowConfig& flow = config.flows.front();
  flow.start = kOrigin;
  scream::test::SourceConfig& source = flow.sources.front();
  source.frames_per_second = kScansPerSecond * slices;
  source.stream.max_bitrate = DataRate::BitsPerSecond(20e6);
  if (encoder) {
    source.encoder = [e = std::make_shared<Encoder>(slices)](DataRate target) {
      return e->Next(target);
    };
  }
  return config;
}

/// The variation of a rate. All fields except for the mean are relative to the mean.
struct Swing {
  double mean_mbps = 0;
  double deviation = 0;     // the standard deviation
  double peak_to_peak = 0;  // the largest difference within 10 s
  double tone = 0;          // the amplitude of the strongest sine wave from 0.1 to 2 Hz
};

/// Returns the variation of `rates`, which were sampled every 100 ms.
Swing Measure(const std::vector<double>& rates) {
  Swing s;
  const auto n = static_cast<double>(rates.size());
  s.mean_mbps = std::accumulate(rates.begin(), rates.end(), 0.0) / n;
  for (const double r : rates) s.deviation += (r - s.mean_mbps) * (r - s.mean_mbps) / n;
  s.deviation = std::sqrt(s.deviation) / s.mean_mbps;
  const std::ptrdiff_t window = std::min<std::ptrdiff_t>(100, rates.end() - rates.begin());
  for (auto first = rates.begin(); rates.end() - first >= window; ++first) {
    const auto [low, high] = std::minmax_element(first, first + window);
    s.peak_to_peak = std::max(s.peak_to_peak, (*high - *low) / s.mean_mbps);
  }
  for (double hertz = 0.1; hertz <= 2; hertz += 0.02) {
    std::complex<double> sum;
    for (std::size_t i = 0; i < rates.size(); ++i)
      sum += (rates[i] - s.mean_mbps) *
             std::polar(1.0, -2 * M_PI * hertz * 0.1 * static_cast<double>(i));
    s.tone = std::max(s.tone, 2 * std::abs(sum) / n / s.mean_mbps);
  }
  return s;
}

std::vector<double> Targets(const scream::test::SimulationResult& result, seconds from,
                            seconds until) {
  std::vector<double> rates;
  for (const auto& sample : result.samples) {
    if (sample.time >= kOrigin + from && sample.time < kOrigin + until)
      rates.push_back(sample.statistics.target_bitrate.bits_per_second() / 1e6);
  }
  return rates;
}

/// Returns the rate that was delivered in each interval of 100 ms [Mbit/s].
std::vector<double> Sent(const scream::test::SimulationResult& result, seconds from,
                         seconds until) {
  std::vector<double> rates;
  for (Time t = kOrigin + from; t < kOrigin + until; t += milliseconds(100)) {
    rates.push_back(static_cast<double>(result.DeliveredBytes(t, t + milliseconds(100))) * 8 / 0.1 /
                    1e6);
  }
  return rates;
}

void Print(const char* what, const Swing& s) {
  std::printf("%-40s mean %5.2f Mbit/s, deviation %4.1f %%, peak to peak %4.1f %%, tone %4.1f %%\n",
              what, s.mean_mbps, 100 * s.deviation, 100 * s.peak_to_peak, 100 * s.tone);
}

TEST(SimulatedFrames, AreNotCompletedByAPacketThatComesTwice) {
  auto config = Path(link::Capacity::Constant(DataRate::BitsPerSecond(20e6)), 1, false);
  config.duration = seconds(10);
  config.forward.loss = 0.1;
  config.forward.path.duplicate = 0.3;
  const auto result = scream::test::Simulate(config);
  std::size_t incomplete = 0;
  for (const auto& frame : result.flows.front().frames) {
    EXPECT_LE(frame.delivered, frame.packets);
    incomplete += !frame.complete();
  }
  EXPECT_GT(incomplete, 10U);
}

TEST(Swing, IsSeenWhereThereIsOne) {
  std::vector<double> rates;
  for (int i = 0; i < 600; ++i) rates.push_back(8 + 0.4 * std::sin(2 * M_PI * 0.5 * 0.1 * i));
  const Swing s = Measure(rates);
  EXPECT_NEAR(s.tone, 0.05, 0.001);
  EXPECT_NEAR(s.peak_to_peak, 0.1, 0.001);
  EXPECT_NEAR(s.deviation, 0.05 / std::sqrt(2), 0.001);
}

class ClosedLoop : public ::testing::TestWithParam<std::uint32_t> {};  // slices per scan

TEST_P(ClosedLoop, OnAConstantLinkStandsStill) {
  const auto capacity = link::Capacity::Constant(DataRate::BitsPerSecond(8e6));
  const auto ideal = Simulate(Path(capacity, GetParam(), false));
  const auto real = Simulate(Path(capacity, GetParam(), true));
  const Swing exact = Measure(Targets(ideal, seconds(10), seconds(70)));
  const Swing target = Measure(Targets(real, seconds(10), seconds(70)));
  const Swing sent = Measure(Sent(real, seconds(10), seconds(70)));
  Print("target, encoder that obeys exactly", exact);
  Print("target, rate controller", target);
  Print("sent, rate controller", sent);
  EXPECT_LE(target.deviation, 0.01);
  EXPECT_LE(target.peak_to_peak, 0.05);
  EXPECT_LE(target.tone, 0.005);
  EXPECT_LE(sent.deviation, 0.02);
  EXPECT_LE(sent.peak_to_peak, 0.10);
  EXPECT_LE(sent.tone, 0.005);
  EXPECT_GE(target.mean_mbps, 0.93 * exact.mean_mbps);
}

TEST_P(ClosedLoop, StandsStillAgainSoonAfterEveryStepOfTheLink) {
  const auto mbps = [](double r) { return DataRate::BitsPerSecond(r * 1e6); };
  const std::vector<DataRate> steps = {mbps(9), mbps(6), mbps(9), mbps(5), mbps(8), mbps(7)};
  const auto result = Simulate(Path(link::Capacity::Steps(steps, seconds(12)), GetParam(), true));
  for (int step = 1; step < 5; ++step) {
    // After a step, SCReAM probes upwards for some seconds. The target is steady after that.
    const Swing target = Measure(Targets(result, seconds(12 * step + 6), seconds(12 * step + 12)));
    const Swing sent = Measure(Sent(result, seconds(12 * step + 6), seconds(12 * step + 12)));
    Print("target, after a step", target);
    Print("sent, after a step", sent);
    EXPECT_LE(target.deviation, 0.02) << step;
    EXPECT_LE(target.peak_to_peak, 0.05) << step;
    EXPECT_LE(sent.deviation, 0.03) << step;
    EXPECT_LE(sent.mean_mbps, steps[static_cast<std::size_t>(step)].bits_per_second() / 1e6);
  }
}

INSTANTIATE_TEST_SUITE_P(Slices, ClosedLoop, ::testing::Values(1U, 8U));

}  // namespace
}  // namespace lidar
