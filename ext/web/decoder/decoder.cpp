// SPDX-License-Identifier: LGPL-2.1-or-later
// The decoder of the page as WebAssembly. It converts the slices of a stream to points. Any input
// results in points or in a negative number. Memory is limited by kMostSliceBytes, by the number of
// points that the caller sets, and by the codec's limit for references.
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "src/codec/cloud/cloud_decoder.h"
#include "src/codec/slice_decoder.h"
#include "src/codec/slice_links.h"

namespace {

using lidar::ByteView;
using lidar::SensorModel;
namespace codec = lidar::codec;

constexpr std::uint32_t kMostSliceBytes = 16U << 20;
constexpr std::uint32_t kMostPoints = 1U << 20;
constexpr float kMetresPerMm = 1e-3F;

/// A decoded slice. decoder.js reads its members as 32-bit words.
struct Slice {
  std::uint32_t count = 0;       // number of points
  const void* points = nullptr;  // an array of Point
  float step_m = 0;
  float error_m = 0;
  std::uint32_t has_intensity = 0;
  std::uint32_t has_beam = 0;
};

/// A block of a slice. Other blocks may refer to it.
struct Link {
  std::uint32_t name = 0;
  std::uint32_t needs = 0;  // the name of the block to which this block refers
  std::uint32_t has_needs = 0;
};

/// The layout of a point in fields.js.
struct Point {
  float x, y, z, intensity, beam, range_m;
};

/// The layout of a point that WriteRangeImage() and WriteXyz() write.
struct RawPoint {
  float x, y, z, intensity;
  std::uint32_t range_mm;
};
lidar::PointFields RawFields() {
  using lidar::FieldType;
  lidar::PointFields fields;
  for (const char* name : {"x", "y", "z", "intensity"}) fields.Add(name, FieldType::kF32);
  return fields.Add("range", FieldType::kU32);
}

enum Result : std::int32_t { kGood = 0, kDamaged = -1, kLacksReference = -2 };

class Decoder {
 public:
  /// If there is a `model`, slices contain the ranges of its sensor. Otherwise they contain points.
  Decoder(std::optional<SensorModel> model, std::uint32_t max_points) : max_points_(max_points) {
    layout_ = {RawFields(), sizeof(RawPoint)};
    if (!model) {
      cloud_ = std::make_unique<codec::cloud::CloudDecoder>(max_points);
      return;
    }
    const codec::CloudFormat format = {layout_, static_cast<std::uint32_t>(model->beams.size()),
                                       std::move(model)};
    ranges_ = std::make_unique<codec::SliceDecoder>(format, max_points);
  }

  std::uint8_t* Input(std::uint32_t size) {
    if (size > kMostSliceBytes) return nullptr;
    input_.resize(size);
    return input_.data();
  }

  std::int32_t Decode() {
    slice_ = {};
    return ranges_ ? DecodeRanges() : DecodeCloud();
  }
  const Slice& slice() const { return slice_; }
  /// Finds the links between the blocks of the input and blocks of other slices. Returns their
  /// number.
  std::uint32_t FindLinks() {
    links_.clear();
    const auto blocks = ranges_ ? codec::LinksOf({input_.data(), input_.size()}) : std::nullopt;
    for (const codec::BlockName& block : blocks.value_or(std::vector<codec::BlockName>()))
      links_.push_back({block.crc, block.reference.value_or(0), block.reference.has_value()});
    return static_cast<std::uint32_t>(links_.size());
  }
  const Link* links() const { return links_.data(); }
  const RawPoint* raw() const { return raw_.data(); }
  std::uint32_t raw_count() const { return static_cast<std::uint32_t>(raw_.size()); }

