// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads the scans that a command line names, such as captures, cloud files and synthetic drives.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "src/base/time.h"
#include "src/synth/trajectory.h"
#include "src/tools/lab/codec_lab/scan.h"

namespace lidar::tools {

struct SourceOptions {
  std::size_t max_scans = 20;  // greatest number of scans to read from each source; 0: all
  double speed_mps = 10;       // speed of synthetic drives
  double roughness = 1;        // roughness of synthetic roads, relative to that of the scene
  std::uint64_t seed = 0;      // seed of synthetic drives
  double noise_m = 0.01;       // standard deviation of synthetic ranges, on a bright target nearby
  bool mixed_pixels = false;   // true: synthetic ranges at edges lie between both surfaces
};

/// A scan, and the time at which it was captured.
struct TimedScan {
  Scan scan;
  Time start{};  // time of the first column
  Duration duration{};
  // The pose of the sensor in the middle of the scan, if the source has it.
  std::optional<synth::Pose> truth;
};

/// Scans in sequence. Each scan is read or computed when it is requested, so that a drive may have
/// any length.
class ScanStream {
 public:
  explicit ScanStream(double scans_per_second) : scans_per_second_(scans_per_second) {}
  virtual ~ScanStream() = default;
  /// Returns the next scan, or nothing at the end. Throws std::runtime_error with a message for the
  /// user.
  virtual std::optional<TimedScan> Next() = 0;
  /// Returns the motion of the sensor, or null if the source does not have it. The motion has the
  /// same time axis as the scans.
  virtual const synth::Trajectory* trajectory() const { return nullptr; }
  double scans_per_second() const { return scans_per_second_; }

 protected:
  void SetPeriod(Duration period) { scans_per_second_ = 1 / Seconds(period); }
  Duration period() const { return FromSeconds(1 / scans_per_second_); }

 private:
  double scans_per_second_;
};

/// Opens a source of scans. `text` is one of
///   drive.pcap             an Ouster capture; its metadata is drive.json in the same folder
///   drive.pcap,sensor.json an Ouster capture, and its metadata
///   cloud.bin              a cloud (KITTI's x y z intensity floats)
///   cloud.pcd, cloud.ply   a cloud
///   drive.mcap             the clouds of a recording; drive.mcap,/points: only of this topic
///   drive.db3, folder      the clouds of a bag of ROS 2, in databases or MCAP files
///   kitti:FOLDER           a sequence of KITTI's odometry benchmark
///   folder                 consecutive clouds in files such as cloud.bin, sorted by name
///   synth:os1-64:street    a synthetic sensor in street, tunnel, field or town; a third part is
///                          the number of columns (1024)
/// Throws std::runtime_error with a message for the user.
std::unique_ptr<ScanStream> OpenScans(const std::string& text, const SourceOptions& options);
/// Returns the folder that kitti:FOLDER names, or nothing for another source.
std::optional<std::string> KittiFolderOf(const std::string& text);
/// Loads all scans of a source at once. Throws std::runtime_error if the source cannot be read.
ScanSet LoadScans(const std::string& text, const SourceOptions& options);
std::vector<ScanSet> LoadAllScans(const std::vector<std::string>& texts,
                                  const SourceOptions& options);

extern const char* const kSourceHelp;

}  // namespace lidar::tools
