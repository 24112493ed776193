// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/lab/codec_lab/measure.h"

#include <algorithm>

#include "src/rate/paper_model.h"

namespace lidar::tools {

const CodingMode& ModeOfEffort(unsigned effort) {
  return ModeNamed(effort == 0 ? "range-adaptive" : "range-mixing" + std::to_string(effort));
}

const CodingMode& DefaultRangeMode() { return ModeOfEffort(0); }

const CodingMode& DefaultMode(const ScanSet& set) {
  return set.organised() ? DefaultRangeMode() : ModeNamed("xyz-kd6");
}

std::optional<Measurement> Measure(const ScanSet& set, const CodingMode& mode,
                                   const MeasuredSetting& setting) {
  SliceCodec codec;
  Measurement m;
  double returns = 0;
  double bits = 0;
  double slices = 0;
  for (const Scan& scan : set.scans) {
    for (std::uint32_t i = 0; i < setting.slices; ++i) {
      codec.Load(scan, {i, setting.slices});
      if (codec.returns() == 0) continue;
      const double extent = codec.Features(mode).extent_m;
      const double step = setting.quantization_bits > 0
                              ? rate::StepOfBits(extent, setting.quantization_bits)
                              : setting.step_m;
      const rate::Settings settings{step, setting.intensity_bits, 0};
      const auto encoded = codec.Encode(mode, settings);
      const auto errors = codec.Errors(mode, settings);
      if (!encoded || !errors) return std::nullopt;
      const auto points = static_cast<double>(codec.returns());
      returns += points;
      bits += encoded->size.bits();
      m.step_m += encoded->step_m;
      m.quantization_bits += rate::BitsOfStep(extent, encoded->step_m);
      m.errors.mean_m += errors->mean_m * points;
      m.errors.max_m = std::max(m.errors.max_m, errors->max_m);
      ++slices;
    }
  }
  if (returns <= 0) return std::nullopt;
  m.step_m /= slices;
  m.quantization_bits /= slices;
  m.errors.mean_m /= returns;
  m.bits_per_return = bits / returns;
  m.bitrate = bits / static_cast<double>(set.scans.size()) * set.scans_per_second;
  return m;
}

}  // namespace lidar::tools
