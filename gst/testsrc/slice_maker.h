// SPDX-License-Identifier: LGPL-2.1-or-later
// Slices of a synthetic scan as buffers of the cloud caps.
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

/// Fields of a point beyond x, y, z, intensity and range.
enum class Channel { kReflectivity, kSignal, kRing, kTime };

/// Parses "reflectivity,ring". Returns nothing for an unknown name, and sets `unknown`.
std::optional<std::vector<Channel>> ParseChannels(std::string_view text, std::string* unknown);

struct SliceOptions {
  // 0: automatic, or whole scans of a sensor with a firing table.
  std::uint32_t slices_per_scan = 0;
  std::vector<Channel> channels;
};

/// Scans one slice after the other. Stamps count from the start of the first scan.
class SliceMaker {
 public:
  SliceMaker(const synth::ScannerConfig& config, const SliceOptions& options);

  /// Caps of the slices of a source with these options. With a firing table they do not fix the
  /// width, because each slice has its own.
  static CloudInfo InfoFor(const synth::ScannerConfig& config, const SliceOptions& options);

  /// Time at which the first column of the next slice is sampled.
  Duration NextTime() const { return scanner_.ColumnTime(scan_, FirstColumn()); }
  /// Time at which the next slice ends.
  Duration NextEnd() const { return scanner_.ColumnTime(scan_, FirstColumn() + width_); }
  const synth::Trajectory& trajectory() const { return scanner_.trajectory(); }
  Duration LongestSlice() const;
  Duration period() const { return period_; }
  /// Casts the next slice into a buffer with PTS, duration and slice meta. `begin` is NextTime()
  /// since 1970.
  BufferPtr Make(GstClockTime begin);
  /// Caps of the last slice if each slice has its own, else null. The width is 0 if there are no
  /// returns.
  const CloudInfo* OwnInfo() const { return driver_ ? &driver_->info() : nullptr; }
  /// Continues with the first slice of the scan that is being swept at `time`.
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
  std::uint32_t width_;  // columns of a slice
  std::size_t point_step_;
  std::vector<Extra> extras_;
  std::optional<DriverCloud> driver_;
  std::uint64_t scan_ = 0;
  std::uint32_t slice_ = 0;
  synth::Returns returns_;
};

}  // namespace lidar::gst
