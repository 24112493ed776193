// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of lidarodometry: each property has an effect, each counter counts, and an element that was
// stopped behaves like a new one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <regex>
#include <set>

#include "ext/odometry/imu_input.h"
#include "tests/elements/odometry/corner_drive.h"
#include "tests/support/files.h"
#include "tests/support/own_properties.h"
#include "tests/support/run_trace.h"

namespace lidar::test {
namespace {

/// A lidarodometry with harnesses for its clouds, its poses and its map, and with a pad for the
/// samples of an IMU.
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

  void Begin() { trace_->Begin(kCornerCaps); }
  void Push(gst::BufferPtr buffer) { gst_pad_push(h_->srcpad, buffer.release()); }
  void Drive(unsigned from, unsigned to) {
    for (unsigned i = from; i < to; ++i) Push(ScanAt(CornerFrom(i), i * kCornerPeriod));
  }
  void BeginImu() { test::BeginImu(imu_.get()); }
  void SendStillness(GstClockTime from) { gst_pad_chain(imu_.get(), StillnessAt(from).release()); }
  void End() { gst_pad_push_event(h_->srcpad, gst_event_new_eos()); }
  void Stop() {
    trace_->Stop();
    trace_->Take();
  }
  void Flush() { trace_->Flush(); }
  /// Returns everything that the element output and posted, without the processor time of scans.
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

/// Reads the file and removes it. Returns an empty string if there is no file.
std::string TakeFile(const std::string& path) {
  const std::string text = test::ReadFile(path);
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
  ExpectEachPropertyIn(kOdometryEffects, "lidarodometry");
}

/// Leaves much state behind: lost scans, new maps, an incomplete scan, and unused samples of the
/// IMU. If the next run kept these samples, it would drop its own first samples.
void RunWithTroubles(OdometryRun* run) {
  run->BeginImu();
  for (unsigned i = 0; i < 9; ++i) {
    run->SendStillness(i * kCornerPeriod);
    run->Drive(i, i + 1);
  }
  for (unsigned i = 9; i < 22; ++i) run->Push(ScanAt(FarWall(), i * kCornerPeriod));
  run->Drive(90, 92);
  run->Push(ScanAt(gst::BufferPtr(gst_buffer_new_memdup("cut", 3)), 92 * kCornerPeriod));
  run->Push(ScanAt(FarWall(), 92 * kCornerPeriod));
  run->SendStillness(5 * kCornerPeriod);
  run->Push(SliceOf(ScanAt(CornerFrom(93), 93 * kCornerPeriod), {7, 0, 2, 0}));
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
    // The trajectory has one line per scan.
    lines.push_back(TakeFile(kRunTrajectory));
    EXPECT_EQ(std::count(lines.back().begin(), lines.back().end(), '\n'), ends ? 26 : 25);
    if (first.empty()) first = lines;
    if (ends) {
      EXPECT_EQ(lines, first);
      EXPECT_TRUE(HasLine(lines,
                          "scans=(guint64)26, scans-lost=(guint64)10, scans-degenerate=(guint64)0, "
                          "scans-with-imu=(guint64)3, maps=(guint64)5, loops=(guint64)0, "
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
  flushed.Push(SliceOf(ScanAt(FarWall(), 3 * kCornerPeriod), {7, 0, 2, 0}));
  flushed.Flush();
  for (OdometryRun* run : {&plain, &flushed}) {
    run->Take();
    run->Drive(3, 6);
  }
  EXPECT_EQ(flushed.Take(), plain.Take());
}

}  // namespace
}  // namespace lidar::test
