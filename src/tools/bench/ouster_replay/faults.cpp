// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/ouster_replay/faults.h"

#include <utility>

namespace lidar::tools {
namespace {

bool TakeShare(const nlohmann::json& value, double* share) {
  if (!value.is_number() || value.get<double>() < 0 || value.get<double>() > 1) return false;
  *share = value.get<double>();
  return true;
}

bool TakeFlag(const nlohmann::json& value, bool* flag) {
  if (!value.is_boolean()) return false;
  *flag = value.get<bool>();
  return true;
}

bool TakeCount(const nlohmann::json& value, int* count) {
  if (!value.is_number_integer() || value < 0 || value > 100'000) return false;
  *count = value.get<int>();
  return true;
}

}  // namespace

std::string Faults::Merge(const nlohmann::json& change) {
  if (!change.is_object()) return "faults must be a JSON object";
  Faults next = *this;
  for (const auto& [key, value] : change.items()) {
    const bool taken = key == "loss"            ? TakeShare(value, &next.loss)
                       : key == "reorder"       ? TakeShare(value, &next.reorder)
                       : key == "duplicate"     ? TakeShare(value, &next.duplicate)
                       : key == "corrupt"       ? TakeShare(value, &next.corrupt)
                       : key == "silent"        ? TakeFlag(value, &next.silent)
                       : key == "wrong_size"    ? TakeFlag(value, &next.wrong_size)
                       : key == "http_status"   ? TakeCount(value, &next.http_status)
                       : key == "http_delay_ms" ? TakeCount(value, &next.http_delay_ms)
                                                : false;
    if (!taken) return "there is no fault \"" + key + "\" with value " + value.dump();
  }
  *this = next;
  return {};
}

nlohmann::ordered_json FaultCounts::ToJson() const {
  return {{"sent", sent},           {"lost", lost},
          {"reordered", reordered}, {"duplicated", duplicated},
          {"corrupted", corrupted}, {"silenced", silenced},
          {"imu_sent", imu_sent}};
}

bool FaultInjector::Chance(double probability) {
  return probability > 0 && std::uniform_real_distribution<double>(0, 1)(random_) < probability;
}

std::vector<OutPacket> FaultInjector::Apply(const Faults& faults, OutPacket packet) {
  std::vector<OutPacket> out;
  if (faults.silent) {
    counts_.silenced += packet.imu ? 0 : 1;
    return out;
  }
  if (packet.imu) {
    ++counts_.imu_sent;
    out.push_back(std::move(packet));
    return out;
  }
  if (Chance(faults.loss)) {
    ++counts_.lost;
    return out;
  }
  if (Chance(faults.corrupt)) {
    ++counts_.corrupted;
    packet.bytes[random_() % packet.bytes.size()] ^= 0x10;
  }
  if (faults.wrong_size) packet.bytes.resize(packet.bytes.size() / 2);
  if (!held_ && Chance(faults.reorder)) {
    ++counts_.reordered;
    held_ = std::move(packet);
    return out;
  }
  const bool twice = Chance(faults.duplicate);
  counts_.duplicated += twice ? 1 : 0;
  if (twice) out.push_back(packet);
  out.push_back(std::move(packet));
  for (OutPacket& held : Finish()) out.push_back(std::move(held));
  counts_.sent += twice ? 2 : 1;
  return out;
}

std::vector<OutPacket> FaultInjector::Finish() {
  if (!held_) return {};
  ++counts_.sent;
  return {*std::exchange(held_, std::nullopt)};
}

}  // namespace lidar::tools
