// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads the scans that a command line names: captures, cloud files and synthetic drives.
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
  std::size_t max_scans = 20;  // of each source; 0: all there are
  double speed_mps = 10;       // of synthetic drives
  double roughness = 1;        // of synthetic drives, relative to the scene's own
  std::uint64_t seed = 0;      // of synthetic drives
  double noise_m = 0.01;       // of synthetic ranges on a bright target nearby
  bool mixed_pixels = false;   // of synthetic drives
};

/// A scan and the time of its capture.
struct TimedScan {
  Scan scan;
  Time start{};  // of the first column
  Duration duration{};
  std::optional<synth::Pose> truth;  // in the middle, if the source has it
};

/// Scans in sequence, read or computed on request: a drive may have any length.
class ScanStream {
 public:
  explicit ScanStream(double scans_per_second) : scans_per_second_(scans_per_second) {}
  virtual ~ScanStream() = default;
  /// Returns nothing at the end. Throws std::runtime_error with a message for the user.
  virtual std::optional<TimedScan> Next() = 0;
  /// The motion of the sensor, if the source has it. Its times are those of the scans.
  virtual const synth::Trajectory* trajectory() const { return nullptr; }
  double scans_per_second() const { return scans_per_second_; }

 protected:
  void SetPeriod(Duration period) { scans_per_second_ = 1 / Seconds(period); }
  Duration period() const { return FromSeconds(1 / scans_per_second_); }

 private:
  double scans_per_second_;
};

/// `text` is one of
///   drive.pcap             an Ouster capture; its metadata is drive.json in the same folder
///   drive.pcap,sensor.json the same with another metadata file
///   cloud.bin              a cloud (KITTI's x y z intensity floats)
///   cloud.pcd, cloud.ply   a cloud
///   drive.mcap             the clouds of a recording; drive.mcap,/points: those of one topic
///   drive.db3, folder      the same of a bag of ROS 2, whose parts are databases or MCAP files
///   kitti:FOLDER           a sequence of KITTI's odometry benchmark
///   folder                 consecutive clouds in such files, by name
///   synth:os1-64:street    a synthetic sensor in street, tunnel, field or town; a third part is
///                          the number of columns (1024)
/// Throws std::runtime_error with a message for the user.
std::unique_ptr<ScanStream> OpenScans(const std::string& text, const SourceOptions& options);
/// The folder that kitti:FOLDER names.
std::optional<std::string> KittiFolderOf(const std::string& text);
/// Loads all scans at once. Throws std::runtime_error if there is none.
ScanSet LoadScans(const std::string& text, const SourceOptions& options);
std::vector<ScanSet> LoadAllScans(const std::vector<std::string>& texts,
                                  const SourceOptions& options);

extern const char* const kSourceHelp;

}  // namespace lidar::tools
