// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/odometry/trajectory.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iomanip>
#include <locale>

namespace lidar::odometry {
namespace {

constexpr std::size_t kTumColumns = 8;
constexpr std::size_t kKittiColumns = 12;
constexpr double kMaxSpeedMps = 1'000;
constexpr double kMaxTurnRadPerS = 100;

struct Row {
  std::array<double, kKittiColumns> values{};
  std::size_t count = 0;
};

bool IsSpace(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/// Reads the numbers of a line. Returns false if a word is not a finite number, or if there are too
/// many words.
bool ParseRow(const std::string& line, Row* row) {
  const char* at = line.data();
  const char* const end = at + line.size();
  for (;;) {
    while (at < end && IsSpace(*at)) ++at;
    if (at == end) return true;
    if (row->count == kKittiColumns) return false;
    double& value = row->values[row->count++];
    const auto [next, failed] = std::from_chars(at, end, value);
    if (failed != std::errc{} || !std::isfinite(value)) return false;
    if (next < end && !IsSpace(*next)) return false;
    at = next;
  }
}

/// Reads a time. Seconds and fraction are read separately, because a double cannot represent a Unix
/// time in nanoseconds.
bool ParseTime(const std::string& line, Time* time) {
  const auto begin = line.find_first_not_of(" \t");
  const auto end = line.find_first_of(" \t", begin);
  const std::string word = line.substr(begin, end - begin);
  std::int64_t seconds = 0;
  const auto [next, failed] = std::from_chars(word.data(), word.data() + word.size(), seconds);
  double fraction = 0;
  if (failed != std::errc{}) return false;
  const bool plain = word.find_first_of("eE") == std::string::npos;
  if (plain && *next == '.') {
    const std::string digits = "0" + std::string(next);
    std::from_chars(digits.data(), digits.data() + digits.size(), fraction);
  } else if (*next != '\0') {
    double whole = 0;  // NumPy writes times such as 1.7e9
    std::from_chars(word.data(), word.data() + word.size(), whole);
    if (std::abs(whole) > 9e9) return false;
    *time = Time{} + FromSeconds(whole);
    return true;
  }
  if (seconds > 9'000'000'000 || seconds < -9'000'000'000) return false;
  *time =
      Time{} + std::chrono::seconds(seconds) + FromSeconds(word[0] == '-' ? -fraction : fraction);
  return true;
}

/// Reads the columns of a TUM file, starting with tx.
bool ToPose(const double* v, Pose* pose) {
  pose->position = {v[0], v[1], v[2]};
  const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
  pose->rotation = q.normalized();
  return q.norm() > 0.5 && q.norm() < 2;
}

bool ToPose(const Row& row, Pose* pose) {
  const auto& v = row.values;
  if (row.count == kTumColumns) return ToPose(&v[1], pose);
  Eigen::Matrix3d rotation;
  rotation << v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10];
  pose->position = {v[3], v[7], v[11]};
  pose->rotation = Eigen::Quaterniond(rotation).normalized();
  return (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm() < 0.01;
}

/// Sets the C locale of the stream, but only before the first output. Setting a locale flushes the
/// stream, and if that fails, for example because the disk is full, the stream cannot be closed.
void WriteAsInC(std::ostream& out) {
  if (out.getloc() != std::locale::classic()) out.imbue(std::locale::classic());
}

}  // namespace

void WriteTumLine(std::ostream& out, const StampedPose& stamped) {
  const std::int64_t ns = stamped.time.time_since_epoch().count();
  const auto [p, q] = std::pair(stamped.pose.position, stamped.pose.rotation);
  WriteAsInC(out);
  if (ns < 0) out << '-';
  out << std::abs(ns) / 1'000'000'000 << '.' << std::setfill('0') << std::setw(9)
      << std::abs(ns) % 1'000'000'000 << std::fixed << std::setprecision(6) << ' ' << p.x() << ' '
      << p.y() << ' ' << p.z() << std::setprecision(9) << ' ' << q.x() << ' ' << q.y() << ' '
      << q.z() << ' ' << q.w() << '\n';
}

void WriteKittiLine(std::ostream& out, const Pose& pose) {
  Eigen::Matrix<double, 3, 4> m;
  m << pose.rotation.toRotationMatrix(), pose.position;
  WriteAsInC(out);
  out << std::scientific << std::setprecision(9);
  for (Eigen::Index row = 0; row < 3; ++row)
    for (Eigen::Index column = 0; column < 4; ++column)
      out << m(row, column) << (row == 2 && column == 3 ? '\n' : ' ');
}

std::optional<Pose> ParsePose(const std::string& text) {
  Row row;
  Pose pose;
  const bool good =
      ParseRow(text, &row) && row.count == kTumColumns - 1 && ToPose(row.values.data(), &pose);
  return good ? std::optional(pose) : std::nullopt;
}

std::optional<Twist> ParseTwist(const std::string& text) {
  Row row;
  Twist twist;
  if (!ParseRow(text, &row) || row.count != static_cast<std::size_t>(twist.size()))
    return std::nullopt;
  for (Eigen::Index i = 0; i < twist.size(); ++i)
    twist[i] = row.values[static_cast<std::size_t>(i)];
  const auto within = [&twist](Eigen::Index begin, double limit) {
    return (twist.segment<3>(begin).array().abs() <= limit).all();  // also false for NaN
  };
  const bool good = within(0, kMaxSpeedMps) && within(3, kMaxTurnRadPerS);
  return good ? std::optional(twist) : std::nullopt;
}

Trajectory ReadTrajectory(std::istream& in, Duration kitti_period, std::string* error) {
  Trajectory trajectory;
  std::string line;
  std::size_t columns = 0;
  const auto fail = [&](std::size_t number, const char* what) {
    *error = "line " + std::to_string(number) + ": " + what;
    return Trajectory{};
  };
  for (std::size_t number = 1; std::getline(in, line); ++number) {
    const bool cut = in.eof();
    const auto begin = line.find_first_not_of(" \t\r");
    if (begin == std::string::npos || line[begin] == '#') continue;
    Row row;
    StampedPose stamped;
    const bool numbers = ParseRow(line, &row);
    if (cut && (!numbers || (columns != 0 && row.count < columns))) break;
    if (!numbers) return fail(number, "not a list of numbers");
    if (row.count != kTumColumns && row.count != kKittiColumns)
      return fail(number, "a pose has 8 numbers (TUM) or 12 (KITTI)");
    if (columns != 0 && row.count != columns)
      return fail(number, "not as many numbers as in the lines before");
    columns = row.count;
    if (!ToPose(row, &stamped.pose)) return fail(number, "the rotation is not valid");
    stamped.time = Time{} + kitti_period * static_cast<std::int64_t>(trajectory.size());
    if (columns == kTumColumns && !ParseTime(line, &stamped.time))
      return fail(number, "the time is not a number of seconds");
    if (!trajectory.empty() && stamped.time < trajectory.back().time)
      return fail(number, "earlier than the line before");
    trajectory.push_back(stamped);
  }
  if (trajectory.empty()) *error = "it has no pose";
  return trajectory;
}

Pose InterpolateAt(const Trajectory& trajectory, Time t) {
  const auto after = std::lower_bound(trajectory.begin(), trajectory.end(), t,
                                      [](const StampedPose& p, Time at) { return p.time < at; });
  if (after == trajectory.end()) return trajectory.back().pose;
  if (after == trajectory.begin() || after->time == t) return after->pose;
  const StampedPose& a = *(after - 1);
  const double part = Seconds(t - a.time) / Seconds(after->time - a.time);
  return {a.pose.rotation.slerp(part, after->pose.rotation),
          a.pose.position + part * (after->pose.position - a.pose.position)};
}

}  // namespace lidar::odometry
