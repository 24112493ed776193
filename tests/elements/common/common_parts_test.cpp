// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of the parts of gst/common that several plugins use: seeks, certificates, covariances, and
// histories.
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "gst/common/certificates.h"
#include "gst/common/coordinate_frames.h"
#include "gst/common/history_query.h"
#include "gst/common/packet_probe.h"
#include "gst/common/pose_covariance.h"
#include "gst/common/refs.h"
#include "gst/common/seek_range.h"
#include "gst/common/structure_json.h"
#include "tests/support/test_certificates.h"

namespace lidar::gst {
namespace {

constexpr auto kSecond = static_cast<gint64>(GST_SECOND);

/// Returns a segment of 10 s whose position is 3 s.
GstSegment Played() {
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  segment.duration = segment.stop = 10 * GST_SECOND;
  segment.position = 3 * GST_SECOND;
  return segment;
}

struct AskedSeek {
  GstSeekType start_type;
  gint64 start;
  GstSeekType stop_type;
  gint64 stop;
};

bool Apply(const AskedSeek& asked, GstSegment* segment) {
  const EventPtr event(gst_event_new_seek(1, GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, asked.start_type,
                                          asked.start, asked.stop_type, asked.stop));
  return ApplySeek(event.get(), segment);
}

constexpr AskedSeek FromStart(gint64 start) {
  return {GST_SEEK_TYPE_SET, start, GST_SEEK_TYPE_NONE, 0};
}
constexpr AskedSeek FromEnd(gint64 start) {
  return {GST_SEEK_TYPE_END, start, GST_SEEK_TYPE_NONE, 0};
}

TEST(Seeks, BeginWhereTheyAreAskedToWithinTheDuration) {
  for (const auto& [asked, start] :
       {std::pair(FromStart(4 * kSecond), 4 * kSecond), std::pair(FromStart(-1), gint64{0}),
        std::pair(FromEnd(-4 * kSecond), 6 * kSecond), std::pair(FromEnd(0), 10 * kSecond),
        std::pair(FromEnd(5 * kSecond), 10 * kSecond), std::pair(FromEnd(-10 * kSecond), gint64{0}),
        std::pair(FromEnd(-20 * kSecond), gint64{0})}) {
    GstSegment segment = Played();
    EXPECT_TRUE(Apply(asked, &segment)) << asked.start;
    EXPECT_EQ(segment.start, static_cast<GstClockTime>(start)) << asked.start;
    EXPECT_EQ(segment.position, segment.start) << asked.start;
    EXPECT_EQ(segment.stop, 10 * GST_SECOND) << asked.start;
  }
}

TEST(Seeks, EndWhereTheyAreAskedTo) {
  GstSegment segment = Played();
  EXPECT_TRUE(Apply({GST_SEEK_TYPE_SET, kSecond, GST_SEEK_TYPE_END, -2 * kSecond}, &segment));
  EXPECT_EQ(segment.start, GST_SECOND);
  EXPECT_EQ(segment.stop, 8 * GST_SECOND);
  EXPECT_TRUE(Apply({GST_SEEK_TYPE_NONE, 0, GST_SEEK_TYPE_SET, 5 * kSecond}, &segment));
  EXPECT_EQ(segment.position, GST_SECOND);
  EXPECT_EQ(segment.stop, 5 * GST_SECOND);
}

TEST(Seeks, OfAnEmptyRangeOrFromAnUnknownEndChangeNothing) {
  GstSegment endless = Played();
  endless.duration = GST_CLOCK_TIME_NONE;
  for (const auto& [before, asked] :
       {std::pair(Played(), AskedSeek{GST_SEEK_TYPE_SET, 5 * kSecond, GST_SEEK_TYPE_SET, kSecond}),
        std::pair(Played(), AskedSeek{GST_SEEK_TYPE_NONE, 0, GST_SEEK_TYPE_SET, kSecond}),
        std::pair(Played(), FromStart(11 * kSecond)), std::pair(endless, FromEnd(-kSecond))}) {
    GstSegment segment = before;
    EXPECT_FALSE(Apply(asked, &segment)) << asked.start;
    EXPECT_TRUE(gst_segment_is_equal(&segment, &before)) << asked.start;
  }
}

TEST(Seeks, WithoutAStartGoOnFromThePlaceThatPlaybackReached) {
  GstSegment segment = Played();
  segment.start = GST_SECOND;
  for (const auto& [end, position] : {std::pair(5U, 5U), std::pair(2U, 5U), std::pair(20U, 10U)}) {
    GoOnFrom(end * GST_SECOND, &segment);
    EXPECT_EQ(segment.position, position * GST_SECOND);
    EXPECT_EQ(segment.offset, (position - 1) * GST_SECOND);
  }
}

TEST(Certificates, AreReadFromOnesOwnFileWithItsKeyAndThePeersWithout) {
  const test::TestCertificates files({"robot", "base"});
  Certificates read;
  std::string error;
  ASSERT_TRUE(ReadCertificates(files.WithKey("robot"), files.Public("base"), &read, &error))
      << error;
  EXPECT_EQ(read.own, test::ReadFile(files.WithKey("robot")));
  EXPECT_EQ(read.peer, CertificateIn(test::ReadFile(files.WithKey("base"))));
  EXPECT_NE(read.peer, CertificateIn(read.own));
  EXPECT_EQ(read.peer.find_first_of(" \n"), std::string::npos);
}

TEST(Certificates, AreRefusedWithTheFileThatIsWrong) {
  const test::TestCertificates files({"robot"});
  const std::string own = files.WithKey("robot");
  const std::string peer = files.Public("robot");
  const std::string other = peer + ".txt";
  std::ofstream(other) << "no certificate";
  const auto why = [](const std::string& with_key, const std::string& without) {
    Certificates read;
    std::string error;
    EXPECT_FALSE(ReadCertificates(with_key, without, &read, &error));
    return error;
  };
  EXPECT_EQ(why(peer, peer), peer + " must be a PEM file with a certificate and its private key");
  EXPECT_EQ(why(other, peer), other + " must be a PEM file with a certificate and its private key");
  EXPECT_EQ(why(own, other), other + " must be a PEM file with a certificate");
  EXPECT_NE(why(own + ".none", peer).find(own + ".none"), std::string::npos);
  EXPECT_NE(why(own, peer + ".none").find(peer + ".none"), std::string::npos);
  EXPECT_EQ(CertificateIn("-----END CERTIFICATE----------BEGIN CERTIFICATE-----"), "");
}

TEST(Covariances, CarryTheTrackingToRosAndBack) {
  Covariance measured{};
  for (std::size_t i = 0; i < measured.size(); ++i) measured[i] = 0.01 * static_cast<double>(i + 1);
  for (const auto tracking :
       {GST_LIDAR_TRACKING_OK, GST_LIDAR_TRACKING_DEGENERATE, GST_LIDAR_TRACKING_LOST}) {
    const Covariance sent = CovarianceOf(tracking, measured);
    EXPECT_EQ(TrackingOf(sent), tracking);
    EXPECT_EQ(sent == measured, tracking == GST_LIDAR_TRACKING_OK);
    if (tracking == GST_LIDAR_TRACKING_OK) continue;
    for (std::size_t i = 0; i < sent.size(); ++i)
      EXPECT_EQ(sent[i], i % 7 == 0 ? sent[0] : 0) << i << ": each variance, and no more";
  }
  EXPECT_EQ(TrackingOf(CovarianceOf(99, measured)), GST_LIDAR_TRACKING_LOST);
  EXPECT_EQ(TrackingOf({}), GST_LIDAR_TRACKING_OK);
  EXPECT_EQ(NoVelocity(), CovarianceOf(GST_LIDAR_TRACKING_LOST));
}

/// Drops buffers of 3 bytes, and replaces others by buffers that are one byte longer.
GstPadProbeReturn ChangePackets(GstPad*, GstPadProbeInfo* info, gpointer) {
  return MapPackets(info, [](BufferPtr packet) {
    const gsize size = gst_buffer_get_size(packet.get());
    return BufferPtr(size == 3 ? nullptr : gst_buffer_new_allocate(nullptr, size + 1, nullptr));
  });
}

TEST(PacketProbes, ReplaceOrDropEachPacketAloneOrInAList) {
  const auto new_pad = [](const char* name, GstPadDirection direction) {
    return PadPtr(GST_PAD(gst_object_ref_sink(gst_pad_new(name, direction))));
  };
  const PadPtr src = new_pad("src", GST_PAD_SRC);
  const PadPtr sink = new_pad("sink", GST_PAD_SINK);
  std::vector<gsize> sizes;
  gst_pad_set_element_private(sink.get(), &sizes);
  gst_pad_set_chain_function(sink.get(), [](GstPad* pad, GstObject*, GstBuffer* buffer) {
    static_cast<std::vector<gsize>*>(gst_pad_get_element_private(pad))
        ->push_back(gst_buffer_get_size(buffer));
    gst_buffer_unref(buffer);
    return GST_FLOW_OK;
  });
  ASSERT_EQ(gst_pad_link(src.get(), sink.get()), GST_PAD_LINK_OK);
  for (GstPad* pad : {sink.get(), src.get()}) gst_pad_set_active(pad, TRUE);
  gst_pad_add_probe(src.get(), kPacketProbe, ChangePackets, nullptr, nullptr);
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  gst_pad_push_event(src.get(), gst_event_new_stream_start("packets"));
  gst_pad_push_event(src.get(), gst_event_new_segment(&segment));
  const auto push_list = [&](const std::vector<gsize>& list_sizes) {
    GstBufferList* list = gst_buffer_list_new();
    for (const gsize size : list_sizes)
      gst_buffer_list_add(list, gst_buffer_new_allocate(nullptr, size, nullptr));
    EXPECT_EQ(gst_pad_push_list(src.get(), list), GST_FLOW_OK);
    return std::exchange(sizes, {});
  };
  using Sizes = std::vector<gsize>;
  for (const gsize size : {2U, 3U, 5U})
    EXPECT_EQ(gst_pad_push(src.get(), gst_buffer_new_allocate(nullptr, size, nullptr)),
              GST_FLOW_OK);
  EXPECT_EQ(std::exchange(sizes, {}), (Sizes{3, 6}));
  EXPECT_EQ(push_list({2, 3, 5, 3}), (Sizes{3, 6}));
  EXPECT_EQ(push_list({3, 3}), Sizes{});
  for (GstPad* pad : {src.get(), sink.get()}) gst_pad_set_active(pad, FALSE);
}

TEST(Frames, AreThoseOfTheCapsOrTheUsualOnes) {
  const StructurePtr caps(
      gst_structure_new("x/y", GST_LIDAR_FRAME_ID, G_TYPE_STRING, "roof", nullptr));
  EXPECT_EQ(FrameIn(caps.get(), GST_LIDAR_FRAME_ID, kCloudFrame), "roof");
  EXPECT_EQ(FrameIn(caps.get(), GST_LIDAR_CHILD_FRAME_ID, kCloudFrame), "lidar");
  EXPECT_EQ(FrameIn(caps.get(), GST_LIDAR_CHILD_FRAME_ID), "");
}

TEST(StructuresAsJson, HaveTheNumbersTextsAndStructuresOfTheirFields) {
  const StructurePtr inner(gst_structure_new("inner", "a-b", G_TYPE_UINT, 4'000'000'000U, nullptr));
  const StructurePtr outer(gst_structure_new(
      "outer", "int", G_TYPE_INT, -5, "uint", G_TYPE_UINT, G_MAXUINT, "int64", G_TYPE_INT64,
      G_MININT64, "uint64", G_TYPE_UINT64, G_MAXUINT64, "double", G_TYPE_DOUBLE, 0.25, "yes",
      G_TYPE_BOOLEAN, TRUE, "no", G_TYPE_BOOLEAN, FALSE, "text", G_TYPE_STRING, "a \"b\"", "none",
      G_TYPE_STRING, nullptr, "rate", GST_TYPE_FRACTION, 10, 1, "inner", GST_TYPE_STRUCTURE,
      inner.get(), nullptr));
  for (const bool is_list : {false, true}) {
    GValue numbers = G_VALUE_INIT;
    is_list ? gst_value_list_init(&numbers, 2) : gst_value_array_init(&numbers, 2);
    for (const guint number : {1U, G_MAXUINT}) {
      GValue value = G_VALUE_INIT;
      g_value_init(&value, G_TYPE_UINT);
      g_value_set_uint(&value, number);
      is_list ? gst_value_list_append_and_take_value(&numbers, &value)
              : gst_value_array_append_and_take_value(&numbers, &value);
    }
    gst_structure_take_value(outer.get(), is_list ? "list" : "array", &numbers);
  }
  nlohmann::json wanted = {{"int", -5},
                           {"uint", G_MAXUINT},
                           {"int64", G_MININT64},
                           {"uint64", G_MAXUINT64},
                           {"double", 0.25},
                           {"yes", true},
                           {"no", false},
                           {"text", "a \"b\""},
                           {"none", ""},
                           {"rate", "10/1"},
                           {"array", {1U, G_MAXUINT}},
                           {"list", {1U, G_MAXUINT}},
                           {"inner", {{"a-b", 4'000'000'000U}}}};
  EXPECT_EQ(ToJson(outer.get(), FieldNames::kAsTheyAre), wanted);
  wanted["inner"] = {{"a_b", 4'000'000'000U}};
  EXPECT_EQ(ToJson(outer.get(), FieldNames::kWithoutDashes), wanted);
  EXPECT_EQ(ToJson(static_cast<const GstStructure*>(nullptr), FieldNames::kAsTheyAre),
            nlohmann::json::object());
}

TEST(StructuresAsJson, AreNullForElementsWithoutStatistics) {
  EXPECT_TRUE(StatsAsJson(nullptr, FieldNames::kAsTheyAre).is_null());
  const ElementPtr plain(GST_ELEMENT(gst_object_ref_sink(gst_pipeline_new("plain"))));
  EXPECT_TRUE(StatsAsJson(plain.get(), FieldNames::kAsTheyAre).is_null());
}

TEST(Histories, AreAskedForAndAnsweredInOneQuery) {
  const QueryPtr query = NewHistoryQuery({7, 11, 13});
  const auto question = ParseHistoryQuestion(query.get());
  ASSERT_TRUE(question);
  EXPECT_EQ(question->time, 7U);
  EXPECT_EQ(question->position, 11U);
  EXPECT_EQ(question->most_bytes, 13U);
  for (const bool ended : {false, true}) {
    HistoryAnswer answer;
    answer.from = 100;
    answer.to = 200;
    answer.position = 300;
    answer.ended = ended;
    answer.damaged = 400;
    answer.unanswered = !ended;
    for (int i = 0; i < 2; ++i) {
      const BufferPtr buffer(gst_buffer_new());
      answer.samples.emplace_back(gst_sample_new(buffer.get(), nullptr, nullptr, nullptr));
    }
    SetHistoryAnswer(query.get(), answer);
    const HistoryAnswer read = ParseHistoryAnswer(query.get());
    EXPECT_EQ(read.from, 100U);
    EXPECT_EQ(read.to, 200U);
    EXPECT_EQ(read.position, 300U);
    EXPECT_EQ(read.ended, ended);
    EXPECT_EQ(read.damaged, 400U);
    EXPECT_EQ(read.unanswered, !ended);
    ASSERT_EQ(read.samples.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i)
      EXPECT_EQ(gst_sample_get_buffer(read.samples[i].get()),
                gst_sample_get_buffer(answer.samples[i].get()));
  }
}

TEST(Histories, ThatWereNotAnsweredAreEmptyAndOtherQueriesAskForNone) {
  const QueryPtr query = NewHistoryQuery({});
  const auto question = ParseHistoryQuestion(query.get());
  ASSERT_TRUE(question);
  EXPECT_EQ(question->time, GST_CLOCK_TIME_NONE);
  const HistoryAnswer read = ParseHistoryAnswer(query.get());
  EXPECT_TRUE(read.ended);
  EXPECT_FALSE(read.unanswered);
  EXPECT_TRUE(read.samples.empty());
  EXPECT_EQ(read.from + read.to + read.damaged, 0U);
  for (GstQuery* other :
       {gst_query_new_latency(),
        gst_query_new_custom(GST_QUERY_CUSTOM, gst_structure_new_empty("other"))}) {
    EXPECT_FALSE(ParseHistoryQuestion(other));
    gst_query_unref(other);
  }
}

}  // namespace
}  // namespace lidar::gst
