// SPDX-License-Identifier: LGPL-2.1-or-later
// lidarodometry: each property has an effect, each count counts, and an element that was stopped
// behaves as a new one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>

#include "ext/odometry/imu_input.h"
#include "gst/common/imu_caps.h"
#include "src/base/byte_writer.h"
#include "src/cdr/motion_samples.h"
#include "tests/support/own_properties.h"
#include "tests/support/run_trace.h"

namespace lidar::test {
namespace {

constexpr const char* kRunCaps =
    "application/x-pointcloud2,width=0,height=1,point-step=16,"
    "fields=(string)\"x:F32:0,y:F32:4,z:F32:8,t:F32:12\",framerate=10/1";
constexpr GstClockTime kPeriod = 100 * GST_MSECOND;

/// A corner of three walls, from 2 to 19 m away, seen by a sensor that moves along x at 10 m/s and
/// samples a wall after the other.
gst::BufferPtr CornerFrom(double metres) {
  std::vector<std::uint8_t> bytes;
  ByteWriter w(&bytes);
  for (unsigned wall = 0; wall < 3; ++wall)
    for (int a = -10; a < 10; ++a)
      for (int b = -10; b < 10; ++b) {
        const double t = 0.1 * (20 * (a + 10) + b + 10 + 400.0 * wall) / 1200;
        const double u = a * 0.7;
        const double v = b * 0.7;
        const double here = metres + 10 * t;
        const std::array<double, 3> p = wall == 0   ? std::array{u - here, v, -2.0}
                                        : wall == 1 ? std::array{u - here, 10.0, v}
                                                    : std::array{12 - here, u, v};
        for (const double value : {p[0], p[1], p[2], t}) w.LeF32(static_cast<float>(value));
      }
  return gst::BufferPtr(gst_buffer_new_memdup(bytes.data(), bytes.size()));
}

gst::BufferPtr ScanAt(gst::BufferPtr buffer, GstClockTime time) {
  GST_BUFFER_PTS(buffer.get()) = time;
  GST_BUFFER_DURATION(buffer.get()) = kPeriod;
  gst_lidar_buffer_set_capture_time(buffer.get(), GST_SECOND + time);
  return buffer;
}

gst::BufferPtr SliceOf(gst::BufferPtr buffer, const GstLidarSlice& slice) {
  gst_lidar_buffer_set_slice(buffer.get(), &slice);
  return buffer;
}

/// lidarodometry with sinks for its clouds, its poses and its map, and a source of samples.
class OdometryRun {
 public:
  explicit OdometryRun(const std::string& properties) {
    const gst::ElementPtr element(
        gst_parse_launch(("lidarodometry " + properties).c_str(), nullptr));
    h_.reset(gst_harness_new_with_element(element.get(), "sink", "src"));
    poses_.reset(gst_harness_new_with_element(element.get(), nullptr, "odometry"));
    map_.reset(gst_harness_new_with_element(element.get(), nullptr, "map"));
    imu_.reset(gst_element_request_pad_simple(element.get(), "imu"));
    trace_.emplace(h_.get());
    trace_->Watch(poses_->sinkpad);
    trace_->Watch(map_->sinkpad);
  }
  ~OdometryRun() {
    trace_->Stop();
    gst_element_release_request_pad(h_->element, imu_.get());
    trace_.reset();
  }
  OdometryRun(const OdometryRun&) = delete;
  OdometryRun& operator=(const OdometryRun&) = delete;

  void Begin() { trace_->Begin(kRunCaps); }
  void Push(gst::BufferPtr buffer) { gst_pad_push(h_->srcpad, buffer.release()); }
  void Drive(unsigned from, unsigned to) {
    for (unsigned i = from; i < to; ++i) Push(ScanAt(CornerFrom(i), i * kPeriod));
  }
  void BeginImu() {
    gst_pad_send_event(imu_.get(), gst_event_new_stream_start("imu"));
    gst_pad_send_event(
        imu_.get(),
        gst_event_new_caps(gst::ImuCaps({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}).get()));
    GstSegment segment;
    gst_segment_init(&segment, GST_FORMAT_TIME);
    gst_pad_send_event(imu_.get(), gst_event_new_segment(&segment));
  }
  void SendStillness(GstClockTime from) {
    std::vector<std::uint8_t> bytes;
    for (unsigned i = 0; i < 10; ++i) {
      cdr::Imu imu;
      imu.header.stamp =
          Time{} + Duration{static_cast<std::int64_t>(GST_SECOND + from + i * 10 * GST_MSECOND)};
      const auto sample = cdr::WriteImuSample(imu);
      bytes.insert(bytes.end(), sample.begin(), sample.end());
    }
    gst_pad_chain(imu_.get(), gst_buffer_new_memdup(bytes.data(), bytes.size()));
  }
  void End() { gst_pad_push_event(h_->srcpad, gst_event_new_eos()); }
  void Stop() {
    trace_->Stop();
    trace_->Take();
  }
  void Flush() { trace_->Flush(); }
  /// Returns what happened, without the time that scans take.
  Lines Take() {
    Lines lines = trace_->Take();
    static const std::regex times("(scan-time=\\(guint64\\))[0-9]+");
    for (std::string& line : lines) line = std::regex_replace(line, times, "$1T");
    return lines;
  }

