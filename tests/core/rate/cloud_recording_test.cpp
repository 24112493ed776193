// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests MCAP recordings as input of lidar-eval.
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "src/cdr/coded_slice.h"
#include "src/cdr/point_cloud2.h"
#include "src/mcap/writer.h"
#include "src/tools/lab/codec_lab/scan_source.h"
#include "tests/core/rate/test_clouds.h"
#include "tests/support/files.h"

namespace lidar::tools {
namespace {

using std::chrono::milliseconds;

constexpr const char* kClouds = "sensor_msgs/msg/PointCloud2";
constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();

class CloudRecording : public test::FolderTest {
 protected:
  std::uint16_t AddTopic(const std::string& topic, const std::string& schema = kClouds) {
    const std::uint16_t id = catalogue_.AddSchema({0, schema, "ros2msg", "of no use here"});
    return catalogue_.AddChannel({0, id, topic, "cdr", {}});
  }
  void AddMessage(std::uint16_t topic, milliseconds log_time,
                  const std::vector<std::uint8_t>& message) {
    const auto ns = static_cast<std::uint64_t>(Duration(log_time).count());
    ASSERT_TRUE(writer_.Add({topic, 0, ns, ns}, {message.data(), message.size()}));
  }
  void AddCloud(std::uint16_t topic, milliseconds stamp,
                const std::vector<TestPoint>& points = {{1, 2, 3, 4}}, std::uint32_t width = 1) {
    cdr::PointCloud2 cloud = CloudOf(points, width);
    cloud.header.stamp = Time{} + stamp;
    AddMessage(topic, stamp + milliseconds(7), WritePointCloud2(cloud));
  }
  std::string Write(std::size_t bytes = SIZE_MAX) {
    EXPECT_TRUE(writer_.Finish());
    std::ofstream(path_, std::ios::binary) << file_.substr(0, bytes);
    return path_;
  }
  /// Opens `source`, and returns the text of the error that this throws, or "".
  static std::string RefusalOf(const std::string& source) {
    try {
      OpenScans(source, {});
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return "";
  }

  const std::string path_ = folder_ + "/drive.mcap";
  std::string file_;
  mcap::Catalogue catalogue_;
  mcap::Writer writer_{{}, &catalogue_, [this](ByteView bytes) {
                         file_.append(bytes.begin(), bytes.end());
                         return true;
                       }};
};

TEST_F(CloudRecording, CloudsComeWithTheTimesOfTheirStamps) {
  const std::uint16_t imu = AddTopic("/imu", "sensor_msgs/msg/Imu");
  const std::uint16_t points = AddTopic("/points");
  for (const int ms : {5000, 5050, 5100, 5300}) {
    AddMessage(imu, milliseconds(ms), {0, 1, 0, 0, 1, 2, 3, 4});
    AddCloud(points, milliseconds(ms));
  }
  const auto scans = OpenScans(Write(), {});
  EXPECT_DOUBLE_EQ(scans->scans_per_second(), 20);
  for (const int ms : {5000, 5050, 5100, 5300}) {
    const auto scan = scans->Next();
    ASSERT_TRUE(scan) << ms;
    EXPECT_EQ(scan->start, Time{} + milliseconds(ms));
    EXPECT_EQ(scan->duration, milliseconds(50)) << "a gap makes no scan longer";
    EXPECT_EQ(scan->scan.xyz, (std::vector<float>{1, 2, 3}));
    EXPECT_EQ(scan->scan.intensity, std::vector<float>{4});
  }
  EXPECT_FALSE(scans->Next());
}

TEST_F(CloudRecording, RowsOfAnOrganisedCloudAreBeamsAndItsColumnsFollowEachOther) {
  AddCloud(AddTopic("/points"), milliseconds(1000),
           {{1, 0, 0, 0}, {kNoNumber, 0, 0, 0}, {0, 0, 0, 0}, {2, 0, 0, 0}}, 2);
  const auto scan = OpenScans(Write(), {})->Next();
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->scan.xyz, (std::vector<float>{1, 0, 0, 2, 0, 0}));
  EXPECT_EQ(scan->scan.rings, (std::vector<std::uint16_t>{0, 1}));
  EXPECT_EQ(scan->scan.phases, (std::vector<float>{0, 0.5F}));
}

TEST_F(CloudRecording, LogTimesCountWhereThereAreNoStamps) {
  const std::uint16_t points = AddTopic("/points");
  const std::vector<TestPoint> one = {{1, 2, 3, 4}};
  AddMessage(points, milliseconds(700), WritePointCloud2(CloudOf(one, 1)));
  EXPECT_EQ(OpenScans(Write(), {})->Next()->start, Time{} + milliseconds(700));
}

TEST_F(CloudRecording, StampsBefore1970AreLeftOut) {
  const std::uint16_t points = AddTopic("/points");
  const std::vector<TestPoint> one = {{1, 2, 3, 4}};
  auto message = WritePointCloud2(CloudOf(one, 1));
  std::memset(&message[4], 0xFF, 4);  // the seconds of the time stamp
  AddMessage(points, milliseconds(1), message);
  AddCloud(points, milliseconds(2000));
  EXPECT_EQ(OpenScans(Write(), {})->Next()->start, Time{} + milliseconds(2000));
}

TEST_F(CloudRecording, LogTimesThatAreNoTimesAreLeftOut) {
  const std::uint16_t points = AddTopic("/points");
  const std::vector<TestPoint> one = {{1, 2, 3, 4}};
  const auto message = WritePointCloud2(CloudOf(one, 1));
  const std::uint64_t latest = INT64_MAX;
  for (const std::uint64_t ns : {latest - 1, latest, latest + 1, latest + 2})
    ASSERT_TRUE(writer_.Add({points, 0, ns, ns}, {message.data(), message.size()}));
  EXPECT_EQ(LoadScans(Write(), {}).scans.size(), 2U);
}

TEST_F(CloudRecording, CoordinatesMayBeOfAnyTypeAndInAnyOrder) {
  const double zyx[3] = {3, 2, 1};
  cdr::PointCloud2 cloud;
  cloud.layout.width = cloud.layout.height = 1;
  cloud.layout.fields = {{"z", 0, 8, 1}, {"y", 8, 8, 1}, {"x", 16, 8, 1}};
  cloud.layout.point_step = cloud.layout.row_step = sizeof zyx;
  cloud.data = {reinterpret_cast<const std::uint8_t*>(zyx), sizeof zyx};
  AddMessage(AddTopic("/points"), milliseconds(700), WritePointCloud2(cloud));
  EXPECT_EQ(OpenScans(Write(), {})->Next()->scan.xyz, (std::vector<float>{1, 2, 3}));
}

TEST_F(CloudRecording, OneOfSeveralTopicsHasToBeNamed) {
  AddCloud(AddTopic("/front"), milliseconds(1000));
  AddCloud(AddTopic("/rear"), milliseconds(1050), {{9, 9, 9, 9}});
  const std::string path = Write();
  EXPECT_NE(RefusalOf(path).find("/front, /rear"), std::string::npos) << RefusalOf(path);
  EXPECT_NE(RefusalOf(path + ",/left").find("/left"), std::string::npos);
  EXPECT_EQ(OpenScans(path + ",/rear", {})->Next()->scan.xyz[0], 9);
}

TEST_F(CloudRecording, DamagedCloudsAreLeftOut) {
  const std::uint16_t points = AddTopic("/points");
  AddMessage(points, milliseconds(900), {0, 1, 0, 0, 1});
  const std::vector<TestPoint> one = {{1, 2, 3, 4}};
  cdr::PointCloud2 huge = CloudOf(one, 1);
  huge.layout.width = 1U << 30;
  AddMessage(points, milliseconds(950), WritePointCloud2(huge));
  AddCloud(points, milliseconds(1000));
  EXPECT_EQ(LoadScans(Write(), {}).scans.size(), 1U);
}

TEST_F(CloudRecording, ARecordingThatBrokeOffGivesWhatItHas) {
  const std::uint16_t points = AddTopic("/points");
  for (int s = 0; s < 5; ++s) AddCloud(points, milliseconds(1000 * s + 1000));
  ASSERT_TRUE(writer_.Flush());
  EXPECT_EQ(LoadScans(Write(file_.size()), {}).scans.size(), 5U);
}

TEST_F(CloudRecording, AFolderIsReadPartByPart) {
  AddCloud(AddTopic("/points"), milliseconds(1000));
  std::filesystem::copy_file(Write(), folder_ + "/drive_10.mcap");
  std::filesystem::rename(path_, folder_ + "/drive_9.mcap");
  std::ofstream(folder_ + "/metadata.yaml") << "rosbag2_bagfile_information:";
  EXPECT_EQ(LoadScans(folder_, {}).scans.size(), 2U);
  EXPECT_EQ(LoadScans(folder_ + ",/points", {}).scans.size(), 2U);
}

TEST_F(CloudRecording, CodedSlicesAreRefusedWithTheWayToClouds) {
  AddMessage(AddTopic("/slices", std::string(cdr::CodedSlice::kName)), milliseconds(1),
             cdr::WriteCodedSlice({}));
  EXPECT_NE(RefusalOf(Write()).find("mcapsrc"), std::string::npos);
}

TEST_F(CloudRecording, FilesWithoutCloudsAreRefusedByName) {
  const auto is_named = [this] {
    EXPECT_NE(RefusalOf(path_).find(path_), std::string::npos) << RefusalOf(path_);
  };
  is_named();  // The file does not exist.
  std::ofstream(path_) << "no MCAP at all";
  is_named();
  std::ofstream(path_, std::ios::trunc) << "";
  is_named();
  AddMessage(AddTopic("/points"), milliseconds(1), {0, 1, 0, 0, 1});
  Write();
  is_named();
}

}  // namespace
}  // namespace lidar::tools
