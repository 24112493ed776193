// SPDX-License-Identifier: LGPL-2.1-or-later
#include "testsrc/slice_maker.h"

#include <cstring>

#include "cloud/slicing.h"
#include "common/buffer_map.h"

namespace lidar::gst {
namespace {

constexpr std::size_t kIntensityOffset = 12;
constexpr std::size_t kRangeOffset = 16;
constexpr std::size_t kPointStep = 20;

std::uint32_t SlicesOf(const synth::ScannerConfig& config, std::uint32_t requested) {
  const SensorModel& model = config.sensor.model;
  return SlicesPerScan(requested, {model.columns_per_scan,
                                   static_cast<std::uint32_t>(model.beams.size()), config.period});
}

GstClockTime ToGst(Duration d) { return static_cast<GstClockTime>(d.count()); }

}  // namespace

SliceMaker::SliceMaker(const synth::ScannerConfig& config, std::uint32_t slices_per_scan)
    : period_(config.period),
      scanner_(config),
      projection_(config.sensor.model),
      slices_(SlicesOf(config, slices_per_scan)),
      width_(config.sensor.model.columns_per_scan / slices_) {}

CloudInfo SliceMaker::InfoFor(const synth::ScannerConfig& config, std::uint32_t slices_per_scan) {
  const SensorModel& model = config.sensor.model;
  CloudInfo info;
  info.width = model.columns_per_scan / SlicesOf(config, slices_per_scan);
  info.height = static_cast<guint>(model.beams.size());
  info.point_step = kPointStep;
  info.fields.Add("x", FieldType::kF32)
      .Add("y", FieldType::kF32)
      .Add("z", FieldType::kF32)
      .Add("intensity", FieldType::kF32)
      .Add("range", FieldType::kU32);
  info.framerate_n = static_cast<gint>(std::chrono::seconds(1) / config.period);
  info.sensor_model = model;
  return info;
}

Duration SliceMaker::LongestSlice() const {
  // Rounding makes neighbours differ by a nanosecond.
  return period_ / std::int64_t{slices_} + Duration{1};
}

BufferPtr SliceMaker::Make() {
  const ColumnWindow window{FirstColumn(), width_};
  const Duration begin = NextTime();
  const Duration end = NextEnd();
  scanner_.Cast(scan_, window, &returns_);
  BufferPtr buffer(
      gst_buffer_new_allocate(nullptr, returns_.range_mm.size() * kPointStep, nullptr));
  {
    BufferMap map(buffer.get(), GST_MAP_WRITE);
    guint8* point = map.data();
    projection_.Project(returns_.range_mm.data(), window, point, kPointStep);
    for (std::size_t i = 0; i < returns_.range_mm.size(); ++i, point += kPointStep) {
      const auto intensity = static_cast<float>(returns_.reflectivity[i]);
      std::memcpy(point + kIntensityOffset, &intensity, sizeof intensity);
      std::memcpy(point + kRangeOffset, &returns_.range_mm[i], sizeof returns_.range_mm[i]);
    }
  }
  const GstLidarSlice slice{static_cast<guint>(scan_), slice_, slices_, window.first};
  gst_lidar_buffer_set_slice(buffer.get(), &slice);
  GST_BUFFER_PTS(buffer.get()) = ToGst(begin);
  GST_BUFFER_DURATION(buffer.get()) = ToGst(end - begin);
  if (++slice_ == slices_) {
    slice_ = 0;
    ++scan_;
  }
  return buffer;
}

void SliceMaker::SkipTo(Duration time) {
  scan_ = static_cast<std::uint64_t>(time / period_);
  slice_ = 0;
}

}  // namespace lidar::gst
