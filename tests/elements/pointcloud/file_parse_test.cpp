// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of pointcloudparse with files of pcdenc, plyenc and other programs.
#include <gtest/gtest.h>

#include <gst/base/gsttypefindhelper.h>

#include <fstream>

#include "tests/elements/mcap/recording.h"

namespace lidar::test {
namespace {

class FileParse : public Recording {
 protected:
  Outcome Write(const std::string& encoder, const std::string& name) const {
    return Play(kSensor + " num-buffers=3 slices-per-scan=1 ! identity name=see ! " + encoder +
                " ! multifilesink" + At(name));
  }
};

TEST_F(FileParse, PcdComesBackAsItWas) {
  for (const char* encoder : {"pcdenc", "pcdenc binary=false"}) {
    const auto written = Write(encoder, "scan%d.pcd");
    const auto read =
        Play("multifilesrc" + At("scan%d.pcd") + " ! pointcloudparse ! fakesink name=see");
    EXPECT_EQ(read.error, "");
    const auto& in = written.buffers.at("see");
    const auto& out = read.buffers.at("see");
    ASSERT_EQ(out.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_EQ(out[i].bytes.size(), in[i].bytes.size());
      EXPECT_EQ(out[i].capture_time, in[i].capture_time);
      EXPECT_EQ(out[i].pts, i * 100 * GST_MSECOND);
      for (std::size_t at = 0; at < in[i].bytes.size(); at += 20) {
        // A point without a return has NaN coordinates in the file, so only its other fields are
        // compared.
        float x = 0;
        std::memcpy(&x, out[i].bytes.data() + at, sizeof x);
        const std::size_t from = x == x ? 0 : 12;
        ASSERT_EQ(out[i].bytes.compare(at + from, 20 - from, in[i].bytes, at + from, 20 - from), 0);
      }
    }
    EXPECT_NE(read.caps.at("see").find("height=(int)32"), std::string::npos);
    EXPECT_NE(read.caps.at("see").find("width=(int)512"), std::string::npos);
  }
}

TEST(CloudFileTypes, AreFoundInShortFilesOfUnknownSize) {
  const std::string ply = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n";
  const std::string pcd = "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\n";
  for (const auto& [type, text] : std::vector<std::pair<const char*, std::string>>{
           {"application/x-ply", ply},
           {"application/x-pcd", pcd},
           {"application/vnd.las", "LASF" + std::string(60, '\0')},
           {"application/x-ply", "ply\nforma"},
           {"application/x-pcd", pcd + std::string(600, ' ')}}) {
    const gst::CapsPtr caps(gst_type_find_helper_for_data(
        nullptr, reinterpret_cast<const guint8*>(text.data()), text.size(), nullptr));
    ASSERT_TRUE(caps) << text;
    EXPECT_TRUE(gst_structure_has_name(gst_caps_get_structure(caps.get(), 0), type)) << text;
  }
}

TEST_F(FileParse, PlyComesBackWithoutWhatIsMissing) {
  for (const char* encoder : {"plyenc", "plyenc binary=false"}) {
    Write(encoder, "scan%d.ply");
    // The file is so large that filesrc outputs it in several buffers.
    const auto read =
        Play("filesrc" + At("scan1.ply") + " ! typefind ! pointcloudparse ! fakesink name=see");
    EXPECT_EQ(read.error, "");
    ASSERT_EQ(read.buffers.at("see").size(), 1U);
    const Kept& kept = read.buffers.at("see")[0];
    EXPECT_GT(kept.bytes.size(), 20U * 32 * 512 / 2);
    EXPECT_EQ(kept.bytes.size() % 20, 0U);
    EXPECT_NE(kept.capture_time, GST_CLOCK_TIME_NONE);
  }
}

TEST_F(FileParse, CloudsOfOtherSizesFollowEachOther) {
  const std::string header = "ply\nformat ascii 1.0\nelement vertex ";
  const std::string rest =
      "\nproperty double x\nproperty double y\nproperty double z\nend_header\n";
  std::ofstream(Path("a0.ply")) << header << 1 << rest << "1 2 3\n";
  std::ofstream(Path("a1.ply")) << header << 2 << rest << "1 2 3\n4 5 6\n";
  std::ofstream(Path("a2.ply")) << header << 0 << rest;
  const auto read = Play("multifilesrc" + At("a%d.ply") + " ! pointcloudparse ! fakesink name=see");
  EXPECT_EQ(read.error, "");
  ASSERT_EQ(read.buffers.at("see").size(), 2U);
  EXPECT_EQ(read.buffers.at("see")[0].bytes.size(), 12U);  // doubles were converted to floats
  EXPECT_EQ(read.buffers.at("see")[1].bytes.size(), 24U);
  EXPECT_NE(read.warning, "");  // about the empty file
}

TEST_F(FileParse, AFolderPlaysAtTheRateThatIsAskedFor) {
  for (int i = 0; i < 3; ++i) {
    std::ofstream file(Path("00" + std::to_string(i) + ".bin"), std::ios::binary);
    for (int k = 0; k < 40 * (i + 1); ++k) {
      const float value = 1.5F;
      file.write(reinterpret_cast<const char*>(&value), sizeof value);
    }
  }
  const auto read = Play("multifilesrc" + At("%03d.bin") +
                         " ! pointcloudparse framerate=20/1 ! fakesink sync=true name=see");
  EXPECT_EQ(read.error, "");
  EXPECT_NE(read.caps.at("see").find("intensity:F32:12"), std::string::npos);
  const auto& out = read.buffers.at("see");
  ASSERT_EQ(out.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(out[i].bytes.size(), 160 * (i + 1));
    EXPECT_EQ(out[i].pts, i * 50 * GST_MSECOND);
    EXPECT_EQ(out[i].capture_time, out[0].capture_time + out[i].pts);
    EXPECT_EQ(out[i].slice.scan_id, i);
    EXPECT_EQ(out[i].slice.slice_count, 1U);
  }
  EXPECT_GT(out[0].capture_time, kCapture);  // the current time, or close to it
}

TEST_F(FileParse, LasKeepsIntensityAndTime) {
  std::string file(227 + 2 * 28, '\0');
  file.replace(0, 4, "LASF");
  const auto put = [&](std::size_t at, auto value) {
    std::memcpy(file.data() + at, &value, sizeof value);
  };
  put(24, std::uint16_t{0x0201});
  put(96, std::uint32_t{227});
  put(104, std::uint8_t{1});
  put(105, std::uint16_t{28});
  put(107, std::uint32_t{2});
  for (std::size_t k = 0; k < 3; ++k) put(131 + 8 * k, 0.5);
  put(227, std::int32_t{7});
  std::ofstream(Path("a.las"), std::ios::binary) << file;
  const auto read = Play("filesrc" + At("a.las") + " ! pointcloudparse ! fakesink name=see");
  EXPECT_EQ(read.error, "");
  ASSERT_EQ(read.buffers.at("see").size(), 1U);
  EXPECT_NE(read.caps.at("see").find("intensity:U16:12"), std::string::npos);
  EXPECT_NE(read.caps.at("see").find("gps_time:F64:20"), std::string::npos);
  float x = 0;
  std::memcpy(&x, read.buffers.at("see")[0].bytes.data(), sizeof x);
  EXPECT_EQ(x, 3.5F);
}

TEST_F(FileParse, ADamagedFileIsAnErrorThatSaysWhy) {
  std::ofstream(Path("a.ply")) << "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\n"
                                  "end_header\n1\n";
  EXPECT_EQ(Play("filesrc" + At("a.ply") + " ! pointcloudparse ! fakesink").error,
            "The PLY file cannot be read: the file ends before its last point.");
  std::ofstream(Path("a.las")) << "LASF";
  EXPECT_EQ(Play("filesrc" + At("a.las") + " ! pointcloudparse ! fakesink").error,
            "The LAS file cannot be read: its header is cut off.");
  std::ofstream(Path("a.txt")) << "neither";
  EXPECT_EQ(Play("filesrc" + At("a.txt") + " ! pointcloudparse ! fakesink").error,
            "The caps of the cloud are missing.");
}

TEST_F(FileParse, FilesOfOtherFieldsHaveOtherCaps) {
  const auto write = [this](const std::string& name, const std::string& more,
                            const std::string& point) {
    std::ofstream(Path(name)) << "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                                 "property float y\nproperty float z\n"
                              << more << "end_header\n"
                              << point;
  };
  write("b0.ply", "", "1 2 3\n");
  write("b1.ply", "property float intensity\n", "1 2 3 4\n");
  const auto read = Play("multifilesrc" + At("b%d.ply") + " ! pointcloudparse ! fakesink name=see");
  EXPECT_EQ(read.error, "");
  ASSERT_EQ(read.buffers.at("see").size(), 2U);
  EXPECT_EQ(read.buffers.at("see")[1].bytes.size(), 16U);
  EXPECT_NE(read.caps.at("see").find("intensity:F32:12"), std::string::npos);
}

}  // namespace
}  // namespace lidar::test
