// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests the parts of lidar-train and lidar-eval: sources, targets, measurements.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <utility>

#include "src/tools/lab/codec_lab/cloud_file.h"
#include "src/tools/lab/codec_lab/kitti_sequence.h"
#include "src/tools/lab/codec_lab/measure.h"
#include "src/tools/lab/codec_lab/model_option.h"
#include "src/tools/lab/codec_lab/scan_faults.h"
#include "src/tools/lab/codec_lab/scan_source.h"
#include "src/tools/lab/codec_lab/tracking.h"
#include "tests/support/files.h"

namespace lidar::tools {
namespace {

class Files : public test::FolderTest {
 protected:
  std::string Write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ + "/" + name, std::ios::binary) << content;
    return folder_ + "/" + name;
  }
  template <class T>
  static std::string Bytes(const std::vector<T>& values) {
    std::string bytes(values.size() * sizeof(T), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
  }
};

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

TEST_F(Files, KittiCloudsLoseTheirMissingPoints) {
  const auto path = Write(
      "a.bin", Bytes<float>({1, 2, 3, 0.5F, 0, 0, 0, 0.1F, kNan, 1, 1, 0.2F, -4, 5, -6, 0.7F}));
  const Scan scan = ReadCloud(path);
  EXPECT_EQ(scan.xyz, (std::vector<float>{1, 2, 3, -4, 5, -6}));
  EXPECT_EQ(scan.intensity, (std::vector<float>{0.5F, 0.7F}));
  EXPECT_FALSE(scan.organised());
}

TEST_F(Files, KittiCloudsOfOddLengthAreRefused) {
  EXPECT_THROW(ReadCloud(Write("a.bin", "123")), std::runtime_error);
  EXPECT_THROW(ReadCloud(Write("b.bin", "")), std::runtime_error);
  EXPECT_THROW(ReadCloud(folder_ + "/none.bin"), std::runtime_error);
}

TEST_F(Files, KittiSequencesHaveABeamForEachRiseOfPhasesAndTheMedianPeriod) {
  KittiScan scan;
  scan.phases = {0.1F, 0.1F, 0.5F, 0.1F, 0.2F, 0.2F};  // equal neighbours mark a second return
  for (std::size_t i = 0; i < scan.phases.size(); ++i)
    scan.points.insert(scan.points.end(), {static_cast<float>(i) + 1, 2, 3, 0.5F});
  for (std::size_t number = 0; number < 4; ++number) WriteKittiScan(folder_, number, scan);
  Write("times.txt", "0\n0.5\n0.6\n0.7\n");
  const auto timed = OpenKittiSequence(folder_)->Next();
  ASSERT_TRUE(timed);
  EXPECT_EQ(timed->scan.rings, (std::vector<std::uint16_t>{0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(timed->scan.phases, scan.phases);
  EXPECT_EQ(timed->scan.intensity, std::vector<float>(6, 0.5F));
  EXPECT_NEAR(Seconds(timed->duration), 0.1, 1e-6);
  EXPECT_NEAR(Seconds(timed->start - Time{}), -0.05, 1e-6) << "times are those of the middle";
}

const char* const kPcdHeader =
    "# .PCD v0.7\nVERSION 0.7\nFIELDS ring x y z intensity\nSIZE 2 4 4 4 4\nTYPE U F F F F\n"
    "COUNT 1 1 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\n";

TEST_F(Files, PcdInAsciiAndBinaryGivesTheSameCloud) {
  const auto ascii = ReadCloud(
      Write("a.pcd", std::string(kPcdHeader) + "DATA ascii\n7 1 2 3 0.5\n9 4 5 6 0.25\n"));
  const auto point = [](std::uint16_t ring, const std::vector<float>& rest) {
    return Bytes<std::uint16_t>({ring}) + Bytes(rest);
  };
  const auto binary =
      ReadCloud(Write("b.pcd", std::string(kPcdHeader) + "DATA binary\n" +
                                   point(7, {1, 2, 3, 0.5F}) + point(9, {4, 5, 6, 0.25F})));
  EXPECT_EQ(ascii.xyz, (std::vector<float>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(ascii.intensity, (std::vector<float>{0.5F, 0.25F}));
  EXPECT_EQ(binary.xyz, ascii.xyz);
  EXPECT_EQ(binary.intensity, ascii.intensity);
}

TEST_F(Files, PlyGivesItsPoints) {
  const auto path =
      Write("a.ply",
            "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
            "property float z\nproperty uchar intensity\nend_header\n1 2 3 7\n4 5 6 9\n");
  const Scan scan = ReadCloud(path);
  EXPECT_EQ(scan.xyz, (std::vector<float>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(scan.intensity, (std::vector<float>{7, 9}));
  EXPECT_THROW(ReadCloud(Write("b.ply", "ply\nformat ascii 1.0\nelement vertex 2\n")),
               std::runtime_error);
}

TEST_F(Files, PcdThatIsCutOffOrOfAnotherKindIsRefused) {
  const std::string header = kPcdHeader;
  for (const std::string& bad :
       {header + "DATA binary\n123", header + "DATA ascii\n7 1 2\n",
        header + "DATA binary_compressed\n", std::string("FIELDS x y\nDATA ascii\n"),
        std::string("FIELDS x y z\nSIZE 8 8 8\nPOINTS 1\nDATA ascii\n1 2 3\n"),
        std::string("FIELDS x y z\nPOINTS 99999999999\nDATA ascii\n"), std::string()}) {
    EXPECT_THROW(ReadCloud(Write("bad.pcd", bad)), std::runtime_error) << bad;
  }
}

TEST_F(Files, AFolderIsReadInTheOrderOfItsNames) {
  Write("2.bin", Bytes<float>({2, 0, 0, 0}));
  // The files are not written in the order of their names.
  Write("3.bin", Bytes<float>({3, 0, 0, 0}));
  Write("1.bin", Bytes<float>({1, 0, 0, 0}));
  Write("notes.txt", "not a cloud");
  const ScanSet set = LoadScans(folder_, {});
  ASSERT_EQ(set.scans.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(set.scans[i].xyz[0], static_cast<float>(i + 1));
}

TEST_F(Files, RecordedTargetsHoldUntilTheNextLine) {
  const auto path = Write("t.txt", "# time rate\n0 4\n0.25 2\n\n0.5 8 # more\n");
  EXPECT_EQ(ReadTargets(path, 10), (std::vector<double>{4e6, 4e6, 4e6, 2e6, 2e6, 8e6}));
}

TEST_F(Files, TargetsThatAreNoneAreRefusedWithTheirLine) {
  for (const auto& [text, why] :
       {std::pair{"0 4\n1 x\n", "line 2 is not 'time_s rate_mbps'"},
        std::pair{"# a\n0 4\n1\n", "line 3 is not 'time_s rate_mbps'"},
        std::pair{"0 0\n", "line 1 is not 'time_s rate_mbps'"},
        std::pair{"0 4\n1 0 # silent\n", "line 2 is not 'time_s rate_mbps'"},
        std::pair{"0 -4\n", "line 1 is not 'time_s rate_mbps'"},
        std::pair{"# nothing\n", "has no target"}, std::pair{"", "has no target"}}) {
    const std::string path = Write("bad.txt", text);
    try {
      ReadTargets(path, 10);
      ADD_FAILURE() << text;
    } catch (const std::runtime_error& e) {
      EXPECT_EQ(e.what(), path + ": " + why) << text;
    }
  }
  EXPECT_THROW(ReadTargets(folder_ + "/none.txt", 10), std::runtime_error);
}

TEST_F(Files, AModelFileThatIsNoneIsRefusedByName) {
  const auto path = Write("model.json", "{\"format\":");
  try {
    LoadModelFile(path);
    FAIL() << "was read";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find(path), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("cut off"), std::string::npos) << e.what();
  }
}

class BadSource : public ::testing::TestWithParam<const char*> {};
TEST_P(BadSource, IsRefused) { EXPECT_THROW(LoadScans(GetParam(), {}), std::runtime_error); }
INSTANTIATE_TEST_SUITE_P(All, BadSource,
                         ::testing::Values("", "cloud.las", "none.pcap",
                                           "synth:", "synth:os9-64:street", "synth:os1-64:moon",
                                           "synth:os1-64:street:7", "synth:os1-64:street:x",
                                           "synth:os1-64:street:512:1"));

TEST(MakeTargets, StaysInItsRangeAndMovesAsItsNameSays) {
  ProfileOptions options;
  options.steady_bps = 5;
  options.min_bps = 1e6;
  options.max_bps = 8e6;
  for (const double t : MakeTargets(TargetProfile::kSteady, 50, options)) EXPECT_EQ(t, 5);
  const auto walk = MakeTargets(TargetProfile::kWalk, 2000, options);
  double square = 0;
  for (std::size_t i = 0; i < walk.size(); ++i) {
    EXPECT_GE(walk[i], 1e6);
    EXPECT_LE(walk[i], 8e6);
    if (i > 0) square += std::pow(std::log(walk[i] / walk[i - 1]), 2) / 2000;
  }
  EXPECT_NEAR(std::sqrt(square), 0.08, 0.01);
  const auto jump = MakeTargets(TargetProfile::kJump, 100, options);
  for (std::size_t i = 1; i < jump.size(); ++i) EXPECT_EQ(jump[i] == jump[i - 1], i % 10 != 0) << i;
}

/// A stream of copies of a scan, ten per second. The intensity of the first point is the index of
/// the copy.
class Copies final : public ScanStream {
 public:
  explicit Copies(Scan scan, int count = 400)
      : ScanStream(10), scan_(std::move(scan)), count_(count) {}
  std::optional<TimedScan> Next() override {
    if (next_ == count_) return std::nullopt;
    scan_.intensity[0] = static_cast<float>(next_);
    return TimedScan{scan_, Time{} + next_++ * period(), period(), {}};
  }

 private:
  Scan scan_;
  int count_;
  int next_ = 0;
};

Scan CloudOfFiveBeams() {
  Scan cloud;
  cloud.rings = {4, 3, 2, 1, 0};
  cloud.phases = {0, 0.2F, 0.4F, 0.6F, 0.8F};
  cloud.intensity = {0, 1, 2, 3, 4};
  for (int i = 0; i < 15; ++i) cloud.xyz.push_back(static_cast<float>(i));
  return cloud;
}

std::vector<int> NumbersOf(ScanStream* scans) {
  std::vector<int> numbers;
  while (const auto timed = scans->Next())
    numbers.push_back(static_cast<int>(timed->scan.intensity[0]));
  return numbers;
}

std::unique_ptr<ScanStream> FaultyCopies(const ScanFaults& faults) {
  return WithFaults(std::make_unique<Copies>(CloudOfFiveBeams()), faults);
}

TEST(ScanFaults, KeepOfACloudAllThatItsOtherBeamsHave) {
  ScanFaults faults;
  faults.every_beam = 2;
  const auto kept = FaultyCopies(faults)->Next();
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->scan.rings, (std::vector<std::uint16_t>{4, 2, 0}));
  EXPECT_EQ(kept->scan.phases, (std::vector<float>{0, 0.4F, 0.8F}));
  EXPECT_EQ(kept->scan.intensity, (std::vector<float>{0, 2, 4}));
  EXPECT_EQ(kept->scan.xyz, (std::vector<float>{0, 1, 2, 6, 7, 8, 12, 13, 14}));
}

TEST(ScanFaults, SilenceWholeBeamsOfAnOrganisedScan) {
  SensorModel model;
  model.columns_per_scan = 4;
  model.beams.resize(3);
  Scan scan;
  scan.geometry = std::make_shared<const ScanGeometry>(model);
  scan.ranges.assign(12, 7);
  scan.intensity.assign(12, 1);
  ScanFaults faults;
  faults.every_beam = 2;
  const auto kept = WithFaults(std::make_unique<Copies>(scan), faults)->Next();
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->scan.ranges, (std::vector<std::uint32_t>{7, 7, 7, 7, 0, 0, 0, 0, 7, 7, 7, 7}));
}

TEST(ScanFaults, LeaveOutScansAndAGapTenSecondsAfterTheFirst) {
  ScanFaults faults;
  faults.every_scan = 4;
  faults.gap_s = 2;
  const auto numbers = NumbersOf(FaultyCopies(faults).get());
  std::vector<int> left;
  for (int i = 0; i < 400; i += 4)
    if (i < 100 || i >= 120) left.push_back(i);
  EXPECT_EQ(numbers, left);
}

TEST(ScanFaults, LoseTheirShareThreeAtATimeButNeverTheFirst) {
  ScanFaults faults;
  faults.lost_share = 0.2;
  const auto scans = WithFaults(std::make_unique<Copies>(CloudOfFiveBeams(), 30'000), faults);
  const auto numbers = NumbersOf(scans.get());
  EXPECT_EQ(numbers.front(), 0);
  EXPECT_NEAR(static_cast<double>(numbers.size()) / 30'000, 0.8, 0.01);
  for (std::size_t i = 1; i < numbers.size(); ++i)
    EXPECT_EQ((numbers[i] - numbers[i - 1] - 1) % 3, 0) << numbers[i];
}

TEST(Slices, HoldEachReturnOfTheirScanOnce) {
  SourceOptions options;
  options.max_scans = 1;
  const ScanSet set = LoadScans("synth:os0-32:street", options);
  const Scan& scan = set.scans.front();
  const auto returns = scan.ranges.size() - static_cast<std::size_t>(std::count(
                                                scan.ranges.begin(), scan.ranges.end(), 0U));
  for (const std::uint32_t count : {1U, 3U, 8U, 60U}) {
    SliceCodec codec;
    std::size_t sum = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      codec.Load(scan, {i, count});
      sum += codec.returns();
    }
    EXPECT_EQ(sum, returns) << count;
  }
}

TEST(Measure, FindsErrorsBelowTheBoundAndCloseToIt) {
  SourceOptions one;
  one.max_scans = 1;
  const ScanSet set = LoadScans("synth:os0-32:street:512", one);
  SliceCodec codec;
  codec.Load(set.scans.front(), {});
  for (const char* name : {"range-adaptive", "range-draco", "xyz-kd6", "xyz-sequential"}) {
    const CodingMode mode = ModeNamed(name);
    const double step = codec.Bound(mode).CoarsestStep(0.02);
    const auto m = Measure(set, mode, {step, 0, 0, 4});
    ASSERT_TRUE(m) << name;
    // Positions are floats. At 100 m, neighbouring floats are about 0.01 mm apart.
    EXPECT_LE(m->errors.max_m, 0.02 + 2e-5) << name;
    EXPECT_GT(m->errors.max_m, 0.018) << name;
    EXPECT_NEAR(m->errors.mean_m, codec.Bound(mode).MeanError(step), 0.0005) << name;
    EXPECT_NEAR(m->step_m, step, 1e-9) << name;
  }
}

TEST(MeasureBounds, GrowsFromTheBoundToTheSensorsResolution) {
  SourceOptions one;
  one.max_scans = 1;
  const ScanSet set = LoadScans("synth:os0-32:street:512", one);
  TrackOptions options;
  options.mode = &DefaultMode(set);
  options.intensity_bits = 8;
  const rate::RateBounds bounds = MeasureBounds(set, options);
  EXPECT_GT(bounds.min.bits_per_second(), 1e4);
  EXPECT_LT(bounds.min, bounds.nominal);
  EXPECT_LT(bounds.nominal, bounds.max);
}

}  // namespace
}  // namespace lidar::tools
