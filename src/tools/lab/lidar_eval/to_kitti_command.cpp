// SPDX-License-Identifier: LGPL-2.1-or-later
// lidar-eval to-kitti: writes files for other odometry programs. They contain the points that slam
// would use.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "src/tools/common/output_file.h"
#include "src/tools/lab/codec_lab/kitti_sequence.h"
#include "src/tools/lab/codec_lab/progress.h"
#include "src/tools/lab/lidar_eval/commands.h"
#include "src/tools/lab/lidar_eval/kitti_truth.h"
#include "src/tools/lab/lidar_eval/scan_arguments.h"

namespace lidar::tools {
namespace {

struct ToKittiArguments {
  ScanArguments scans;
  std::string folder;
};

KittiScan ToKitti(const odometry::TimedPoints& scan) {
  KittiScan out;
  for (const Eigen::Vector3d& p : scan.points)
    for (const double number : {p.x(), p.y(), p.z(), 0.0})
      out.points.push_back(static_cast<float>(number));
  if (scan.phases.size() == scan.points.size()) out.phases = scan.phases;
  return out;
}

void RunToKitti(const ToKittiArguments& a) {
  if (std::filesystem::exists(a.folder) && !std::filesystem::is_empty(a.folder))
    throw std::runtime_error(a.folder + ": not empty; scans of two sequences would mix");
  const auto scans = OpenScans(a.scans);
  const std::size_t most = a.scans.read.max_scans;
  const auto bar = ProgressBar("to-kitti");
  const auto known = KittiFolderOf(a.scans.source);
  const odometry::Trajectory known_truth = known ? ReadKittiTruth(*known) : odometry::Trajectory();
  odometry::Trajectory truth;
  std::size_t done = 0;
  std::filesystem::create_directories(a.folder);
  OutputFile times(a.folder + "/times.txt");
  while (most == 0 || done < most) {
    const auto timed = scans->Next();
    if (!timed) break;
    const Time middle = timed->start + timed->duration / 2;
    WriteKittiScan(a.folder, done++, ToKitti(PointsOf(timed->scan, a.scans.loss)));
    char line[32];
    std::snprintf(line, sizeof line, "%.9f\n", Seconds(middle.time_since_epoch()));
    times.stream() << line;
    if (timed->truth) truth.push_back({middle, TrueMiddle(*timed)});
    if (!known_truth.empty()) truth.push_back({middle, InterpolateAt(known_truth, middle)});
    if (most > 0) bar(static_cast<double>(done) / static_cast<double>(most));
  }
  times.Close();
  std::printf("%s: %zu scans%s\n", a.folder.c_str(), done,
              truth.empty() ? ", whose true way is not known" : "");
  if (truth.empty()) return;
  OutputFile poses(a.folder + "/poses.txt");
  for (const odometry::StampedPose& pose : truth) WriteKittiLine(poses.stream(), pose.pose);
  poses.Close();
}

}  // namespace

void AddToKittiCommand(CLI::App* app) {
  auto a = std::make_shared<ToKittiArguments>();
  CLI::App* command = app->add_subcommand(
      "to-kitti", "Writes scans in the layout of KITTI's odometry benchmark, for other programs");
  command->option_defaults()->always_capture_default();
  AddScanOptions(command, &a->scans);
  command->add_option("-o,--output", a->folder, "Folder to write")->required();
  command->callback([a] { RunToKitti(*a); });
}

}  // namespace lidar::tools
