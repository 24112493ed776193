// SPDX-License-Identifier: LGPL-2.1-or-later
// What only Draco's elements do: clouds of any kind, as files that other programs read.
#include <glib/gstdio.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <random>
#include <tuple>

#include "tests/elements/coders/coder_harness.h"

namespace lidar::gst {
namespace {

CloudInfo XyzInfo(guint points) {
  CloudInfo info;
  info.width = points;
  info.point_step = 16;
  info.fields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,intensity:F32:12");
  info.framerate_n = 10;
  return info;
}

/// x, y, z and an intensity of 0.5 for each point.
GstBuffer* PlainBuffer(const std::vector<float>& xyz) {
  std::vector<float> raw;
  for (std::size_t i = 0; i + 2 < xyz.size(); i += 3)
    raw.insert(raw.end(), {xyz[i], xyz[i + 1], xyz[i + 2], 0.5F});
  GstBuffer* buffer = gst_buffer_new_memdup(raw.data(), raw.size() * sizeof(float));
  GST_BUFFER_PTS(buffer) = 0;
  GST_BUFFER_DURATION(buffer) = 100 * GST_MSECOND;
  return buffer;
}

/// Distance from each point of `a` to the nearest of `b`, the largest of them.
double LargestGap(const std::vector<float>& a, const std::vector<float>& b) {
  double largest = 0;
  for (std::size_t i = 0; i + 2 < a.size(); i += 3) {
    double nearest = 1e9;
    for (std::size_t k = 0; k + 2 < b.size(); k += 3) {
      const double x = static_cast<double>(a[i]) - static_cast<double>(b[k]);
      const double y = static_cast<double>(a[i + 1]) - static_cast<double>(b[k + 1]);
      const double z = static_cast<double>(a[i + 2]) - static_cast<double>(b[k + 2]);
      nearest = std::min(nearest, std::sqrt(x * x + y * y + z * z));
    }
    largest = std::max(largest, nearest);
  }
  return largest;
}

std::vector<float> RandomPoints(std::size_t count, float extent) {
  std::mt19937 random(11);
  std::vector<float> xyz;
  for (std::size_t i = 0; i < 3 * count; ++i)
    xyz.push_back(extent * (static_cast<float>(random() % 65'536) / 65'536 - 0.5F));
  return xyz;
}

struct PlainCase {
  const char* name;
  std::vector<float> xyz;
  std::vector<float> expected;  // what is finite and not all zero
};
class PlainClouds : public ::testing::TestWithParam<std::tuple<PlainCase, guint>> {};

TEST_P(PlainClouds, ComeBackWithinTheErrorWhateverIsInThem) {
  const auto& [cloud, level] = GetParam();
  const Harness h = Codec(kDracoXyz, "max-error=0.02 compression-level=" + std::to_string(level));
  const auto points = static_cast<guint>(cloud.xyz.size() / 3);
  SetCaps(h.get(), XyzInfo(points));
  ASSERT_EQ(gst_harness_push(h.get(), PlainBuffer(cloud.xyz)), GST_FLOW_OK);
  ASSERT_EQ(gst_harness_buffers_received(h.get()), cloud.expected.empty() ? 0U : 1U);
  if (cloud.expected.empty()) return;
  const BufferPtr output(gst_harness_pull(h.get()));
  const auto after = PointsOf(output.get(), 16);
  ASSERT_EQ(after.size(), cloud.expected.size());
  EXPECT_LE(LargestGap(cloud.expected, after), 0.02);
  EXPECT_LE(LargestGap(after, cloud.expected), 0.02);
}

const std::vector<float> kRandom = RandomPoints(500, 40);
const std::vector<float> kFar = {1, 2, 3, 10'000, 1, 1, 4, 5, 6};
INSTANTIATE_TEST_SUITE_P(
    All, PlainClouds,
    ::testing::Combine(
        ::testing::Values(
            PlainCase{"random", kRandom, kRandom}, PlainCase{"single", {1, 2, 3}, {1, 2, 3}},
            PlainCase{"duplicates", {1, 2, 3, 1, 2, 3}, {1, 2, 3, 1, 2, 3}},
            PlainCase{"far", kFar, kFar}, PlainCase{"zeros", {0, 0, 0, 0, 0, 0}, {}},
            PlainCase{"nan", {kNan, 0, 0, 1, 2, 3, 0, kNan, 1}, {1, 2, 3}},
            PlainCase{"infinite", {kInfinity, 0, 0, 1, 2, 3, 0, 0, -kInfinity}, {1, 2, 3}}),
        ::testing::Values(0U, 1U, 7U)),
    [](const auto& c) {
      return std::string(std::get<0>(c.param).name) + std::to_string(std::get<1>(c.param));
    });

TEST(DracoEnc, GivesStockDracoFilesInXyzGeometry) {
  const StringPtr program(g_find_program_in_path("draco_decoder"));
  if (!program) GTEST_SKIP() << "draco_decoder (Debian package draco) is not installed";
  const Harness h(gst_harness_new("dracoenc"));
  SetCaps(h.get(), XyzInfo(500));
  const BufferPtr encoded(gst_harness_push_and_pull(h.get(), PlainBuffer(kRandom)));
  const BufferMap map(encoded.get(), GST_MAP_READ);
  const StringPtr folder(g_dir_make_tmp("draco-XXXXXX", nullptr));
  const std::string file = std::string(folder.get()) + "/slice.drc";
  const std::string text = std::string(folder.get()) + "/slice.obj";
  ASSERT_TRUE(g_file_set_contents(file.c_str(), reinterpret_cast<const gchar*>(map.data()),
                                  static_cast<gssize>(map.size()), nullptr));
  const std::string command = "draco_decoder -i " + file + " -o " + text;
  gint status = -1;
  ASSERT_TRUE(g_spawn_command_line_sync(command.c_str(), nullptr, nullptr, &status, nullptr));
  ASSERT_EQ(status, 0);
  std::ifstream lines(text);
  std::vector<float> points;
  for (std::string word; lines >> word;) {
    float p[3];
    if (word == "v" && lines >> p[0] >> p[1] >> p[2]) points.insert(points.end(), p, p + 3);
  }
  ASSERT_EQ(points.size(), kRandom.size());
  // The text has six digits after the point.
  EXPECT_LE(LargestGap(kRandom, points), 0.02 + 1e-5);
  g_remove(file.c_str());
  g_remove(text.c_str());
  g_rmdir(folder.get());
}

}  // namespace
}  // namespace lidar::gst
