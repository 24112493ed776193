// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/worker/lease_record.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace lidar::worker {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxText = 4096;
constexpr std::size_t kMaxName = 200;
constexpr std::uint64_t kMaxLeaseMs = 60'000;
constexpr double kMaxMetres = 1e9;

bool ReadCount(const json& object, const char* key, std::uint64_t* value) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number_unsigned()) return false;
  *value = found->get<std::uint64_t>();
  return true;
}

bool ReadPose(const json& list, std::array<double, 7>* pose) {
  if (!list.is_array() || list.size() != pose->size()) return false;
  for (std::size_t i = 0; i < pose->size(); ++i) {
    if (!list[i].is_number()) return false;
    const double value = (*pose)[i] = list[i].get<double>();
    if (!std::isfinite(value) || std::abs(value) > kMaxMetres) return false;
  }
  const auto& p = *pose;
  const double norm = std::sqrt(p[3] * p[3] + p[4] * p[4] + p[5] * p[5] + p[6] * p[6]);
  return norm > 0.9 && norm < 1.1;
}

bool ReadProgress(const json& object, Progress* progress) {
  const auto pose = object.find("pose");
  return pose != object.end() && ReadPose(*pose, &progress->pose) &&
         ReadCount(object, "time", &progress->time) &&
         ReadCount(object, "stream", &progress->stream) &&
         ReadCount(object, "scan", &progress->scan) && ReadCount(object, "from", &progress->from) &&
         progress->from > 0 && progress->from <= progress->scan;
}

}  // namespace

std::string ToJson(const LeaseRecord& record) {
  json object = {
      {"worker", record.worker},
      {"lease-ms", std::chrono::duration_cast<std::chrono::milliseconds>(record.lease).count()}};
  if (const auto& progress = record.progress) {
    object["pose"] = progress->pose;
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
