// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/apps/worker/lease_record.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace lidar::worker {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxText = 4096;
constexpr std::size_t kMaxName = 200;
constexpr std::uint64_t kMaxLeaseMs = 60'000;
constexpr double kMaxMetres = 1e9;
constexpr double kMaxSpeed = 1e3;     // [m/s]
constexpr double kMaxTurnRate = 100;  // [rad/s]
constexpr std::uint64_t kShortestStepNs = 2'000'000;
constexpr std::uint64_t kLongestStepNs = 1'000'000'000;

bool ReadCount(const json& object, const char* key, std::uint64_t* value) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number_unsigned()) return false;
  *value = found->get<std::uint64_t>();
  return true;
}

template <std::size_t count>
bool ReadNumbers(const json& object, const char* key, std::array<double, count>* numbers) {
  const auto list = object.find(key);
  if (list == object.end() || !list->is_array() || list->size() != count) return false;
  for (std::size_t i = 0; i < count; ++i) {
    if (!(*list)[i].is_number()) return false;
    (*numbers)[i] = (*list)[i].template get<double>();
  }
  return true;
}

bool IsPose(const std::array<double, 7>& p) {
  const double norm = std::sqrt(p[3] * p[3] + p[4] * p[4] + p[5] * p[5] + p[6] * p[6]);
  return std::all_of(p.begin(), p.end(), [](double v) { return std::abs(v) <= kMaxMetres; }) &&
         norm > 0.9 && norm < 1.1;
}

/// Returns true if the velocity is plausible. NaN is not plausible.
bool IsVelocity(const std::array<double, 6>& v) {
  return std::all_of(v.begin(), v.begin() + 3, [](double s) { return std::abs(s) <= kMaxSpeed; }) &&
         std::all_of(v.begin() + 3, v.end(), [](double s) { return std::abs(s) <= kMaxTurnRate; });
}

/// Reads the velocity. Returns nothing if it is missing or implausible.
std::optional<std::array<double, 6>> ReadVelocity(const json& object) {
  std::array<double, 6> velocity{};
  const bool good = ReadNumbers(object, "velocity", &velocity) && IsVelocity(velocity);
  return good ? std::optional(velocity) : std::nullopt;
}

using Quaternion = std::array<double, 4>;  // x y z w

Quaternion RotationOf(const Progress& p) { return {p.pose[3], p.pose[4], p.pose[5], p.pose[6]}; }

Quaternion Inverse(const Quaternion& q) { return {-q[0], -q[1], -q[2], q[3]}; }

Quaternion Product(const Quaternion& a, const Quaternion& b) {
  return {a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
          a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
          a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
          a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
}

bool ReadProgress(const json& object, Progress* progress) {
  progress->velocity = ReadVelocity(object);
  return ReadNumbers(object, "pose", &progress->pose) &&
         ReadCount(object, "time", &progress->time) &&
         ReadCount(object, "stream", &progress->stream) &&
         ReadCount(object, "scan", &progress->scan) && ReadCount(object, "from", &progress->from) &&
         ReadsBack(*progress);
}

}  // namespace

bool ReadsBack(const Progress& progress) {
  return IsPose(progress.pose) && progress.from > 0 && progress.from <= progress.scan;
}

std::optional<std::array<double, 6>> VelocityBetween(const Progress& before,
                                                     const Progress& after) {
  if (after.time <= before.time) return std::nullopt;
  const std::uint64_t step_ns = after.time - before.time;
  if (step_ns < kShortestStepNs || step_ns > kLongestStepNs) return std::nullopt;
  const double seconds = static_cast<double>(step_ns) * 1e-9;
  const Quaternion begin = RotationOf(before);
  const Quaternion turn = Product(Inverse(begin), RotationOf(after));
  const double sine = std::hypot(turn[0], turn[1], turn[2]);
  // Each rotation has two quaternions. Takes the one with the smaller angle.
  const double angle = 2 * std::atan2(std::copysign(sine, turn[3]), std::abs(turn[3]));
  // Expresses the velocity in the orientation halfway between the scans, so that a bend does not
  // look like a drift.
  Quaternion half = {turn[0], turn[1], turn[2], turn[3] + std::copysign(1.0, turn[3])};
  const double norm =
      std::sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2] + half[3] * half[3]);
  for (double& value : half) value /= norm;
  const Quaternion middle = Product(begin, half);
  const Quaternion way = {after.pose[0] - before.pose[0], after.pose[1] - before.pose[1],
                          after.pose[2] - before.pose[2], 0};
  const Quaternion seen = Product(Product(Inverse(middle), way), middle);
  std::array<double, 6> velocity{};
  for (std::size_t i = 0; i < 3; ++i) {
    velocity[i] = seen[i] / seconds;
    velocity[i + 3] = sine > 0 ? turn[i] / sine * angle / seconds : 0;
  }
  return IsVelocity(velocity) ? std::optional(velocity) : std::nullopt;
}

std::string ToJson(const LeaseRecord& record) {
  json object = {
      {"worker", record.worker},
      {"lease-ms", std::chrono::duration_cast<std::chrono::milliseconds>(record.lease).count()}};
  if (const auto& progress = record.progress) {
    object["pose"] = progress->pose;
    if (progress->velocity) object["velocity"] = *progress->velocity;
    object["time"] = progress->time;
    object["stream"] = progress->stream;
    object["scan"] = progress->scan;
    object["from"] = progress->from;
  }
  return object.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::optional<LeaseRecord> ParseLeaseRecord(std::string_view text) {
  if (text.empty()) return LeaseRecord();
  if (text.size() > kMaxText) return std::nullopt;
  const json object = json::parse(text, nullptr, false);
  if (!object.is_object()) return std::nullopt;
  LeaseRecord record;
  const auto worker = object.find("worker");
  std::uint64_t lease_ms = 0;
  if (worker == object.end() || !worker->is_string() || !ReadCount(object, "lease-ms", &lease_ms) ||
      lease_ms > kMaxLeaseMs)
    return std::nullopt;
  record.worker = worker->get<std::string>();
  if (record.worker.size() > kMaxName) return std::nullopt;
  record.lease = std::chrono::milliseconds(lease_ms);
  if (object.find("pose") == object.end()) return record;
  record.progress.emplace();
  if (!ReadProgress(object, &*record.progress)) return std::nullopt;
  return record;
}

}  // namespace lidar::worker
