// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/demo/slam.h"

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "src/tools/common/distribution.h"
#include "src/tools/common/output_file.h"
#ifdef HAVE_ODOMETRY
#include "src/odometry/trajectory_error.h"
#endif

namespace lidar::demo {
namespace {

#ifdef HAVE_ODOMETRY
nlohmann::ordered_json Errors(const std::string& folder) {
  const auto read = [&](const char* name) {
    std::ifstream file(folder + name);
    std::string error;
    return odometry::ReadTrajectory(file, Duration{0}, &error);
  };
  const odometry::Trajectory truth = read("/truth.tum");
  const odometry::Trajectory edge = read("/edge.tum");
  nlohmann::ordered_json json = {{"poses", edge.size()}};
  // There is no true trajectory if the source is a capture.
  const auto error = truth.empty() ? std::nullopt : Compare(truth, edge);
  if (!error) return json;
  json["length_m"] = error->length_m;
  json["ate_rmse_m"] = error->ate_rmse_m;
  json["ate_max_m"] = error->ate_max_m;
  json["rpe_rmse_m"] = error->rpe_rmse_m;
  json["end_error_m"] = error->end_error_m;
  return json;
}
#else
nlohmann::ordered_json Errors(const std::string&) { return nullptr; }
#endif

}  // namespace

bool CanFollow() {
#ifdef HAVE_ODOMETRY
  return true;
#else
  return false;
#endif
}

void AddSlam(const Measurements& m, const std::string& folder, nlohmann::ordered_json* summary) {
  nlohmann::ordered_json slam = Errors(folder);
  tools::Distribution delay_ms;
  tools::OutputFile out(folder + "/poses.csv");
  out.stream() << "scan,due_s,posed_s\n";
  for (const auto& [scan, posed] : m.ledger.posed()) {
    const auto life = m.ledger.scans().find(scan);
    if (life == m.ledger.scans().end()) continue;
    std::int64_t due = 0;
    for (const SliceLife& slice : life->second) due = std::max(due, slice.due);
    if (due == 0) continue;
    delay_ms.Add(static_cast<double>(posed - due) / 1e6);
    char line[96];
    std::snprintf(line, sizeof line, "%u,%.6f,%.6f\n", scan, m.Since(due), m.Since(posed));
    out.stream() << line;
  }
  out.Close();
  slam["capture_to_pose_ms"] = {
      {"p50", delay_ms.Percentile(50)}, {"p95", delay_ms.Percentile(95)}, {"max", delay_ms.Max()}};
  (*summary)["slam"] = std::move(slam);
}

void PrintSlam(const nlohmann::ordered_json& summary) {
  const auto& slam = summary["slam"];
  if (slam.contains("ate_rmse_m"))
    std::printf("  %-34s %.3f m (RMSE), %.3f m at most, of %.0f m\n", "trajectory error (ATE)",
                slam["ate_rmse_m"].get<double>(), slam["ate_max_m"].get<double>(),
                slam["length_m"].get<double>());
  std::printf("  %-34s p50 %7.2f   p95 %7.2f ms\n", "capture to pose, whole scan",
              slam["capture_to_pose_ms"]["p50"].get<double>(),
              slam["capture_to_pose_ms"]["p95"].get<double>());
}

}  // namespace lidar::demo
