// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/lab/lidar_eval/kitti_truth.h"

#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "src/tools/common/output_file.h"
#include "src/tools/lab/codec_lab/kitti_sequence.h"

namespace lidar::tools {
namespace {

using odometry::Pose;
using odometry::Trajectory;

constexpr Duration kAnyPeriod = std::chrono::milliseconds(100);

Trajectory ReadPoses(const std::string& text, const std::string& path) {
  std::istringstream in(text);
  std::string error;
  Trajectory poses = odometry::ReadTrajectory(in, kAnyPeriod, &error);
  if (poses.empty()) throw std::runtime_error(path + ": " + error);
  return poses;
}

/// Reads the row "Tr: ...", which is the pose of the sensor in the frame of the camera.
Pose ReadSensorPose(const std::string& path) {
  std::istringstream in(ReadFile(path));
  for (std::string line; std::getline(in, line);)
    if (line.rfind("Tr:", 0) == 0) return ReadPoses(line.substr(3) + "\n", path).front().pose;
  throw std::runtime_error(path + ": has no row Tr:");
}

}  // namespace

Trajectory ReadKittiTruth(const std::string& folder) {
  const std::string path = folder + "/poses.txt";
  if (!std::filesystem::exists(path)) return {};
  Trajectory truth = ReadPoses(ReadFile(path), path);
  const std::vector<Time> times = ReadKittiTimes(folder);
  if (truth.size() > times.size())
    throw std::runtime_error(path + ": more poses than times.txt has times");
  const std::string calibration = folder + "/calib.txt";
  const Pose sensor = std::filesystem::exists(calibration) ? ReadSensorPose(calibration) : Pose();
  for (std::size_t i = 0; i < truth.size(); ++i)
    truth[i] = {times[i], sensor.Inverse() * truth[i].pose * sensor};
  return truth;
}

}  // namespace lidar::tools
