// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts slices of a synthetic scan to buffers with the caps of a cloud.
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "gst/common/refs.h"
#include "gst/lidar/cloud_info.h"
#include "gst/testsrc/driver_cloud.h"
#include "src/synth/scanner.h"

namespace lidar::gst {

/// The fields of a point besides x, y, z, intensity and range.
enum class Channel { kReflectivity, kSignal, kRing, kTime };

/// Parses a list such as "reflectivity,ring". If a name is unknown, returns nothing and sets
/// `unknown` to the name.
std::optional<std::vector<Channel>> ParseChannels(std::string_view text, std::string* unknown);

struct SliceOptions {
  // 0: automatic, but whole scans for a sensor with a firing table.
  std::uint32_t slices_per_scan = 0;
  std::vector<Channel> channels;
};

/// Makes the slices of a scan, one after the other. Times are counted from the start of the first
/// scan.
class SliceMaker {
 public:
  SliceMaker(const synth::ScannerConfig& config, const SliceOptions& options);

  /// Returns the caps of slices that are made with these options. They have no width if the sensor
  /// has a firing table, because each slice then has a different width.
  static CloudInfo InfoFor(const synth::ScannerConfig& config, const SliceOptions& options);

  /// Returns the time at which the first column of the next slice is sampled.
  Duration NextTime() const { return scanner_.ColumnTime(scan_, FirstColumn()); }
  /// Returns the time at which the next slice ends.
  Duration NextEnd() const { return scanner_.ColumnTime(scan_, FirstColumn() + width_); }
  const synth::Trajectory& trajectory() const { return scanner_.trajectory(); }
  Duration LongestSlice() const;
  Duration period() const { return period_; }
  /// Makes the next slice, with PTS, duration and slice meta. `begin` is NextTime() converted to a
  /// time since 1970.
  BufferPtr Make(GstClockTime begin);
  /// If each slice has different caps, returns those of the slice that was made last. Otherwise
  /// returns null. The width in these caps is 0 if the slice has no returns.
  const CloudInfo* OwnInfo() const { return driver_ ? &driver_->info() : nullptr; }
  /// Continues with the first slice of the scan that is measured at `time`.
  void SkipTo(Duration time);

 private:
  struct Extra {
    Channel channel;
    std::size_t offset;
  };

  BufferPtr MakePixels() const;
  BufferPtr MakeRow(GstClockTime begin);
  void WritePoints(guint8* points) const;
  void WriteExtra(const Extra& extra, guint8* points) const;
  std::uint32_t FirstColumn() const { return slice_ * width_; }

  Duration period_;
  synth::Scanner scanner_;
  RangeProjection projection_;
  std::uint32_t slices_;
  std::uint32_t width_;  // number of columns in a slice
  std::size_t point_step_;
  std::vector<Extra> extras_;
  std::optional<DriverCloud> driver_;
  std::uint64_t scan_ = 0;
  std::uint32_t slice_ = 0;
  synth::Returns returns_;
};

}  // namespace lidar::gst
