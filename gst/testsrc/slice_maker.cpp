// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/testsrc/slice_maker.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "gst/common/buffer_map.h"
#include "src/cloud/slicing.h"

namespace lidar::gst {
namespace {

constexpr std::size_t kIntensityOffset = 12;
constexpr std::size_t kRangeOffset = 16;
constexpr std::size_t kPointAlignment = 4;

struct ChannelName {
  std::string_view name;
  FieldType type;
};
// The order is that of the enumeration Channel. Names and types are the same as in ouster_src.
constexpr std::array<ChannelName, 4> kChannels = {{{"reflectivity", FieldType::kU16},
                                                   {"signal", FieldType::kU16},
                                                   {"ring", FieldType::kU16},
                                                   {"t", FieldType::kU32}}};

std::uint32_t SlicesOf(const synth::ScannerConfig& config, std::uint32_t requested) {
  const SensorModel& model = config.sensor.model;
  if (config.sensor.firing != nullptr) requested = std::max(requested, 1U);
  return SlicesPerScan(requested, {model.columns_per_scan,
                                   static_cast<std::uint32_t>(model.beams.size()), config.period});
}

GstClockTime ToGst(Duration d) { return static_cast<GstClockTime>(d.count()); }

}  // namespace

std::optional<std::vector<Channel>> ParseChannels(std::string_view text, std::string* unknown) {
  std::vector<Channel> channels;
  while (!text.empty()) {
    const std::size_t comma = text.find(',');
    std::string_view name = text.substr(0, comma);
    text.remove_prefix(comma == std::string_view::npos ? text.size() : comma + 1);
    while (!name.empty() && name.front() == ' ') name.remove_prefix(1);
    while (!name.empty() && name.back() == ' ') name.remove_suffix(1);
    const auto* known = std::find_if(kChannels.begin(), kChannels.end(),
                                     [&](const ChannelName& c) { return c.name == name; });
    if (known == kChannels.end()) {
      *unknown = name;
      return std::nullopt;
    }
    const auto channel = static_cast<Channel>(known - kChannels.begin());
    if (std::find(channels.begin(), channels.end(), channel) == channels.end())
      channels.push_back(channel);
  }
  return channels;
}

SliceMaker::SliceMaker(const synth::ScannerConfig& config, const SliceOptions& options)
    : period_(config.period),
      scanner_(config),
      projection_(config.sensor.model),
      slices_(SlicesOf(config, options.slices_per_scan)),
      width_(config.sensor.model.columns_per_scan / slices_) {
  if (config.sensor.firing != nullptr) {
    driver_.emplace(*config.sensor.firing);
    return;
  }
  const CloudInfo info = InfoFor(config, options);
  point_step_ = info.point_step;
  for (const Channel channel : options.channels) {
    const std::string name(kChannels[static_cast<std::size_t>(channel)].name);
    extras_.push_back({channel, info.fields.Find(name)->offset});
  }
}

CloudInfo SliceMaker::InfoFor(const synth::ScannerConfig& config, const SliceOptions& options) {
  if (config.sensor.firing != nullptr) return DriverCloud::InfoFor(*config.sensor.firing);
  const SensorModel& model = config.sensor.model;
  CloudInfo info;
  info.width = model.columns_per_scan / SlicesOf(config, options.slices_per_scan);
  info.height = static_cast<guint>(model.beams.size());
  info.fields.Add("x", FieldType::kF32)
      .Add("y", FieldType::kF32)
      .Add("z", FieldType::kF32)
      .Add("intensity", FieldType::kF32)
      .Add("range", FieldType::kU32);
  for (const Channel channel : options.channels) {
    const ChannelName& c = kChannels[static_cast<std::size_t>(channel)];
    info.fields.Add(std::string(c.name), c.type);
  }
  info.point_step = static_cast<guint>((info.fields.MinimumStep() + kPointAlignment - 1) /
                                       kPointAlignment * kPointAlignment);
  info.framerate_n = static_cast<gint>(std::chrono::seconds(1) / config.period);
  info.sensor_model = model;
  return info;
}

Duration SliceMaker::LongestSlice() const {
  // The durations of slices differ by a nanosecond, because they are rounded.
  return period_ / std::int64_t{slices_} + Duration{1};
}

void SliceMaker::WritePoints(guint8* points) const {
  projection_.Project(returns_.range_mm.data(), {FirstColumn(), width_}, points, point_step_);
  guint8* point = points;
  for (std::size_t i = 0; i < returns_.range_mm.size(); ++i, point += point_step_) {
    const auto intensity = static_cast<float>(returns_.reflectivity[i]);
    std::memcpy(point + kIntensityOffset, &intensity, sizeof intensity);
    std::memcpy(point + kRangeOffset, &returns_.range_mm[i], sizeof returns_.range_mm[i]);
  }
  for (const Extra& extra : extras_) WriteExtra(extra, points);
}

void SliceMaker::WriteExtra(const Extra& extra, guint8* points) const {
  guint8* at = points + extra.offset;
  const auto store16 = [&at](std::size_t value) {
    const auto v = static_cast<std::uint16_t>(value);
    std::memcpy(at, &v, sizeof v);
  };
  for (std::size_t i = 0; i < returns_.range_mm.size(); ++i, at += point_step_) {
    switch (extra.channel) {
      case Channel::kReflectivity:
        store16(returns_.reflectivity[i]);
        break;
      case Channel::kSignal:
        store16(returns_.signal[i]);
        break;
      case Channel::kRing:
        store16(i / width_);
        break;
      case Channel::kTime: {
        const auto column = FirstColumn() + static_cast<std::uint32_t>(i % width_);
        const Duration since = scanner_.ColumnTime(scan_, column) - NextTime();
        const auto t = static_cast<std::uint32_t>(since.count());
        std::memcpy(at, &t, sizeof t);
        break;
      }
    }
  }
}

BufferPtr SliceMaker::MakePixels() const {
  BufferPtr buffer(
      gst_buffer_new_allocate(nullptr, returns_.range_mm.size() * point_step_, nullptr));
  BufferMap map(buffer.get(), GST_MAP_WRITE);
  // The gaps between fields are set to zero, so that the same seed gives the same bytes.
  if (!extras_.empty()) std::memset(map.data(), 0, map.size());
  WritePoints(map.data());
  return buffer;
}

BufferPtr SliceMaker::MakeRow(GstClockTime begin) {
  const Duration column = scanner_.ColumnTime(scan_, 1) - scanner_.ColumnTime(scan_, 0);
  const auto& row =
      driver_->Write(returns_, scanner_.rays(), {scan_, {FirstColumn(), width_}, begin, column});
  return BufferPtr(gst_buffer_new_memdup(row.data(), row.size()));
}

BufferPtr SliceMaker::Make(GstClockTime unix_begin) {
  const ColumnWindow window{FirstColumn(), width_};
  const Duration begin = NextTime();
  const Duration end = NextEnd();
  scanner_.Cast(scan_, window, &returns_);
  BufferPtr buffer = driver_ ? MakeRow(unix_begin) : MakePixels();
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
