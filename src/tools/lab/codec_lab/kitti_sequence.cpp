// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/lab/codec_lab/kitti_sequence.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "src/tools/common/output_file.h"

namespace lidar::tools {
namespace {

constexpr std::size_t kLeastRings = 4;
constexpr std::size_t kMostRingsOfOrder = 256;
constexpr double kLatest_s = 9e9;

std::string NameOf(const std::string& folder, const char* kind, std::size_t number) {
  std::string digits = std::to_string(number);
  if (digits.size() < 6) digits.insert(0, 6 - digits.size(), '0');
  return folder + "/" + kind + "/" + digits + ".bin";
}

std::vector<float> ReadFloats(const std::string& path, std::size_t of_a_point) {
  const std::string bytes = ReadFile(path);
  if (bytes.size() % (of_a_point * sizeof(float)) != 0)
    throw std::runtime_error(path + ": not a list of " + std::to_string(of_a_point) +
                             " floats a point");
  std::vector<float> numbers(bytes.size() / sizeof(float));
  std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return numbers;
}

bool IsReturn(const float* p) {
  if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) return false;
  return p[0] != 0 || p[1] != 0 || p[2] != 0;
}

/// Returns the beam of each point. Phases ascend within a beam, so a new beam begins where the
/// phase falls. Returns an empty list if there would be too many beams.
std::vector<std::uint16_t> RingsOfPhases(const std::vector<float>& phases) {
  std::vector<std::uint16_t> rings;
  std::uint16_t ring = 0;
  for (std::size_t i = 0; i < phases.size(); ++i) {
    if (i > 0 && phases[i] < phases[i - 1] && ++ring >= kMostRingsOfOrder) return {};
    rings.push_back(ring);
  }
  return rings;
}

class KittiSequence final : public ScanStream {
 public:
  KittiSequence(std::string folder, std::vector<Time> times)
      : ScanStream(10), folder_(std::move(folder)), times_(std::move(times)) {
    std::vector<Duration> gaps;
    for (std::size_t i = 1; i < times_.size(); ++i) gaps.push_back(times_[i] - times_[i - 1]);
    if (gaps.empty()) return;
    std::nth_element(gaps.begin(), gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2),
                     gaps.end());
    SetPeriod(gaps[gaps.size() / 2]);
  }

  std::optional<TimedScan> Next() override {
    if (next_ == times_.size()) return std::nullopt;
    TimedScan timed;
    Read(next_, &timed.scan);
    timed.duration = period();
    timed.start = times_[next_++] - timed.duration / 2;
    return timed;
  }

 private:
  void Read(std::size_t number, Scan* scan) const {
    const std::string phases_file = NameOf(folder_, "phases", number);
    const std::vector<float> points = ReadFloats(NameOf(folder_, "velodyne", number), 4);
    std::vector<float> phases;
    if (std::filesystem::exists(phases_file)) phases = ReadFloats(phases_file, 1);
    if (!phases.empty() && phases.size() != points.size() / 4)
      throw std::runtime_error(phases_file + ": needs one phase for each point");
    const std::vector<std::uint16_t> rings = RingsOfPhases(phases);
    for (std::size_t i = 0; i < points.size() / 4; ++i) {
      const float* p = &points[4 * i];
      if (!IsReturn(p)) continue;
      scan->xyz.insert(scan->xyz.end(), p, p + 3);
      scan->intensity.push_back(p[3]);
      if (!phases.empty()) scan->phases.push_back(phases[i]);
      if (!rings.empty()) scan->rings.push_back(rings[i]);
    }
    if (rings.empty()) scan->rings = FindRings(scan->xyz);
  }

  std::string folder_;
  std::vector<Time> times_;
  std::size_t next_ = 0;
};

}  // namespace

std::vector<std::uint16_t> FindRings(const std::vector<float>& xyz) {
  std::vector<std::uint16_t> rings;
  std::size_t ring = 0;
  bool behind = false;
  for (std::size_t i = 0; i + 2 < xyz.size(); i += 3) {
    const bool ahead = xyz[i] > 0;
    behind |= !ahead;
    if (behind && ahead && xyz[i + 1] >= 0) {
      behind = false;
      ++ring;
    }
    if (ring >= kMostRingsOfOrder) return {};
    rings.push_back(static_cast<std::uint16_t>(ring));
  }
  if (ring + 1 < kLeastRings) return {};
  return rings;
}

std::vector<Time> ReadKittiTimes(const std::string& folder) {
  const std::string path = folder + "/times.txt";
  std::istringstream text(ReadFile(path));
  std::vector<Time> times;
  double seconds = 0;
  while (text >> seconds) {
    const auto fail = [&](const char* what) {
      throw std::runtime_error(path + ": line " + std::to_string(times.size() + 1) + what);
    };
    if (!(std::abs(seconds) < kLatest_s)) fail(" is not a time in seconds");
    const Time time = Time{} + FromSeconds(seconds);
    if (!times.empty() && time <= times.back()) fail(" is not later than the one before");
    times.push_back(time);
  }
  if (!text.eof())
    throw std::runtime_error(path + ": line " + std::to_string(times.size() + 1) +
                             " is not a time in seconds");
  return times;
}

std::unique_ptr<ScanStream> OpenKittiSequence(const std::string& folder) {
  if (!std::filesystem::is_directory(folder + "/velodyne"))
    throw std::runtime_error(folder + ": has no folder velodyne, which a KITTI sequence needs");
  std::vector<Time> times = ReadKittiTimes(folder);
  if (times.empty()) throw std::runtime_error(folder + "/times.txt: has no time");
  return std::make_unique<KittiSequence>(folder, std::move(times));
}

void WriteKittiScan(const std::string& folder, std::size_t number, const KittiScan& scan) {
  const auto write = [&](const char* kind, const std::vector<float>& numbers) {
    std::filesystem::create_directories(folder + "/" + kind);
    std::string bytes(numbers.size() * sizeof(float), '\0');
    std::memcpy(bytes.data(), numbers.data(), bytes.size());
    WriteFile(NameOf(folder, kind, number), bytes);
  };
  write("velodyne", scan.points);
  if (!scan.phases.empty()) write("phases", scan.phases);
}

}  // namespace lidar::tools
