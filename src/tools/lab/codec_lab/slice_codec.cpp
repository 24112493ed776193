// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/lab/codec_lab/slice_codec.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "ext/draco/draco_check.h"
#include "src/cloud/point_math.h"
#include "src/rate/scan_plan.h"

namespace lidar::tools {
namespace {

// The error bound exceeds the step by this margin [m], because the rounding of distant floats adds
// to the error. So the codec is limited by the step, and not by the bound.
constexpr double kRoomForRounding = 1e-3;

double Distance(const float* a, const float* b) { return std::sqrt(SquaredDistance(a, b)); }

}  // namespace

const std::vector<CodingMode>& AllModes() {
  static const std::vector<CodingMode> kModes = {
      {"range-adaptive", Geometry::kRange, codec::RangeCoder::kAdaptive, 7},
      {"range-mixing1", Geometry::kRange, codec::RangeCoder::kMixing, 7, 1},
      {"range-mixing2", Geometry::kRange, codec::RangeCoder::kMixing, 7, 2},
      {"range-mixing3", Geometry::kRange, codec::RangeCoder::kMixing, 7, 3},
      {"range-residual", Geometry::kRange, codec::RangeCoder::kResidual, 7},
      {"range-draco", Geometry::kRange, codec::RangeCoder::kDraco, 7},
      {"xyz-sequential", Geometry::kXyz, codec::RangeCoder::kDraco, 0},
      {"xyz-kd0", Geometry::kXyz, codec::RangeCoder::kDraco, 1},
      {"xyz-kd2", Geometry::kXyz, codec::RangeCoder::kDraco, 3},
      {"xyz-kd4", Geometry::kXyz, codec::RangeCoder::kDraco, 5},
      {"xyz-kd6", Geometry::kXyz, codec::RangeCoder::kDraco, 7},
  };
  return kModes;
}

const CodingMode& ModeNamed(const std::string& name) {
  for (const CodingMode& mode : AllModes())
    if (mode.name == name) return mode;
  std::string names;
  for (const CodingMode& mode : AllModes()) names += " " + mode.name;
  throw std::runtime_error("no coding mode " + name + "; there are" + names);
}

const CodingMode& XyzModeOfLevel(unsigned level) {
  if (level == 0) return ModeNamed("xyz-sequential");
  return ModeNamed("xyz-kd" + std::to_string(std::min(level / 2 * 2, 6U)));
}

void SliceCodec::SetFormat(const Scan& scan) {
  geometry_ = scan.geometry;
  coders_.clear();
  format_ = {};
  PointFields& fields = format_.layout.fields;
  fields.Add("x", FieldType::kF32).Add("y", FieldType::kF32).Add("z", FieldType::kF32);
  fields.Add("intensity", FieldType::kF32);
  if (scan.organised()) {
    fields.Add("range", FieldType::kU32);
    format_.height = geometry_->projection.beams();
    format_.sensor_model = geometry_->model;
  }
  format_.layout.point_step = fields.MinimumStep();
}

void SliceCodec::AppendPoint(const float* xyz, float intensity, std::uint32_t range_mm) {
  const std::size_t at = raw_.size();
  raw_.resize(at + format_.layout.point_step);
  std::memcpy(&raw_[at], xyz, 3 * sizeof(float));
  std::memcpy(&raw_[at + 12], &intensity, sizeof intensity);
  if (geometry_) std::memcpy(&raw_[at + 16], &range_mm, sizeof range_mm);
  if (geometry_ && range_mm == 0) return;
  points_.insert(points_.end(), xyz, xyz + 3);
  ++returns_;
}

void SliceCodec::Load(const Scan& scan, SliceOf slice) {
  if (format_.layout.fields.empty() || geometry_ != scan.geometry) SetFormat(scan);
  for (auto& [name, coder] : coders_) coder.loaded = false;
  raw_.clear();
  points_.clear();
  returns_ = 0;
  const auto intensity = [&](std::size_t at) {
    return scan.intensity.empty() ? 0.0F : scan.intensity[at];
  };
  if (!scan.organised()) {
    const std::size_t points = scan.xyz.size() / 3;
    first_column_ = 0;
    for (std::size_t i = points * slice.index / slice.count;
         i < points * (slice.index + 1) / slice.count; ++i)
      AppendPoint(&scan.xyz[3 * i], intensity(i), 0);
    return;
  }
  const ColumnWindow window = WindowOf(scan, slice);
  first_column_ = window.first;
  const RangeProjection& projection = geometry_->projection;
  for (std::uint32_t beam = 0; beam < projection.beams(); ++beam) {
    for (std::uint32_t column = window.first; column < window.first + window.count; ++column) {
      const std::size_t at = std::size_t{beam} * projection.columns() + column;
      const auto point = projection.Point(beam, column, scan.ranges[at]);
      AppendPoint(point.data(), intensity(at), scan.ranges[at]);
    }
  }
}

draco::SliceEncoder& SliceCodec::EncoderFor(const CodingMode& mode) {
  auto found = coders_.find(mode.name);
  if (found == coders_.end()) {
    auto encoder = draco::SliceEncoder::Create(format_, mode.geometry, mode.coder);
    if (!encoder) throw std::runtime_error(mode.name + " needs a sensor's ranges");
    encoder->set_effort(mode.effort);
    found = coders_.emplace(mode.name, Coder{*std::move(encoder)}).first;
  }
  Coder& coder = found->second;
  if (!coder.loaded) coder.encoder.Load({raw_.data(), raw_.size()}, first_column_, true);
  coder.loaded = true;
  return coder.encoder;
}

rate::SliceFeatures SliceCodec::Features(const CodingMode& mode) {
  rate::SliceFeatures features;
  features.returns = static_cast<std::uint32_t>(returns_);
  features.extent_m = EncoderFor(mode).extent_m();
  features.mode = mode.name;
  return features;
}

rate::ErrorBound SliceCodec::Bound(const CodingMode& mode) {
  if (mode.geometry == Geometry::kXyz) return rate::ErrorBound::Xyz();
  return rate::ErrorBound::Range(EncoderFor(mode).range_unit_mm());
}

/// Uses the coder that `mode` names. In contrast, dracoenc uses the coder with the smaller output.
bool SliceCodec::EncodeXyz(const CodingMode& mode, const rate::Settings& settings,
                           double keep_fraction) {
  codec::XyzCloud all;
  codec::ReadXyz({raw_.data(), raw_.size()}, format_.layout, true, &all);
  codec::XyzCloud cloud;
  const auto kept = rate::ThinningPattern(all.size(), keep_fraction);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!kept[i]) continue;
    cloud.xyz.insert(cloud.xyz.end(), &all.xyz[3 * i], &all.xyz[3 * i] + 3);
    cloud.intensity.push_back(all.intensity[i]);
  }
  draco::XyzSettings xyz;
  xyz.max_error_m = settings.step_m + kRoomForRounding;
  xyz.step_m = settings.step_m;
  xyz.level = static_cast<int>(mode.level);
  xyz.method = mode.level == 0 ? draco::XyzMethod::kSequential : draco::XyzMethod::kKdTree;
  xyz.intensity_bits = settings.intensity_bits;
  draco::XyzResult result;
  encoded_ = {};
  if (!draco::EncodeXyz(cloud, xyz, &encoded_.bytes, &result)) return false;
  encoded_.returns = cloud.size();
  encoded_.step_m = result.step_m;
  encoded_.error_m = result.error_m;
  return true;
}

