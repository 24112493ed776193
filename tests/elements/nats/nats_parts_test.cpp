// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of the parts of the NATS plugin that need no server.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "ext/nats/answers.h"
#include "ext/nats/connection.h"
#include "ext/nats/format_book.h"
#include "ext/nats/jetstream.h"
#include "ext/nats/message.h"
#include "ext/nats/nats_settings.h"
#include "ext/nats/outbox.h"
#include "ext/nats/place_book.h"
#include "ext/nats/source_account.h"
#include "gst/lidar/gstlidar.h"
#include "tests/elements/mcap/recording.h"
#include "tests/support/element_bus.h"

namespace lidar::nats {
namespace {

constexpr const char* kId = "0123456789abcdef";
constexpr const char* kSliceCaps =
    "application/x-lidar-slice, geometry=(string)range, alignment=(string)slice";

class NatsParts : public ::testing::Test {
 protected:
  void SetUp() override {
    gst_lidar_init();
    nats_Open(-1);  // the first connection would do this otherwise
  }
};

gst::BufferPtr Bytes(std::size_t size) {
  gst::BufferPtr buffer(gst_buffer_new_allocate(nullptr, size, nullptr));
  gst_buffer_memset(buffer.get(), 0, 0x5a, size);
  return buffer;
}

TEST_F(NatsParts, AMessageCarriesAllThatABufferHas) {
  const gst::BufferPtr buffer = Bytes(100);
  const GstLidarSlice slice{4'000'000'000, 3, 8, 512};
  GstLidarPose pose{{1.5, -2.25, 1e-300}, {0.1, 0.2, 0.3, 0.9}, GST_LIDAR_TRACKING_LOST, {}};
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column)
      pose.covariance[row * 6 + column] = std::ldexp(row * column - 7, row + column - 20);
  gst_lidar_buffer_set_slice(buffer.get(), &slice);
  gst_lidar_buffer_set_pose(buffer.get(), &pose);
  gst_lidar_buffer_set_capture_time(buffer.get(), 1'764'000'000'123'456'789);
  GST_BUFFER_DURATION(buffer.get()) = 12'500'000;
  GST_BUFFER_FLAG_SET(buffer.get(), GST_BUFFER_FLAG_DISCONT);
  const Place place{~std::uint64_t{0}, 42};
  const MessagePtr message = WriteMessage("a.b", nullptr, kId, place, buffer.get());
  ASSERT_TRUE(message);
  const auto read = Read(message.get());
  ASSERT_TRUE(read);
  EXPECT_EQ(read->format_id, kId);
  EXPECT_EQ(read->place.run, place.run);
  EXPECT_EQ(read->place.number, 42U);
  const auto kept = test::Keep(read->buffer.get());
  EXPECT_TRUE(kept.SameAs(test::Keep(buffer.get())));
  EXPECT_EQ(kept.duration, 12'500'000U);
  EXPECT_TRUE(kept.discont);
  GstLidarPose back{};
  ASSERT_TRUE(gst_lidar_buffer_get_pose(read->buffer.get(), &back));
  for (int i = 0; i < 3; ++i) EXPECT_EQ(back.position[i], pose.position[i]);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(back.orientation[i], pose.orientation[i]);
  EXPECT_EQ(back.tracking, pose.tracking);
  for (int i = 0; i < 36; ++i) EXPECT_EQ(back.covariance[i], pose.covariance[i]) << i;
}

TEST_F(NatsParts, TheLongestPoseComesBack) {
  const gst::BufferPtr buffer = Bytes(1);
  constexpr double kLongDouble = -1.2345678901234567e-301;
  const auto kLongFloat = double{-1.23456794e-31F};
  GstLidarPose pose{};
  std::fill_n(pose.position, 3, kLongDouble);
  std::fill_n(pose.orientation, 4, kLongDouble);
  std::fill_n(pose.covariance, 36, kLongFloat);
  gst_lidar_buffer_set_pose(buffer.get(), &pose);
  const auto read = Read(WriteMessage("a", nullptr, kId, {1, 2}, buffer.get()).get());
  ASSERT_TRUE(read);
  GstLidarPose back{};
  ASSERT_TRUE(gst_lidar_buffer_get_pose(read->buffer.get(), &back));
  EXPECT_EQ(back.orientation[3], kLongDouble);
  EXPECT_EQ(back.covariance[35], kLongFloat);
}

TEST_F(NatsParts, ACovarianceBeyondFloatComesBackAsTheLargestFloat) {
  const gst::BufferPtr buffer = Bytes(1);
  constexpr double kMost = std::numeric_limits<float>::max();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  GstLidarPose pose{};
  const double written[] = {1e300, -1e300, kInfinity, -kInfinity, std::nan(""), kMost};
  std::copy(std::begin(written), std::end(written), pose.covariance);
  gst_lidar_buffer_set_pose(buffer.get(), &pose);
  const auto read = Read(WriteMessage("a", nullptr, kId, {1, 2}, buffer.get()).get());
  ASSERT_TRUE(read);
  GstLidarPose back{};
  ASSERT_TRUE(gst_lidar_buffer_get_pose(read->buffer.get(), &back));
  const double expected[] = {kMost, -kMost, kMost, -kMost, kMost, kMost};
  for (int i = 0; i < 6; ++i) EXPECT_EQ(back.covariance[i], expected[i]) << i;
}

TEST_F(NatsParts, ABareBufferComesBackBare) {
  const gst::BufferPtr buffer = Bytes(1);
  const auto read = Read(WriteMessage("a", nullptr, kId, {1, 2}, buffer.get()).get());
  ASSERT_TRUE(read);
  GstLidarSlice slice{};
  EXPECT_FALSE(gst_lidar_buffer_get_slice(read->buffer.get(), &slice));
  EXPECT_EQ(gst_lidar_buffer_get_capture_time(read->buffer.get()), GST_CLOCK_TIME_NONE);
  EXPECT_EQ(GST_BUFFER_DURATION(read->buffer.get()), GST_CLOCK_TIME_NONE);
}

// A covariance whose numbers are all 0.
const std::string kZeros = " 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0";

struct BadHeader {
  const char* name;
  std::string value;
};
class NatsBadHeader : public NatsParts, public ::testing::WithParamInterface<BadHeader> {};
INSTANTIATE_TEST_SUITE_P(
    All, NatsBadHeader,
    ::testing::Values(BadHeader{"Lidar-Caps", "0123456789ABCDEF"}, BadHeader{"Lidar-Caps", "01"},
                      BadHeader{"Lidar-Caps", "../../../../etc/"}, BadHeader{"Lidar-Place", "1"},
                      BadHeader{"Lidar-Place", "1 -2"}, BadHeader{"Lidar-Place", "1 2 3"},
                      BadHeader{"Lidar-Place", " 1 2"}, BadHeader{"Lidar-Place", "1  2"},
                      BadHeader{"Lidar-Place", "99999999999999999999 1"},
                      BadHeader{"Lidar-Capture-Time", "-1"},
                      BadHeader{"Lidar-Capture-Time", "18446744073709551615"},
                      BadHeader{"Lidar-Capture-Time", "12x"}, BadHeader{"Lidar-Duration", "1e9"},
                      BadHeader{"Lidar-Slice", "1 2 3"}, BadHeader{"Lidar-Slice", "1 8 8 0"},
                      BadHeader{"Lidar-Slice", "1 0 0 0"}, BadHeader{"Lidar-Slice", "1 0 4097 0"},
                      BadHeader{"Lidar-Slice", "4294967296 0 1 0"},
                      BadHeader{"Lidar-Pose", "nan 0 0 0 0 0 1 1" + kZeros},
                      BadHeader{"Lidar-Pose", "0 0 0 0 0 0 1 4" + kZeros},
                      BadHeader{"Lidar-Pose", "0 0 0 nan 0 0 0 1" + kZeros},
                      BadHeader{"Lidar-Pose", "0 0 0 0 0 0 1e999 1" + kZeros},
                      BadHeader{"Lidar-Pose", "0 0 0 0 0 0 1 1" + kZeros + "x"},
                      BadHeader{"Lidar-Pose", "0 0 0 0 0 0 1 1 nan" + kZeros.substr(2)},
                      BadHeader{"Lidar-Pose", "0 0 0 0 0 0 1 1 1e39" + kZeros.substr(2)}));

TEST_F(NatsParts, APoseOfTheRightLengthIsRead) {
  const gst::BufferPtr buffer = Bytes(10);
  const MessagePtr message = WriteMessage("a", nullptr, kId, {1, 2}, buffer.get());
  natsMsgHeader_Set(message.get(), "Lidar-Pose", ("0 0 0 0 0 0 1 1" + kZeros).c_str());
  EXPECT_TRUE(Read(message.get()));
}

TEST_F(NatsParts, ABufferWithAPoseOfAnotherLengthHasNone) {
  for (const std::string& pose : {std::string("0 0 0 0 0 0 1"), "0 0 0 0 0 0 1 1 0" + kZeros,
                                  std::string("0 0 0 0 0 0 1 1 0.5 0.01")}) {
    const gst::BufferPtr buffer = Bytes(10);
    const MessagePtr message = WriteMessage("a", nullptr, kId, {1, 2}, buffer.get());
    natsMsgHeader_Set(message.get(), "Lidar-Pose", pose.c_str());
    const auto read = Read(message.get());
    ASSERT_TRUE(read) << pose;
    GstLidarPose back{};
    EXPECT_FALSE(gst_lidar_buffer_get_pose(read->buffer.get(), &back)) << pose;
  }
}

TEST_P(NatsBadHeader, IsRefused) {
  const gst::BufferPtr buffer = Bytes(10);
  const MessagePtr message = WriteMessage("a", nullptr, kId, {1, 2}, buffer.get());
  ASSERT_TRUE(Read(message.get()));
  natsMsgHeader_Set(message.get(), GetParam().name, GetParam().value.c_str());
  EXPECT_FALSE(Read(message.get())) << GetParam().name << ": " << GetParam().value;
}

TEST_F(NatsParts, AMessageWithoutHeadersOrBytesIsRefused) {
  natsMsg* raw = nullptr;
  ASSERT_EQ(natsMsg_Create(&raw, "a", nullptr, "hello", 5), NATS_OK);
  const MessagePtr plain(raw);
  EXPECT_FALSE(Read(plain.get()));
  const gst::BufferPtr empty(gst_buffer_new());
  EXPECT_FALSE(Read(WriteMessage("a", nullptr, kId, {1, 2}, empty.get()).get()));
  const gst::BufferPtr some = Bytes(1);
  const MessagePtr message = WriteMessage("a", nullptr, kId, {1, 2}, some.get());
  natsMsgHeader_Set(message.get(), "Lidar-Slice", std::string(100'000, '1').c_str());
  EXPECT_FALSE(Read(message.get()));
}

StreamFormat::Ptr FormatOf(const char* text, std::string* why) {
  const gst::CapsPtr caps(gst_caps_from_string(text));
  return StreamFormat::FromCaps(caps.get(), why);
}

TEST_F(NatsParts, AFormatComesBackFromItsText) {
  std::string why;
  const auto format = FormatOf(kSliceCaps, &why);
  ASSERT_TRUE(format) << why;
  const auto back = StreamFormat::FromText(format->text());
  ASSERT_TRUE(back);
  EXPECT_EQ(back->id(), format->id());
  EXPECT_TRUE(gst_caps_is_equal(back->caps(), format->caps()));
  EXPECT_TRUE(format->Fits(7));
  EXPECT_FALSE(format->Fits(0));
}

TEST_F(NatsParts, AFormatKnowsHowLargeItsBuffersAre) {
  std::string why;
  const auto imu = FormatOf("application/x-imu, sample-size=(int)32, fields=(string)t", &why);
  ASSERT_TRUE(imu);
  EXPECT_TRUE(imu->Fits(96));
  EXPECT_FALSE(imu->Fits(97));
  const auto pose = FormatOf("application/x-odometry", &why);
  ASSERT_TRUE(pose);
  const auto read = StreamFormat::FromText(pose->text());
  for (const std::size_t size : {0U, 63U, 64U, 65U, 351U, 352U, 353U}) {
    EXPECT_EQ(pose->Fits(size), size == 64 || size == 352) << size;
    EXPECT_EQ(read->Fits(size), pose->Fits(size)) << size;
  }
  EXPECT_FALSE(FormatOf("application/x-imu", &why));
  EXPECT_EQ(why, "the caps of IMU samples have no sample-size");
  EXPECT_FALSE(FormatOf("application/x-pointcloud2, width=(int)4", &why));
  EXPECT_FALSE(FormatOf("video/x-raw", &why));
  EXPECT_EQ(
      why,
      "natssink publishes clouds, coded slices, IMU samples and odometry, but not video/x-raw");
}

TEST_F(NatsParts, TextOfStrangersMakesNoFormat) {
  const std::string deep(2'000, '{');
  for (const std::string& text :
       {std::string(), std::string("ANY"), std::string("EMPTY"),
        std::string("application/x-odometry;") + kSliceCaps, std::string("video/x-raw"),
        std::string("application/x-imu, sample-size=(int)[1,5]"),
        std::string("application/x-imu, sample-size=(int)0"),
        std::string("application/x-imu, sample-size=(int)-1"), "application/x-odometry, a=" + deep,
        std::string("application/x-odometry, a=(string)\"\x01\""),
        std::string("application/x-odometry(memory:GLMemory)")})
    EXPECT_FALSE(StreamFormat::FromText(text)) << text.substr(0, 80);
}

TEST_F(NatsParts, ACoderThatNobodyHereKnowsHasAFormat) {
  const std::string text =
      "application/x-voxels, alignment=(string)slice, fields=(string)\"x:F32:0\\,y:F32:4\", "
      "levels=(uint)7";
  std::string why;
  const auto format = FormatOf(text.c_str(), &why);
  ASSERT_TRUE(format) << why;
  EXPECT_EQ(format->text(), text);
  const auto back = StreamFormat::FromText(text);
  ASSERT_TRUE(back);
  EXPECT_TRUE(gst_caps_is_equal(back->caps(), format->caps()));
  // The caps have no alignment=slice.
  EXPECT_FALSE(FormatOf("application/x-voxels, levels=(uint)7", &why));
  EXPECT_FALSE(FormatOf("application/x-voxels, alignment=slice, levels=(uint)<1,2>", &why));
  EXPECT_EQ(why,
            "the field levels is not a string, number, fraction, flag, buffer or array of doubles");
}

TEST_F(NatsParts, NestedTextIsRefusedAtOnce) {
  std::string text = std::string(kSliceCaps) + ", a=";
  // Each level doubles the time that GStreamer's parser needs.
  while (text.size() < 569) text += "[[ a, b={";
  FormatBook book;
  book.Note("a.config.0000000000000000", text);
  EXPECT_EQ(book.damaged(), 1U);
  EXPECT_FALSE(StreamFormat::FromText(text));
}

TEST_F(NatsParts, TheBookKeepsTheNewestFormatsAndCountsWhatIsDamaged) {
  FormatBook book;
  std::vector<std::string> ids;
  for (int i = 0; i < 40; ++i) {
    std::string why;
    const auto format =
        FormatOf((std::string(kSliceCaps) + ", number=(int)" + std::to_string(i)).c_str(), &why);
    ids.push_back(format->id());
    book.Note("a.config." + format->id(), format->text());
  }
  EXPECT_EQ(book.damaged(), 0U);
  EXPECT_TRUE(book.Find(ids.back()));
  EXPECT_FALSE(book.Find(ids.front()));
  book.Note("a.config." + ids.front(), "application/x-odometry");  // the id belongs to other caps
  book.Note("a.config.*", kSliceCaps);
  book.Note("", "");
  EXPECT_EQ(book.damaged(), 3U);
}

Outgoing Item(std::uint64_t number, std::size_t size) { return {number, Bytes(size), nullptr}; }

TEST_F(NatsParts, TheOutboxDropsTheOldestThatWait) {
  Outbox box(10'000);
  std::size_t dropped = 0;
  for (std::uint64_t i = 0; i < 20; ++i) dropped += box.Push(Item(i, 1'000));
  EXPECT_LE(box.bytes(), 10'000U);
  EXPECT_EQ(box.waiting() + dropped, 20U);
  EXPECT_EQ(box.Take({})->number, dropped);
  EXPECT_EQ(box.Push(Item(20, 1'000'000)), box.in_flight() == 1 ? 21 - dropped - 1 : 0U);
  EXPECT_EQ(box.waiting(), 0U);
  EXPECT_EQ(box.in_flight(), 1U);  // messages in flight are not dropped
}

TEST_F(NatsParts, TheOutboxCountsTheFormatsOfWhatWaits) {
  Outbox box(1'000'000);
  std::vector<std::weak_ptr<const StreamFormat>> formats;
  std::size_t dropped = 0;
  for (std::uint64_t i = 0; i < 200; ++i) {
    std::string why;
    const std::string text =
        kSliceCaps + std::string(", note=(string)") + std::string(50'000, 'a') + std::to_string(i);
    const gst::CapsPtr caps(gst_caps_from_string(text.c_str()));
    const auto format = StreamFormat::FromCaps(caps.get(), &why);
    ASSERT_TRUE(format) << why;
    formats.push_back(format);
    dropped += box.Push({i, Bytes(10), format});
    EXPECT_LE(box.bytes(), 1'000'000U);
  }
  const auto kept = std::count_if(formats.begin(), formats.end(),
                                  [](const auto& format) { return !format.expired(); });
  EXPECT_LE(kept, 20) << "of 50 kB each, and their caps";
  EXPECT_EQ(dropped, 200 - box.waiting());
  while (const auto item = box.Take({})) box.Remove(item->number);
  EXPECT_EQ(box.bytes(), 0U);
}

TEST_F(NatsParts, TheOutboxSendsAgainInOrder) {
  Outbox box(1'000'000);
  for (std::uint64_t i = 0; i < 6; ++i) box.Push(Item(i, 10));
  for (int i = 0; i < 4; ++i) box.Take({});
  EXPECT_TRUE(box.Remove(1));
  EXPECT_FALSE(box.Remove(1));
  EXPECT_FALSE(box.Remove(5));  // no message 5 was sent
  EXPECT_EQ(box.RetryAll(), 3U);
  EXPECT_FALSE(box.OldestInFlight());
  std::vector<std::uint64_t> order;
  while (const auto item = box.Take({})) order.push_back(item->number);
  EXPECT_EQ(order, (std::vector<std::uint64_t>{0, 2, 3, 4, 5}));
  EXPECT_EQ(box.Clear(), 5U);
  EXPECT_EQ(box.bytes(), 0U);
}

/// Compares the outbox with a simple model. At random, the sink sends a message, or the server
/// acknowledges one, or the server refuses one or does not answer.
TEST_F(NatsParts, TheOutboxKnowsOfEachMessageWhereItIsAndSinceWhen) {
  using Time = Outbox::Clock::time_point;
  std::vector<StreamFormat::Ptr> formats;
  for (const char* note : {"one", "another"}) {
    std::string why;
    const gst::CapsPtr caps(
        gst_caps_from_string((kSliceCaps + std::string(", note=(string)") + note).c_str()));
    formats.push_back(StreamFormat::FromCaps(caps.get(), &why));
  }
  const auto message = [&](std::uint64_t n) {
    return Outgoing{n, Bytes(100 + 7 * (n % 50)), formats[n / 20 % 2]};
  };
  std::mt19937 random(23);
  Outbox box(1U << 20);
  std::set<std::uint64_t> waiting;
  std::map<std::uint64_t, Time> in_flight;
  std::uint64_t next = 0;
  Time now{};
  for (int step = 0; step < 3'000; ++step) {
    now += std::chrono::milliseconds(random() % 5);
    const std::uint64_t any = next == 0 ? 0 : random() % next;
    const bool flies = in_flight.count(any) > 0;
    switch (random() % 5) {
      case 0:
      case 1:
        EXPECT_EQ(box.Push(message(next)), 0U);
        waiting.insert(next++);
        break;
      case 2:
        if (const auto item = box.Take(now)) {
          EXPECT_EQ(item->number, *waiting.begin()) << "the oldest first";
          in_flight[item->number] = now;
          waiting.erase(item->number);
        }
        break;
      case 3:
        EXPECT_EQ(box.Remove(any), flies);
        in_flight.erase(any);
        break;
      case 4:
        if (step % 3 != 0) break;
        EXPECT_EQ(box.Retry(any), flies ? 1U : 0U);
        if (flies) waiting.insert(any);
        in_flight.erase(any);
        break;
    }
    EXPECT_EQ(box.waiting(), waiting.size());
    EXPECT_EQ(box.in_flight(), in_flight.size());
    std::optional<Time> oldest;
    for (const auto& [n, at] : in_flight) oldest = std::min(oldest.value_or(at), at);
    EXPECT_EQ(box.OldestInFlight(), oldest);
    EXPECT_EQ(box.NextFormat(), waiting.empty() ? nullptr : formats[*waiting.begin() / 20 % 2]);
    if (step % 100 != 0) continue;
    Outbox fresh(1U << 20);
    for (const auto n : waiting) fresh.Push(message(n));
    for (const auto& [n, at] : in_flight) fresh.Push(message(n));
    EXPECT_EQ(box.bytes(), fresh.bytes()) << "as if nothing else had ever been in it";
  }
}

/// Notes numbers in random order. Some numbers repeat.
TEST_F(NatsParts, ABookOfPlacesCountsAGapAsOftenAsItIsFilled) {
  std::mt19937 random(5);
  PlaceBook book;
  std::set<std::uint64_t> came;
  std::int64_t missing = 0;
  std::uint64_t front = 100;
  book.Note({7, front});
  came.insert(front);
  for (int i = 0; i < 500; ++i) {
    const std::uint64_t n = random() % 3 == 0
                                ? front - std::min<std::uint64_t>(random() % 6, front - 100)
                                : front + random() % 4;
    const auto verdict = book.Note({7, n});
    EXPECT_EQ(verdict.again, came.count(n) > 0) << n;
    missing += static_cast<std::int64_t>(verdict.missing);
    if (verdict.fills_gap) --missing;
    came.insert(n);
    front = std::max(front, n);
    EXPECT_EQ(missing, static_cast<std::int64_t>(front - 100 + 1 - came.size()));
  }
}

TEST_F(NatsParts, ABookOfPlacesKnowsWhatCameAndWhatIsMissing) {
  PlaceBook book;
  EXPECT_FALSE(book.Note({1, 10}).again);
  EXPECT_TRUE(book.Note({1, 10}).again);
  EXPECT_EQ(book.Note({1, 11}).missing, 0U);
  EXPECT_EQ(book.Note({1, 15}).missing, 3U);
  const auto late = book.Note({1, 13});
  EXPECT_TRUE(late.late && late.fills_gap && !late.again);
  for (const std::uint64_t n : {10U, 11U, 13U, 15U}) EXPECT_TRUE(book.Note({1, n}).again) << n;
  EXPECT_FALSE(book.Note({1, 12}).again);
  EXPECT_FALSE(book.Note({1, 14}).again);
  EXPECT_EQ(book.Note({1, 16}).missing, 0U) << "there is no gap any more";
  const auto before = book.Note({1, 5});
  EXPECT_TRUE(before.late && !before.fills_gap);
  EXPECT_FALSE(book.Note({2, 10}).again) << "another sink";
  const auto jump = book.Note({1, std::numeric_limits<std::uint64_t>::max()});
  EXPECT_FALSE(jump.again);
  EXPECT_EQ(jump.missing, 0U) << "2^64 messages were never sent";
  EXPECT_TRUE(book.Note({1, std::numeric_limits<std::uint64_t>::max()}).again);
}

TEST_F(NatsParts, ABookOfPlacesIsBounded) {
  PlaceBook book;
  // Leaves a gap after each number.
  for (std::uint64_t n = 0; n < 100'000; n += 2) book.Note({1, n});
  EXPECT_TRUE(book.Note({1, 99'998}).again);
  EXPECT_FALSE(book.Note({1, 0}).again) << "forgotten";
  for (std::uint64_t run = 2; run < 1'000; ++run) book.Note({run, 1});
  EXPECT_TRUE(book.Note({999, 1}).again);
  EXPECT_FALSE(book.Note({1, 99'998}).again) << "forgotten";
}

TEST_F(NatsParts, APatternCoversWhatItsWildcardsSay) {
  EXPECT_TRUE(Covers("a.b", "a.b"));
  EXPECT_TRUE(Covers("a.*", "a.b"));
  EXPECT_TRUE(Covers("a.>", "a.b.config.*"));
  EXPECT_TRUE(Covers(">", "a"));
  EXPECT_FALSE(Covers("a.*", "a.b.c"));
  EXPECT_FALSE(Covers("a.b.c", "a.b"));
  EXPECT_FALSE(Covers("a.b", "a.*"));
  EXPECT_TRUE(Covers("a.>", "a.*"));
  EXPECT_FALSE(Covers("a.>", "a"));
  EXPECT_FALSE(Covers("a.*", "a.>"));
}

/// Compares Covers() with a regular expression for all patterns and subjects of up to three words.
TEST_F(NatsParts, APatternCoversASubjectAsARegularExpressionDoes) {
  std::vector<std::string> subjects;
  std::vector<std::string> patterns;
  for (const std::string a : {"a", "b", "*", ">"})
    for (const std::string b : {"", ".a", ".b", ".*", ".>"})
      for (const std::string c : {"", ".a", ".*", ".>"}) {
        const std::string text = a + b + (b.empty() ? "" : c);
        const auto tail = text.find('>');
        if (tail == std::string::npos || tail + 1 == text.size()) patterns.push_back(text);
        if (text.find_first_of("*>") == std::string::npos) subjects.push_back(text);
      }
  for (const std::string& pattern : patterns) {
    std::string expression;
    for (const char c : pattern)
      expression += c == '.' ? "\\." : c == '*' ? "[^.]+" : c == '>' ? ".+" : std::string(1, c);
    for (const std::string& subject : subjects)
      EXPECT_EQ(Covers(pattern, subject), std::regex_match(subject, std::regex(expression)))
          << pattern << " " << subject;
  }
}

TEST_F(NatsParts, NamesThatTheServerWouldMisreadAreRefused) {
  EXPECT_EQ(CheckSubject("fleet.r-7.lidar.front_2"), "");
  for (const char* bad : {"", ".a", "a.", "a..b", "a b", "a.*", "a.>", "a\r\nPUB", "$JS.API",
                          "_INBOX.x", "gr\xc3\xbc"})
    EXPECT_NE(CheckSubject(bad), "") << bad;
  EXPECT_NE(CheckSubject(std::string(300, 'a')), "");
  EXPECT_EQ(CheckSubject(std::string(200, 'a')), "");
  EXPECT_NE(CheckSubject(std::string(201, 'a')), "");
  EXPECT_EQ(CheckName("black-box_2"), "");
  EXPECT_EQ(CheckName(std::string(64, 'a')), "");
  EXPECT_NE(CheckName(std::string(65, 'a')), "");
  EXPECT_EQ(CheckName("azAZ09"), "");
  for (const char* bad : {"a.b", "a b", "a*", "a/b", "a>", "a:", "a@", "a[", "a`", "a{"})
    EXPECT_NE(CheckName(bad), "") << bad;
}

TEST_F(NatsParts, AnswersAreKnownByTheirWords) {
  const auto subjects = AnswerSubjects::Make();
  ASSERT_TRUE(subjects);
  const auto word_of = [&](const std::string& subject) {
    natsMsg* raw = nullptr;
    EXPECT_EQ(natsMsg_Create(&raw, subject.c_str(), nullptr, "", 0), NATS_OK);
    const MessagePtr answer(raw);
    return std::string(subjects->WordOf(raw));
  };
  EXPECT_EQ(ToNumber(word_of(subjects->Of(17))), 17U);
  EXPECT_EQ(word_of(subjects->Of("config")), "config");
  EXPECT_EQ(word_of(AnswerSubjects::Make()->Of(17)), "") << "of somebody else";
  EXPECT_EQ(word_of("17"), "");
  EXPECT_TRUE(Covers(subjects->All(), subjects->Of(17)));
  for (const char* text : {"", "-1", "1x", " 1", "99999999999999999999"})
    EXPECT_FALSE(ToNumber(text)) << text;
}

TEST_F(NatsParts, AnAnswerOfJetStreamNamesItsStreamOrIsAnError) {
  const auto error_of = [](const std::string& text) {
    natsMsg* raw = nullptr;
    EXPECT_EQ(natsMsg_Create(&raw, "a", nullptr, text.data(), static_cast<int>(text.size())),
              NATS_OK);
    const MessagePtr answer(raw);
    return ErrorOfAck(raw);
  };
  EXPECT_EQ(error_of(R"({"stream":"s","seq":1})"), "");
  for (const char* bad : {"", "{}", R"({"error":{"code":503}})", R"({"stream":"s","error":{}})"})
    EXPECT_EQ(error_of(bad), std::string("JetStream refused a message: ") + bad);
  EXPECT_EQ(error_of(std::string(300, 'x')).size(), 200 + error_of("").size());
}

TEST_F(NatsParts, OnlyMessagesThatAreKeptHaveAnId) {
  const gst::BufferPtr buffer = Bytes(10);
  for (const char* reply : {static_cast<const char*>(nullptr), "answers.17"}) {
    const MessagePtr message = WriteMessage("a.b", reply, kId, {1, 17}, buffer.get());
    const char* id = nullptr;
    const natsStatus found = natsMsgHeader_Get(message.get(), "Nats-Msg-Id", &id);
    EXPECT_EQ(found == NATS_OK, reply != nullptr);
    if (found == NATS_OK) {
      EXPECT_EQ(id, PlaceText({1, 17}));
    }
  }
}

TEST(NatsUrls, AreShownWithoutTheirUsers) {
  EXPECT_EQ(WithoutUser("nats://host:4222"), "nats://host:4222");
  EXPECT_EQ(WithoutUser("nats://me:p@ss@host:4222,tls://you@other"),
            "nats://host:4222, tls://other");
  EXPECT_EQ(WithoutUser("me:secret@host"), "host");
}

/// A fixture with a ConnectionWatch. The watch posts changes and errors of a connection on the bus
/// of its element.
class NatsWatch : public NatsParts {
 protected:
  void Make(bool keeps_trying) {
    element_.reset(GST_ELEMENT(gst_object_ref_sink(gst_bin_new("n"))));
    bus_.emplace(element_.get());
    watch_.emplace(element_.get(), keeps_trying);
  }
  /// Passes `state_` to the watch, and returns the messages that the watch posts.
  std::string Posted() {
    watch_->Note(state_);
    std::string posted;
    while (const gst::MessagePtr message = bus_->Pop()) {
      if (!posted.empty()) posted += " ";
      const bool is_state = GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_ELEMENT;
      gboolean connected = FALSE;
      if (is_state)
        gst_structure_get_boolean(gst_message_get_structure(message.get()), "connected",
                                  &connected);
      posted += is_state ? (connected ? "here" : "away")
                         : std::string(GST_MESSAGE_TYPE_NAME(message.get())) + ": " +
                               test::MessageText(message.get());
    }
    return posted;
  }
  std::string Complains(const std::string& text) {
    ++state_.errors;
    state_.last_error = text;
    return Posted();
  }
  static std::string Complaint(const std::string& text) {
    return "warning: The NATS server reports an error: " + text + ".";
  }

  gst::ElementPtr element_;
  std::optional<test::ElementBus> bus_;
  std::optional<gst::ConnectionWatch> watch_;
  ConnectionState state_;
};

TEST_F(NatsWatch, TellsOfEachChangeOnce) {
  Make(false);
  EXPECT_EQ(Posted(), "");
  for (int round = 0; round < 2; ++round) {
    ++state_.connections;
    EXPECT_EQ(Posted(), "here");
    EXPECT_EQ(Posted(), "");
    ++state_.disconnections;
    EXPECT_EQ(Posted(), "away");
    EXPECT_EQ(Posted(), "");
  }
}

TEST_F(NatsWatch, TellsOfEachComplaintOnceInAConnection) {
  Make(false);
  for (int round = 0; round < 2; ++round) {
    ++state_.connections;
    EXPECT_EQ(Posted(), "here");
    EXPECT_EQ(Complains("one"), Complaint("one"));
    EXPECT_EQ(Posted(), "");
    EXPECT_EQ(Complains("another"), Complaint("another"));
    EXPECT_EQ(Complains("one"), "");
    ++state_.disconnections;
    EXPECT_EQ(Posted(), "away");
  }
}

TEST_F(NatsWatch, TellsOfSoManyComplaintsOnlyAndThoseInUtf8) {
  Make(false);
  ++state_.connections;
  Posted();
  int told = 0;
  for (int i = 0; i < 100; ++i)
    if (!Complains("of subject " + std::to_string(i)).empty()) ++told;
  EXPECT_EQ(told, 8);
  ++state_.connections;
  ++state_.disconnections;
  EXPECT_EQ(Complains("new"), "") << "it is the same connection still";
  ++state_.disconnections;
  Posted();
  EXPECT_EQ(Complains("\xff"), Complaint("\xef\xbf\xbd"));
}

TEST_F(NatsWatch, TellsOfARefusalAsAnErrorOrOfEachAsAWarning) {
  for (const bool keeps_trying : {false, true}) {
    Make(keeps_trying);
    state_ = {};
    state_.last_error = "Authorization Violation";
    state_.closed = state_.unanswered = true;
    EXPECT_EQ(Posted(), "") << "no server has answered";
    state_.unanswered = false;
    EXPECT_EQ(Posted(),
              keeps_trying
                  ? "warning: The NATS server refused the connection: Authorization Violation; "
                    "the element keeps trying."
                  : "error: The NATS server refused the connection: Authorization Violation.");
    EXPECT_EQ(Posted(), "");
    if (!keeps_trying) continue;
    state_ = {};  // the state of the next connection
    state_.connections = 1;
    EXPECT_EQ(Posted(), "here");
    state_.closed = true;
    state_.last_error = "Permissions";
    EXPECT_EQ(Posted(),
              "away warning: The NATS server refused the connection: Permissions; the element "
              "keeps trying.");
  }
}

TEST_F(NatsWatch, TellsNothingOnceItIsSilent) {
  Make(true);
  watch_->Silence();
  ++state_.connections;
  EXPECT_EQ(Complains("one"), "");
  state_.closed = true;
  EXPECT_EQ(Posted(), "");
  watch_->Warn("something");
  EXPECT_EQ(bus_->Pop(), nullptr);
}

TEST(SourceAccount, CountsWhatIsMissingUntilItComes) {
  SourceAccount account;
  EXPECT_FALSE(account.NotePlace({1, 5}, false).gap);
  EXPECT_TRUE(account.NotePlace({1, 8}, false).gap);
  EXPECT_EQ(account.counters().lost, 2U);
  EXPECT_FALSE(account.NotePlace({1, 6}, false).gap);
  EXPECT_TRUE(account.NotePlace({1, 8}, false).again);
  EXPECT_EQ(account.counters().lost, 1U);
  EXPECT_EQ(account.counters().late, 1U);
  EXPECT_EQ(account.counters().again, 1U);
  account.Reset();
  account.NotePlace({1, 5}, true);
  EXPECT_FALSE(account.NotePlace({1, 8}, true).gap) << "others of the group have those between";
  EXPECT_EQ(account.counters().lost, 0U);
}

}  // namespace
}  // namespace lidar::nats
