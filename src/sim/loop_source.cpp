// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/sim/loop_source.h"

#include "src/rate/model_file.h"

namespace lidar::loop {
namespace {

rate::SyntheticCodec::Parameters CodecOf(const SourceOptions& options) {
  rate::SyntheticCodec::Parameters p;
  p.slices = options.slices;
  p.scans_per_second = options.scans_per_second;
  p.bits_per_return = options.bits_per_return;
  return p;
}

rate::ControllerParameters ControllerOf(const SourceOptions& options) {
  rate::ControllerParameters p;
  p.limits.finest_step_m = 0.001;
  p.limits.coarsest_step_m = 2 * options.max_error_m;  // of range values
  p.limits.intensity_bits = options.intensity_bits;
  p.degradation = options.degradation;
  return p;
}

}  // namespace

LoopSource::LoopSource(const SourceOptions& options)
    : options_(options),
      codec_(CodecOf(options), options.seed),
      controller_(ControllerOf(options), rate::MakeBuiltInModel(rate::RateModel::kAdaptive)) {}

scream::test::EncodedFrame LoopSource::Next(DataRate target) {
  if (options_.adapts) controller_.SetTarget(target * kPayloadShare);
  const rate::SliceFeatures features = codec_.Features(scan_, slice_);
  const rate::Decision decision = controller_.NextSlice(features);
  scream::test::EncodedFrame frame;
  if (!decision.skip) {
    const double bytes = static_cast<double>(Encode(features, decision).size.bytes());
    frame.size = DataSize::Bytes(static_cast<std::int64_t>(bytes / kPayloadShare));
  }
  if (const auto bounds = controller_.TakeChangedBounds())
    frame.bounds = scream::test::EncoderBounds{Wire(bounds->min), Wire(bounds->max)};
  frame.group = scan_;
  slice_ = (slice_ + 1) % options_.slices;
  if (slice_ == 0) ++scan_;
  return frame;
}

rate::EncodedSize LoopSource::Encode(const rate::SliceFeatures& features,
                                     const rate::Decision& decision) {
  rate::EncodedSize encoded = codec_.Encode(features, decision.settings, decision.keep_fraction);
  if (const auto again = controller_.OnEncoded(encoded)) {
    encoded = codec_.Encode(features, *again, decision.keep_fraction);
    controller_.OnEncoded(encoded);
  }
  return encoded;
}

}  // namespace lidar::loop