bool SliceCodec::EncodeBytes(const CodingMode& mode, const rate::Settings& settings,
                             double keep_fraction) {
  if (returns_ == 0) return false;
  if (mode.geometry == Geometry::kXyz) return EncodeXyz(mode, settings, keep_fraction);
  draco::SliceEncoder& encoder = EncoderFor(mode);
  draco::SliceSettings slice;
  slice.step_m = settings.step_m;
  slice.max_error_m = settings.step_m + kRoomForRounding;
  slice.intensity_bits = settings.intensity_bits;
  slice.level = mode.level;
  if (keep_fraction < 1) {
    encoder.Thin(rate::ThinningPattern(encoder.rows(), keep_fraction));
    coders_.at(mode.name).loaded = false;
  }
  return encoder.Encode(slice, &encoded_) == codec::SliceResult::kEncoded;
}

std::optional<rate::EncodedSize> SliceCodec::Encode(const CodingMode& mode,
                                                    const rate::Settings& settings,
                                                    double keep_fraction) {
  if (!EncodeBytes(mode, settings, keep_fraction)) return std::nullopt;
  rate::EncodedSize encoded;
  encoded.size = DataSize::Bytes(static_cast<std::int64_t>(encoded_.bytes.size()));
  encoded.step_m = encoded_.step_m;
  encoded.keep_fraction = keep_fraction;
  return encoded;
}

std::optional<Distortion> SliceCodec::Errors(const CodingMode& mode,
                                             const rate::Settings& settings) {
  const bool xyz = mode.geometry == Geometry::kXyz;
  // The kd-tree reorders the points. So errors are measured by the sequential coder, which uses the
  // same grid but keeps the order.
  if (!EncodeBytes(xyz ? ModeNamed("xyz-sequential") : mode, {settings.step_m, 0, 0}, 1))
    return std::nullopt;
  constexpr std::uint32_t kMaxPoints = 1U << 26;
  // Draco always uses the kd-tree if there are more than a certain number of bits.
  const ByteView bytes{encoded_.bytes.data(), encoded_.bytes.size()};
  if (xyz && draco::CheckDraco(bytes, {kMaxPoints}).value().is_kd_tree) return std::nullopt;
  draco::SliceDecoder decoder(format_, mode.geometry, kMaxPoints);
  const auto shape = decoder.Decode(bytes);
  if (!shape) throw std::runtime_error("a slice cannot be decoded");
  std::vector<std::uint8_t> raw(std::size_t{shape->width} * shape->height *
                                format_.layout.point_step);
  decoder.Write(raw.data());
  Distortion errors;
  std::size_t point = 0;
  for (std::size_t at = 0; at < raw.size(); at += format_.layout.point_step) {
    float decoded[3];
    std::memcpy(decoded, &raw[at], sizeof decoded);
    if (!xyz && decoded[0] == 0 && decoded[1] == 0 && decoded[2] == 0) continue;
    if (point == returns_) throw std::runtime_error("decoding added a return");
    const double distance = Distance(&points_[3 * point++], decoded);
    errors.mean_m += distance / static_cast<double>(returns_);
    errors.max_m = std::max(errors.max_m, distance);
  }
  if (point != returns_) throw std::runtime_error("decoding lost a return");
  return errors;
}

}  // namespace lidar::tools
