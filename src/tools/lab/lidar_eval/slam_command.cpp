// SPDX-License-Identifier: LGPL-2.1-or-later
// lidar-eval slam and ate: slam computes the sensor's trajectory from its scans, and both compute
// the error of a trajectory.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "src/odometry/trajectory_error.h"
#include "src/tools/common/output_file.h"
#include "src/tools/lab/codec_lab/plot.h"
#include "src/tools/lab/codec_lab/progress.h"
#include "src/tools/lab/lidar_eval/commands.h"
#include "src/tools/lab/lidar_eval/kitti_truth.h"
#include "src/tools/lab/lidar_eval/scan_arguments.h"

namespace lidar::tools {
namespace {

using odometry::Tracking;
using odometry::Trajectory;
using odometry::TrajectoryError;

struct SlamArguments {
  ScanArguments scans;
  SlamOptions slam;
  std::string out;
  std::string truth;
  std::string errors;
  bool kitti = false;
  bool json = false;
};

struct AteArguments {
  std::string truth;
  std::string estimate;
  double kitti_rate = 10;
  bool json = false;
};

Trajectory Load(const std::string& path, double kitti_rate) {
  if (const auto folder = KittiFolderOf(path)) return ReadKittiTruth(*folder);
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot open " + path);
  std::string error;
  Trajectory trajectory = odometry::ReadTrajectory(file, FromSeconds(1 / kitti_rate), &error);
  if (trajectory.empty()) throw std::runtime_error(path + ": " + error);
  return trajectory;
}

void Save(const std::string& path, const Trajectory& trajectory, bool kitti) {
  tools::OutputFile output(path);
  std::ostream& file = output.stream();
  if (!kitti) file << "# timestamp tx ty tz qx qy qz qw\n";
  for (const odometry::StampedPose& pose : trajectory) {
    if (kitti) {
      WriteKittiLine(file, pose.pose);
    } else {
      WriteTumLine(file, pose);
    }
  }
  output.Close();
}

nlohmann::ordered_json ToJson(const TrajectoryError& e) {
  nlohmann::ordered_json j = {{"poses", e.poses},
                              {"length_m", e.length_m},
                              {"ate_rmse_m", e.ate_rmse_m},
                              {"ate_max_m", e.ate_max_m},
                              {"rpe_rmse_m", e.rpe_rmse_m},
                              {"rpe_rmse_deg", e.rpe_rmse_deg},
                              {"end_error_m", e.end_error_m}};
  if (e.drift) j["drift"] = *e.drift;
  return j;
}

void Print(const TrajectoryError& e) {
  std::printf("  %zu poses, %.1f m\n", e.poses, e.length_m);
  std::printf("  ATE   %.3f m (RMSE after alignment), %.3f m at most\n", e.ate_rmse_m, e.ate_max_m);
  std::printf("  RPE   %.4f m, %.4f degrees (RMSE over a second)\n", e.rpe_rmse_m, e.rpe_rmse_deg);
  std::printf("  end   %.3f m\n", e.end_error_m);
  if (e.drift) std::printf("  drift %.3f %% of 100 to 800 m\n", 100 * *e.drift);
}

std::size_t CountOf(const SlamResult& result, Tracking tracking) {
  return static_cast<std::size_t>(std::count(result.states.begin(), result.states.end(), tracking));
}

void PrintRun(const SlamResult& r) {
  const auto at = [&](double q) {
    return r.cpu_ms[static_cast<std::size_t>(q * static_cast<double>(r.cpu_ms.size() - 1))];
  };
  std::printf(
      "  %zu scans: %zu tracked, %zu where the scene hides the motion, %zu lost, %zu maps\n",
      r.estimate.size(), CountOf(r, Tracking::kTracking), CountOf(r, Tracking::kDegenerate),
      CountOf(r, Tracking::kLost), r.maps);
  std::printf("  CPU time a scan: %.1f ms median, %.1f ms p95; map of %zu voxels\n", at(0.5),
              at(0.95), r.map_voxels);
}

/// Returns the true trajectory that the user names. If the user names none, returns that of the
/// source.
Trajectory FindTruth(const SlamArguments& a, const SlamResult& r, double scans_per_second) {
  if (!a.truth.empty()) return Load(a.truth, scans_per_second);
  return KittiFolderOf(a.scans.source) ? Load(a.scans.source, scans_per_second) : r.truth;
}

nlohmann::ordered_json ToJson(const Calibration& c) {
  return {{"mean", c.mean},
          {"within_1_sigma", c.within_1_sigma},
          {"within_3_sigma", c.within_3_sigma},
          {"width", c.width}};
}

void Print(const Calibration& c, const char* unit) {
  std::printf(
      "  deviation %.4f %s in the mean; error within one of it %.0f %%, within three %.1f %%\n",
      c.mean, unit, 100 * c.within_1_sigma, 100 * c.within_3_sigma);
}

/// The calibrations of the deviations of positions and of orientations.
struct Calibrations {
  std::optional<Calibration> position;
  std::optional<Calibration> orientation;
};

/// Writes one row for each scan.
void SaveErrors(const std::string& path, const SlamResult& r,
                const std::vector<odometry::Twist>& errors) {
  tools::OutputFile output(path);
  std::ostream& file = output.stream();
  file << "time,tracking,x,y,z,rx,ry,rz,sx,sy,sz,srx,sry,srz\n";
  for (std::size_t i = 0; i < errors.size(); ++i) {
    file << Seconds(r.estimate[i].time.time_since_epoch()) << ',' << ToString(r.states[i]);
    for (const double e : errors[i]) file << ',' << e;
    for (const double v : r.covariance[i].diagonal()) file << ',' << std::sqrt(v);
    file << '\n';
  }
  output.Close();
}

void RunSlamCommand(const SlamArguments& a) {
  const std::string& source = a.scans.source;
  const auto scans = OpenScans(a.scans);
  SlamOptions options = a.slam;
  options.loss = a.scans.loss;
  options.max_scans = a.scans.read.max_scans;
  const auto bar = ProgressBar("slam");
  const SlamResult r = RunSlam(scans.get(), options, [&](std::size_t done) {
    if (options.max_scans > 0)
      bar(static_cast<double>(done) / static_cast<double>(options.max_scans));
  });
  if (r.estimate.empty()) throw std::runtime_error(source + ": has no scan");
  if (!a.out.empty()) Save(a.out, options.close_loops ? r.closed : r.estimate, a.kitti);
  const Trajectory truth = FindTruth(a, r, scans->scans_per_second());
  const auto error = Compare(truth, r.estimate);
  const auto closed = Compare(truth, r.closed);
  const auto errors = ErrorsOf(r, truth);
  const Calibrations calibration{Calibrate(errors, r.covariance, 0),
                                 Calibrate(errors, r.covariance, 3)};
  if (!a.errors.empty()) SaveErrors(a.errors, r, errors);
  if (a.json) {
    nlohmann::ordered_json j = {{"source", source},
                                {"scans", r.estimate.size()},
                                {"tracked", CountOf(r, Tracking::kTracking)},
                                {"degenerate", CountOf(r, Tracking::kDegenerate)},
                                {"lost", CountOf(r, Tracking::kLost)},
                                {"with_gyroscope", r.with_gyroscope},
                                {"maps", r.maps},
                                {"lost_at_start", r.lost_at_start},
                                {"cpu_ms_median", r.cpu_ms[(r.cpu_ms.size() - 1) / 2]},
                                {"cpu_ms_p95", r.cpu_ms[(r.cpu_ms.size() - 1) * 95 / 100]},
                                {"mean_point_error_m", r.mean_point_error_m},
                                {"max_point_error_m", r.max_point_error_m}};
    if (error) j["error"] = ToJson(*error);
    if (calibration.position) j["deviation"] = ToJson(*calibration.position);
    if (calibration.orientation) j["turn_deviation"] = ToJson(*calibration.orientation);
    if (options.close_loops)
      j["loop_closure"] = {{"local_maps", r.local_maps}, {"closures", r.closures}};
    if (closed) j["loop_closure"]["error"] = ToJson(*closed);
    std::cout << j.dump(2) << '\n';
    return;
  }
  std::printf("%s\n", source.c_str());
  PrintRun(r);
  if (error) Print(*error);
  if (calibration.position) Print(*calibration.position, "m");
  if (calibration.orientation) Print(*calibration.orientation, "rad");
  if (!options.close_loops) return;
  std::printf("With %zu loops closed between %zu local maps\n", r.closures, r.local_maps);
  if (closed) Print(*closed);
}

void RunAteCommand(const AteArguments& a) {
  const auto error = Compare(Load(a.truth, a.kitti_rate), Load(a.estimate, a.kitti_rate));
  if (!error)
    throw std::runtime_error("fewer than three poses of " + a.estimate +
                             " lie within the time of " + a.truth);
  if (a.json) {
    std::cout << ToJson(*error).dump(2) << '\n';
    return;
  }
  Print(*error);
}

}  // namespace

void AddSlamCommand(CLI::App* app) {
  auto a = std::make_shared<SlamArguments>();
  CLI::App* command =
      app->add_subcommand("slam", "Estimates the route of the sensor from its scans");
  command->option_defaults()->always_capture_default();
  AddScanOptions(command, &a->scans);
  command->add_option("--out", a->out, "Write the trajectory to this file, in TUM's format");
  command->add_flag("--kitti", a->kitti, "Write it in KITTI's format");
  command->add_option("--truth", a->truth,
                      "Compare with this trajectory (TUM or KITTI); synthetic drives bring theirs");
  command->add_option("--errors", a->errors,
                      "Write error and deviation of each pose to this file, as CSV [m, rad]");
  command->add_option("--voxel-size", a->slam.odometry.voxel_size_m, "Edge of the map's cubes [m]")
      ->check(CLI::Range(0.05, 20.0));
  command
      ->add_option("--max-range", a->slam.odometry.max_range_m,
                   "Greatest range of points, and radius of the map [m]")
      ->check(CLI::Range(1.0, 1000.0));
  command->add_flag("--gyroscope", a->slam.gyroscope,
                    "Give the odometry a gyroscope, with the bias and noise of a data sheet; of "
                    "synthetic drives");
  command->add_flag("--loop-closure", a->slam.close_loops,
                    "Find places that were seen before, and take out the drift between");
  command
      ->add_option("--local-maps", a->slam.most_local_maps,
                   "Kept for --loop-closure, two megabytes each")
      ->check(CLI::Range(3, 10000));
  command->add_flag("--json", a->json, "Print JSON");
  command->callback([a] { RunSlamCommand(*a); });
}

void AddAteCommand(CLI::App* app) {
  auto a = std::make_shared<AteArguments>();
  CLI::App* command = app->add_subcommand(
      "ate", "Errors of a trajectory relative to the true one: ATE, RPE, drift");
  command->option_defaults()->always_capture_default();
  command->add_option("TRUTH", a->truth, "Trajectory in TUM's or KITTI's format, or kitti:FOLDER")
      ->required();
  command->add_option("ESTIMATE", a->estimate, "Trajectory to compare with it")->required();
  command->add_option("--kitti-rate", a->kitti_rate, "Poses a second of KITTI files")
      ->check(CLI::Range(0.01, 1000.0));
  command->add_flag("--json", a->json, "Print JSON");
  command->callback([a] { RunAteCommand(*a); });
}

}  // namespace lidar::tools
