// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests the table "Odd input" of docs/elements/dracoenc.md with every coder.
#include <glib/gstdio.h>
#include <gtest/gtest.h>

#include <functional>
#include <tuple>

#include "src/rate/model_file.h"
#include "tests/elements/coders/checked_codec.h"

namespace lidar::gst {
namespace {

constexpr guint kColumns = 64;
constexpr std::size_t kStep = 20;  // bytes per point: x, y, z, intensity, range

struct CloudCase {
  const char* name;
  // Changes the ranges before points are made of them.
  std::function<void(codec::RangeImage*)> ranges;
  std::function<void(std::vector<std::uint8_t>*)> spoil;  // changes the points
  // False: with geometry=xyz no point is left.
  bool some_in_xyz = true;
};
void PrintTo(const CloudCase& c, std::ostream* out) { *out << c.name; }

void SetFloat(std::vector<std::uint8_t>* raw, std::size_t point, std::size_t offset, float value) {
  std::memcpy(raw->data() + point * kStep + offset, &value, sizeof value);
}

const CloudCase kClouds[] = {
    {"Nan", [](auto*) {},
     [](auto* raw) {
       for (std::size_t i = 0; i < 300; i += 3) SetFloat(raw, i, 4 * (i / 3 % 3), kNan);
     }},
    {"Infinity", [](auto*) {},
     [](auto* raw) {
       for (std::size_t i = 0; i < 300; i += 3)
         SetFloat(raw, i, 4 * (i / 3 % 3), i % 2 == 0 ? kInfinity : -kInfinity);
     }},
    {"NanIntensity", [](auto*) {},
     [](auto* raw) {
       for (std::size_t i = 0; i < 300; i += 3)
         SetFloat(raw, i, 12, i % 2 == 0 ? kNan : -kInfinity);
     }},
    {"NothingButZeros",
     [](auto* image) { std::fill(image->ranges.begin(), image->ranges.end(), 0U); }, [](auto*) {},
     false},
    {"ASingleReturn",
     [](auto* image) {
       std::fill(image->ranges.begin(), image->ranges.end(), 0U);
       image->ranges[777] = 5'000;
     },
     [](auto*) {}},
    {"AReturnAtTenKilometres", [](auto* image) { image->ranges[777] = 10'000'000; }, [](auto*) {}},
    {"Duplicates",
     [](auto* image) { std::fill(image->ranges.begin(), image->ranges.end(), 5'000U); },
     [](auto* raw) {
       // All points have the same x, y and z.
       for (std::size_t i = 1; i < raw->size() / kStep; ++i)
         std::memcpy(raw->data() + i * kStep, raw->data(), 12);
     }},
};

class BadClouds : public ::testing::TestWithParam<std::tuple<CloudCase, CoderCase>> {};

TEST_P(BadClouds, GiveFinitePointsWithinTheErrorAndNeverStopTheStream) {
  const auto& [bad, coder] = GetParam();
  const bool xyz = coder.xyz;
  const SensorModel model = test::RoomSensor();
  CheckedCodec codec(coder, "error-check=1");
  codec.SetCaps(OrganisedInfo(model, kColumns));
  auto image = test::RoomScan(model, 0, kColumns);
  bad.ranges(&image);
  auto raw = test::RawCloud(model, image);
  bad.spoil(&raw);
  const BufferPtr output = codec.Push(gst_buffer_new_memdup(raw.data(), raw.size()));
  ASSERT_EQ(output != nullptr, !xyz || bad.some_in_xyz);
  if (output) {
    const StructurePtr check = codec.PopCheck();
    ASSERT_TRUE(check);
    const bool moved =
        std::string(bad.name) == "Duplicates" && !xyz;  // the points contradict their ranges
    EXPECT_EQ(Holds(check.get()), !moved);
    for (const float v : PointsOf(output.get(), kStep - (xyz ? 4 : 0)))
      ASSERT_TRUE(std::isfinite(v));
  }
  // The next slice is coded normally.
  EXPECT_TRUE(codec.Push(OrganisedBuffer(model, kColumns, {9, 1, 8, 64})));
  EXPECT_TRUE(Holds(codec.PopCheck().get()));
  EXPECT_EQ(codec.Errors(), 0U);
}
INSTANTIATE_TEST_SUITE_P(All, BadClouds,
                         ::testing::Combine(::testing::ValuesIn(kClouds),
                                            ::testing::ValuesIn(OurCoders())),
                         [](const auto& c) {
                           return std::string(std::get<0>(c.param).name) + "_" +
                                  std::get<1>(c.param).name;
                         });

TEST_P(AnyCoder, PassesOverABufferWithoutAnyPoint) {
  const SensorModel model = test::RoomSensor();
  CloudInfo info = OrganisedInfo(model, 0);  // clouds may have any width
  CheckedCodec codec(GetParam());
  codec.SetCaps(info);
  GstBuffer* empty = gst_buffer_new();
  GST_BUFFER_PTS(empty) = 0;
  EXPECT_FALSE(codec.Push(empty));
  EXPECT_TRUE(codec.Push(OrganisedBuffer(model, kColumns, {9, 1, 8, 64})));
  EXPECT_EQ(codec.Errors(), 0U);
}

TEST_P(AnyCoder, RefusesABufferOfAnotherWidthThanItsCaps) {
  const SensorModel model = test::RoomSensor();
  for (const guint columns : {kColumns - 1, kColumns + 1, 2 * kColumns}) {
    const Harness h = Encoder(GetParam());
    SetCaps(h.get(), OrganisedInfo(model, kColumns));
    EXPECT_EQ(gst_harness_push(h.get(), OrganisedBuffer(model, columns, {0, 0, 8, 0})),
              GST_FLOW_ERROR)
        << columns;
  }
}

TEST_P(AnyCoder, KeepsTheErrorWhateverTheStepAndTheBitrate) {
  const SensorModel model = test::RoomSensor();
  for (const char* settings :
       {"quantization-step=0", "quantization-step=1e-7", "quantization-step=1000", "bitrate=1",
        "bitrate=4000000000", "rate-model=paper bitrate=500000", "intensity-bits=0",
        "degradation-preference=maintain-framerate bitrate=1"}) {
    CheckedCodec codec(GetParam(), "error-check=1 " + std::string(settings));
    codec.SetCaps(OrganisedInfo(model, kColumns));
    unsigned checked = 0;
    for (guint i = 0; i < 16; ++i) {
      codec.Push(OrganisedBuffer(model, kColumns, {i / 8, i % 8, 8, 64 * (i % 8)}));
      while (const StructurePtr check = codec.PopCheck()) {
        EXPECT_TRUE(Holds(check.get())) << settings;
        ++checked;
      }
    }
    EXPECT_GE(checked, 8U) << settings;  // at least 8: the first scan is always sent
    EXPECT_EQ(codec.Warnings() + codec.Errors(), 0U) << settings;
  }
}

/// Returns the error message of an encoder whose caps have `text` as their model file.
std::string ErrorWithModelFile(const std::string& text, const CoderCase& coder,
                               const std::string& properties = "") {
  gchar* name = nullptr;
  g_close(g_file_open_tmp("model-XXXXXX.json", &name, nullptr), nullptr);
  const StringPtr owned(name);
  g_file_set_contents(name, text.c_str(), static_cast<gssize>(text.size()), nullptr);
  const Harness h = Encoder(coder, properties + " model-location=" + name);
  const test::ElementBus bus(h->element);
  gst_harness_play(h.get());
  gst_harness_push_event(h.get(), gst_event_new_stream_start("model"));
  const CapsPtr caps(OrganisedInfo(test::RoomSensor(), kColumns).ToCaps());
  gst_harness_push_event(h.get(), gst_event_new_caps(caps.get()));
  g_remove(name);
  const MessagePtr message = bus.Pop(GST_MESSAGE_ERROR);
  return message ? test::MessageText(message.get()) + " " + test::MessageDetails(message.get())
                 : "";
}

TEST_P(AnyCoder, RefusesAModelFileThatIsTruncatedForeignOrFromTheFuture) {
  const std::string good =
      R"({"format": "gst-lidar-rate-model", "version": 1, "adaptive": {"modes": {},
    "fallback": {"step": [9, -0.5, 0, 0], "log2-step-range": [-3, 5], "returns": 1,
                 "intensity": [6, 1.5], "intensity-returns": 1}}})";
  const auto error = [&](const std::string& text) { return ErrorWithModelFile(text, GetParam()); };
  EXPECT_EQ(error(good), "");
  EXPECT_NE(error(good.substr(0, good.size() / 2)).find("cut off"), std::string::npos);
  EXPECT_NE(error(R"({"format": "recipe", "version": 1})").find("format"), std::string::npos);
  std::string future = good;
  future.replace(future.find("\"version\": 1"), 12, "\"version\": 9");
  EXPECT_NE(error(future).find("version"), std::string::npos) << error(future);
  EXPECT_NE(ErrorWithModelFile("", GetParam()), "");
  const std::string other = ErrorWithModelFile(good, GetParam(), "rate-model=paper");
  EXPECT_NE(other.find("no coefficients of the model \"paper\""), std::string::npos) << other;
}

TEST_P(AnyCoder, CodesNothingWithoutTheModelFileThatItIsToUse) {
  const Harness h = Encoder(GetParam(), "model-location=/nonexistent/model.json");
  const test::ElementBus bus(h->element);
  SetCaps(h.get(), OrganisedInfo(test::RoomSensor(), kColumns));
  const MessagePtr message = bus.Pop(GST_MESSAGE_ERROR);
  ASSERT_TRUE(message);
  const std::string text = test::MessageText(message.get());
  EXPECT_NE(text.find("\"/nonexistent/model.json\""), std::string::npos) << text;
  EXPECT_EQ(gst_harness_push(
                h.get(), OrganisedBuffer(test::RoomSensor(), kColumns, {0, 0, 512 / kColumns, 0})),
            GST_FLOW_NOT_NEGOTIATED);
  EXPECT_EQ(gst_harness_buffers_received(h.get()), 0U);
}

}  // namespace
}  // namespace lidar::gst