 private:
  Harness h_, poses_, map_;
  gst::PadPtr imu_;
  std::optional<RunTrace> trace_;
};

/// Reads and removes a file. Returns nothing if there is none.
std::string TakeFile(const std::string& path) {
  std::ifstream file(path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::remove(path.c_str());
  return text;
}

const std::string kRunTrajectory =
    ::testing::TempDir() + "odometry_run_" + std::to_string(g_random_int()) + ".tum";

struct OdometryEffect {
  const char* property;
  std::string value;
};

const OdometryEffect kOdometryEffects[] = {
    {"max-range", "12"},
    {"min-range", "9"},
    {"voxel-size", "0.5"},
    {"deskew", "false"},
    {"initial-pose", "\"1 2 3 0 0 0 1\""},
    {"initial-velocity", "\"10 0 0 0 0 0\""},
    {"trajectory", kRunTrajectory},
    {"local-maps", "4"},
    {"post-messages", "false"},
};

Lines LinesOf(const std::string& properties) {
  OdometryRun run(properties);
  run.Begin();
  run.Drive(0, 4);
  run.End();
  Lines lines = run.Take();
  lines.push_back(TakeFile(kRunTrajectory));
  return lines;
}

class OdometryEachProperty : public ::testing::TestWithParam<OdometryEffect> {};
TEST_P(OdometryEachProperty, ChangesWhatComesOutOrIsSaid) {
  static const Lines plain = LinesOf("");
  EXPECT_NE(LinesOf(GetParam().property + ("=" + GetParam().value)), plain) << GetParam().property;
}
INSTANTIATE_TEST_SUITE_P(Of, OdometryEachProperty, ::testing::ValuesIn(kOdometryEffects));

TEST(OdometryProperties, AreAllInTheTable) {
  std::set<std::string> tried;
  for (const OdometryEffect& effect : kOdometryEffects) tried.insert(effect.property);
  for (const std::string& name : OwnWritableProperties("lidarodometry"))
    EXPECT_EQ(tried.count(name), 1U) << name;
}

/// A wall 80 m ahead, which shows no motion to the side.
gst::BufferPtr FarWall() {
  std::vector<std::uint8_t> bytes;
  ByteWriter w(&bytes);
  for (int a = -10; a < 10; ++a)
    for (int b = -10; b < 10; ++b)
      for (const int value : {80, a, b, 0}) w.LeF32(static_cast<float>(value));
  return gst::BufferPtr(gst_buffer_new_memdup(bytes.data(), bytes.size()));
}

/// Leaves much behind: lost scans, new maps, a scan under way, and samples that no scan has taken.
void RunWithTroubles(OdometryRun* run) {
  run->BeginImu();
  for (unsigned i = 0; i < 9; ++i) {
    run->SendStillness(i * kPeriod);
    run->Drive(i, i + 1);
  }
  for (unsigned i = 9; i < 22; ++i) run->Push(ScanAt(FarWall(), i * kPeriod));
  run->Drive(90, 92);
  run->Push(ScanAt(gst::BufferPtr(gst_buffer_new_memdup("cut", 3)), 92 * kPeriod));
  run->Push(ScanAt(FarWall(), 92 * kPeriod));
  run->SendStillness(93 * kPeriod);
  run->Push(SliceOf(ScanAt(CornerFrom(93), 93 * kPeriod), {7, 0, 2, 0}));
}

bool HasLine(const Lines& lines, const std::string& part) {
  return std::any_of(lines.begin(), lines.end(),
                     [&](const auto& line) { return line.find(part) != std::string::npos; });
}

TEST(OdometrySecondRun, IsAsTheFirst) {
  OdometryRun run("local-maps=2 trajectory=" + kRunTrajectory);
  Lines first;
  for (const bool ends : {true, false, true}) {
    run.Begin();
    RunWithTroubles(&run);
    if (ends) run.End();
    Lines lines = run.Take();
    EXPECT_TRUE(HasLine(lines, "message warning The position was lost"));
    // A line of the trajectory for each scan.
    lines.push_back(TakeFile(kRunTrajectory));
    EXPECT_EQ(std::count(lines.back().begin(), lines.back().end(), '\n'), ends ? 26 : 25);
    if (first.empty()) first = lines;
    if (ends) {
      EXPECT_EQ(lines, first);
      EXPECT_TRUE(HasLine(lines,
                          "scans=(guint64)26, scans-lost=(guint64)10, scans-degenerate=(guint64)0, "
                          "scans-with-imu=(guint64)4, maps=(guint64)5, loops=(guint64)0, "
                          "local-maps=(guint64)1, scans-not-in-local-maps=(guint64)0"))
          << lines[lines.size() - 2];
    }
    run.Stop();
  }
}

TEST(OdometryFlush, LeavesNothingOfTheScanUnderWayAndKeepsThePlace) {
  OdometryRun plain("");
  OdometryRun flushed("");
  for (OdometryRun* run : {&plain, &flushed}) {
    run->Begin();
    run->Drive(0, 3);
  }
  flushed.Push(SliceOf(ScanAt(FarWall(), 3 * kPeriod), {7, 0, 2, 0}));
  flushed.Flush();
  for (OdometryRun* run : {&plain, &flushed}) {
    run->Take();
    run->Drive(3, 6);
  }
  EXPECT_EQ(flushed.Take(), plain.Take());
}

}  // namespace
}  // namespace lidar::test
