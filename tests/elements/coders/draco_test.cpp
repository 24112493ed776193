// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of features that only Draco's elements have: clouds of any kind, as files that other
// programs can read.
#include <gtest/gtest.h>

#include <array>
#include <fstream>

#include "tests/elements/coders/plain_clouds.h"
#include "tests/support/element_bus.h"
#include "tests/support/files.h"

namespace lidar::gst {
namespace {

TEST(DracoEnc, CodesNoRangesOfMoreColumnsThanATurn) {
  const SensorModel model = test::RoomSensor();
  for (const char* geometry : {"range", "auto"})
    for (const guint columns : {511U, 512U, 513U}) {
      const Harness h = Encoder(kDraco, std::string("geometry=") + geometry);
      const CloudInfo info = OrganisedInfo(model, columns);
      SetCaps(h.get(), info);
      GstBuffer* empty = gst_buffer_new_allocate(nullptr, info.FrameSize(), nullptr);
      gst_buffer_memset(empty, 0, 0, info.FrameSize());
      const bool coded = columns <= 512 || std::string(geometry) == "auto";
      EXPECT_EQ(gst_harness_push(h.get(), empty) == GST_FLOW_OK, coded) << columns;
      if (!coded) continue;
      const CapsPtr caps(gst_pad_get_current_caps(GST_PAD_PEER(h->sinkpad)));
      EXPECT_STREQ(gst_structure_get_string(gst_caps_get_structure(caps.get(), 0), "geometry"),
                   columns <= 512 ? "range" : "xyz");
    }
}

TEST(DracoEnc, CloudsOfAnotherWidthGoOnWithTheMethodThatWasTheSmallerOne) {
  const Harness h(gst_harness_new("dracoenc"));
  for (const std::size_t width : {3000U, 2999U}) {
    // In this order of points the sequential coder needs fewer bytes. For shuffled points the
    // kd-tree coder would need fewer.
    std::vector<std::array<float, 3>> line(width);
    for (std::size_t i = 0; i < width; ++i) {
      const auto t = static_cast<float>(i) * 0.02F;
      line[i] = {t, 3 * std::sin(t), std::cos(t)};
    }
    if (width == 2999) std::shuffle(line.begin(), line.end(), std::mt19937(1));
    std::vector<float> xyz;
    for (const auto& point : line) xyz.insert(xyz.end(), point.begin(), point.end());
    SetCaps(h.get(), XyzInfo(static_cast<guint>(width)));
    const BufferPtr encoded(gst_harness_push_and_pull(h.get(), PlainBuffer(xyz)));
    ASSERT_TRUE(encoded);
    const BufferMap map(encoded.get(), GST_MAP_READ);
    constexpr std::size_t kMethod = 8;  // position in Draco's header; 0 is the sequential coder
    EXPECT_EQ(map.data()[kMethod], 0) << width;
  }
}

TEST(DracoEnc, LeavesOutCloudsThatAreTooLargeForTheirErrorAndSaysSoOnce) {
  const Harness h(gst_harness_new("dracoenc"));
  const test::ElementBus bus(h->element);
  g_object_set(h->element, "max-error", 0.0005, nullptr);
  SetCaps(h.get(), XyzInfo(2));
  for (guint scan = 0; scan < 2; ++scan)
    EXPECT_EQ(gst_harness_push(h.get(), PlainBuffer({1, 2, 3, 10'000, 0, 0})), GST_FLOW_OK);
  EXPECT_EQ(gst_harness_buffers_received(h.get()), 0U);
  EXPECT_EQ(test::StatOf(h->element, "slices-out-of-reach"), 2U);
  EXPECT_EQ(bus.Texts(GST_MESSAGE_WARNING),
            std::vector<std::string>{"A cloud is too large for max-error and was left out. Raise "
                                     "max-error, or crop the cloud."});
}

TEST(DracoEnc, GivesStockDracoFilesInXyzGeometry) {
  const StringPtr program(g_find_program_in_path("draco_decoder"));
  if (!program) GTEST_SKIP() << "draco_decoder (Debian package draco) is not installed";
  const Harness h(gst_harness_new("dracoenc"));
  const std::vector<float> random = RandomPoints(500, 40);
  SetCaps(h.get(), XyzInfo(500));
  const BufferPtr encoded(gst_harness_push_and_pull(h.get(), PlainBuffer(random)));
  const BufferMap map(encoded.get(), GST_MAP_READ);
  const test::TempFolder folder;
  const std::string file = folder.path() + "/slice.drc";
  const std::string text = folder.path() + "/slice.obj";
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
  ASSERT_EQ(points.size(), random.size());
  // The text has only six digits after the decimal point.
  EXPECT_LE(LargestGap(random, points), 0.02 + 1e-5);
}

}  // namespace
}  // namespace lidar::gst