 private:
  std::int32_t DecodeRanges() {
    const auto shape = ranges_->Decode({input_.data(), input_.size()});
    if (!shape) return ranges_->lacks_reference() ? kLacksReference : kDamaged;
    raw_.resize(std::size_t{shape->width} * shape->height);
    ranges_->Write(reinterpret_cast<std::uint8_t*>(raw_.data()));
    const auto& quality = ranges_->quality();
    Take(quality.step_m, quality.error_m, quality.intensity_bits, true);
    points_.clear();
    for (std::size_t i = 0, beam = 0; beam < shape->height; ++beam) {
      for (const std::size_t end = i + shape->width; i < end; ++i) {
        const RawPoint& p = raw_[i];
        if (p.range_mm == 0) continue;
        points_.push_back({p.x, p.y, p.z, p.intensity, static_cast<float>(beam),
                           static_cast<float>(p.range_mm) * kMetresPerMm});
      }
    }
    return Give();
  }

  std::int32_t DecodeCloud() {
    if (!cloud_->Decode({input_.data(), input_.size()})) return kDamaged;
    raw_.resize(cloud_->cloud().size());
    codec::WriteXyz(cloud_->cloud(), layout_, reinterpret_cast<std::uint8_t*>(raw_.data()));
    Take(cloud_->step_m(), cloud_->error_m(), cloud_->intensity_bits(), false);
    points_.clear();
    for (const RawPoint& p : raw_) {
      points_.push_back(
          {p.x, p.y, p.z, p.intensity, 0, std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z)});
    }
    return Give();
  }

  void Take(double step_m, double error_m, unsigned intensity_bits, bool has_beam) {
    slice_.step_m = static_cast<float>(step_m);
    slice_.error_m = static_cast<float>(error_m);
    slice_.has_intensity = intensity_bits > 0;
    slice_.has_beam = has_beam;
  }
  std::int32_t Give() {
    slice_.count = static_cast<std::uint32_t>(points_.size());
    slice_.points = points_.data();
    return kGood;
  }

  std::uint32_t max_points_;
  codec::CloudLayout layout_;
  std::unique_ptr<codec::SliceDecoder> ranges_;
  std::unique_ptr<codec::cloud::CloudDecoder> cloud_;
  std::vector<std::uint8_t> input_;
  std::vector<RawPoint> raw_;
  std::vector<Point> points_;
  std::vector<Link> links_;
  Slice slice_;
};

}  // namespace

#define EXPORT(name) extern "C" __attribute__((export_name(#name)))

EXPORT(allocate) void* Allocate(std::uint32_t size) {
  return size <= kMostSliceBytes ? ::operator new(size) : nullptr;
}
EXPORT(release) void Release(void* memory) { ::operator delete(memory); }
/// Opens a decoder. Returns null if the sensor model is damaged. If `size` is 0, there is no model,
/// and slices contain points.
EXPORT(open)
Decoder* Open(const std::uint8_t* model, std::uint32_t size, std::uint32_t max_points) {
  std::optional<SensorModel> sensor;
  if (size > 0 && !(sensor = SensorModel::Parse({model, size}))) return nullptr;
  return new Decoder(std::move(sensor), max_points < kMostPoints ? max_points : kMostPoints);
}
EXPORT(close) void Close(Decoder* decoder) { delete decoder; }
/// Returns memory for the next slice, or null if the slice is too large.
EXPORT(input) std::uint8_t* Input(Decoder* decoder, std::uint32_t size) {
  return decoder->Input(size);
}
EXPORT(decode) std::int32_t Decode(Decoder* decoder) { return decoder->Decode(); }
/// Finds the links of the input and returns their number. links() returns the links.
EXPORT(find_links) std::uint32_t FindLinks(Decoder* decoder) { return decoder->FindLinks(); }
EXPORT(links) const void* Links(const Decoder* decoder) { return decoder->links(); }
EXPORT(slice) const Slice* SliceOf(const Decoder* decoder) { return &decoder->slice(); }
/// Returns all pixels of the last slice. Only tests use this function.
EXPORT(raw) const void* Raw(const Decoder* decoder) { return decoder->raw(); }
EXPORT(raw_count) std::uint32_t RawCount(const Decoder* decoder) { return decoder->raw_count(); }
