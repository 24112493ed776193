// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of stream configs that change, and of configs for which this project has no decoder.
#include <gtest/gtest.h>

#include <algorithm>

#include "src/rtp/packetizer.h"
#include "src/rtp/stream_config.h"
#include "tests/elements/rtplidar/slices.h"
#include "tests/support/element_bus.h"

namespace lidar::test {
namespace {

GstBuffer* RtpOf(const std::vector<std::uint8_t>& payload, guint32 ssrc, guint16 sequence) {
  GstBuffer* buffer = gst_rtp_buffer_new_allocate(static_cast<guint>(payload.size()), 0, 0);
  GstRTPBuffer rtp = GST_RTP_BUFFER_INIT;
  gst_rtp_buffer_map(buffer, GST_MAP_WRITE, &rtp);
  gst_rtp_buffer_set_payload_type(&rtp, 96);
  gst_rtp_buffer_set_ssrc(&rtp, ssrc);
  gst_rtp_buffer_set_seq(&rtp, sequence);
  std::copy(payload.begin(), payload.end(), static_cast<guint8*>(gst_rtp_buffer_get_payload(&rtp)));
  gst_rtp_buffer_unmap(&rtp);
  return buffer;
}

/// Returns an RTP payload that consists of one unit.
std::vector<std::uint8_t> PayloadOf(const rtp::Unit& unit, const std::vector<std::uint8_t>& bytes) {
  auto payload = rtp::Packetize(unit, {bytes.data(), bytes.size()}, 1'400).at(0).header;
  payload.insert(payload.end(), bytes.begin(), bytes.end());
  return payload;
}

std::vector<std::uint8_t> ConfigPayload(const char* fields, std::uint8_t* id) {
  rtp::StreamConfig config;
  config.fields = fields;
  const auto bytes = config.Serialise();
  rtp::Unit unit;
  unit.unit = rtp::UnitType::kStreamConfig;
  unit.config_id = rtp::ConfigId(bytes, std::nullopt);
  *id = unit.config_id;
  return PayloadOf(unit, bytes);
}

/// Returns a packet with a config for `fields`. Its sequence number is the one before that of
/// `next`.
GstBuffer* ConfigBefore(GstBuffer* next, const char* fields) {
  std::uint8_t id = 0;
  GstRTPBuffer rtp = GST_RTP_BUFFER_INIT;
  gst_rtp_buffer_map(next, GST_MAP_READ, &rtp);
  GstBuffer* buffer = RtpOf(ConfigPayload(fields, &id), gst_rtp_buffer_get_ssrc(&rtp),
                            static_cast<guint16>(gst_rtp_buffer_get_seq(&rtp) - 1));
  gst_rtp_buffer_unmap(&rtp);
  return buffer;
}

/// Notes, for each buffer that leaves the pad, the fields in the pad's caps.
GstPadProbeReturn NoteFields(GstPad* pad, GstPadProbeInfo* info, gpointer data) {
  const guint buffers = (info->type & GST_PAD_PROBE_TYPE_BUFFER_LIST) != 0
                            ? gst_buffer_list_length(GST_PAD_PROBE_INFO_BUFFER_LIST(info))
                            : 1;
  const gst::CapsPtr caps(gst_pad_get_current_caps(pad));
  const char* fields = gst_structure_get_string(gst_caps_get_structure(caps.get(), 0), "fields");
  static_cast<std::vector<std::string>*>(data)->insert(
      static_cast<std::vector<std::string>*>(data)->end(), buffers, fields);
  return GST_PAD_PROBE_OK;
}

TEST(RtpLidarDepay, SlicesOfTwoConfigsInOnePacketLeaveEachUnderItsCaps) {
  const std::vector<std::string> fields = {"x:F32:0,y:F32:4,z:F32:8",
                                           "x:F32:0,y:F32:4,z:F32:8,range:U32:12"};
  const Harness h = Depay();
  std::vector<std::string> seen;
  const gst::PadPtr src(gst_element_get_static_pad(h->element, "src"));
  gst_pad_add_probe(
      src.get(),
      static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_BUFFER_LIST),
      NoteFields, &seen, nullptr);
  std::vector<std::uint8_t> packet = {0x20};  // payload of an aggregate
  for (std::uint16_t i = 0; i < 2; ++i) {
    rtp::Unit unit;
    gst_harness_push(h.get(), RtpOf(ConfigPayload(fields[i].c_str(), &unit.config_id), 7, i));
    unit.slice = {1, i, 2};
    const auto slice = PayloadOf(unit, {1, 2, 3});
    packet.insert(packet.end(), {0, 0, 0, static_cast<std::uint8_t>(slice.size())});
    packet.insert(packet.end(), slice.begin(), slice.end());
  }
  ASSERT_EQ(gst_harness_push(h.get(), RtpOf(packet, 7, 2)), GST_FLOW_OK);
  EXPECT_EQ(seen, fields);
}

/// Returns an aggregate of `slices` slices. Their configs alternate between `ids`, which are ids of
/// configs that were sent before.
std::vector<std::uint8_t> TakingTurns(const std::vector<std::uint8_t>& ids, std::uint32_t scan,
                                      std::uint16_t slices) {
  std::vector<std::uint8_t> packet = {0x20};
  for (std::uint16_t i = 0; i < slices; ++i) {
    rtp::Unit unit;
    unit.config_id = ids[i % ids.size()];
    unit.slice = {scan, i, slices};
    const auto slice = PayloadOf(unit, {1, 2, 3});
    packet.insert(packet.end(), {0, 0, 0, static_cast<std::uint8_t>(slice.size())});
    packet.insert(packet.end(), slice.begin(), slice.end());
  }
  return packet;
}

TEST(RtpLidarDepay, ChangesCapsNoMoreThanOnceASecondForAStreamThatTakesTurns) {
  const Harness h = Depay();
  std::vector<std::uint8_t> ids(2);
  const char* fields[] = {"x:F32:0,y:F32:4,z:F32:8", "x:F32:0,y:F32:4,z:F32:8,range:U32:12"};
  std::uint16_t sequence = 0;
  for (std::size_t i = 0; i < ids.size(); ++i)
    gst_harness_push(h.get(), RtpOf(ConfigPayload(fields[i], &ids[i]), 7, sequence++));
  guint64 changes = 0;
  std::size_t pushed = 0;
  std::size_t behind_dropped = 0;
  for (std::uint32_t scan = 0; scan < 100; ++scan) {  // 10 s of scans
    GstBuffer* packet = RtpOf(TakingTurns(ids, scan, 32), 7, sequence++);
    GST_BUFFER_PTS(packet) = scan * 100 * GST_MSECOND;
    ASSERT_EQ(gst_harness_push(h.get(), packet), GST_FLOW_OK);
    for (const auto& slice : Pull(h.get())) {
      ++pushed;
      behind_dropped += GST_BUFFER_IS_DISCONT(slice.get()) ? 1U : 0U;
    }
    while (const gst::EventPtr event{gst_harness_try_pull_event(h.get())})
      changes += GST_EVENT_TYPE(event.get()) == GST_EVENT_CAPS ? 1U : 0U;
  }
  EXPECT_GE(changes, 8U);
  EXPECT_LE(changes, 18U) << "8 at once, then one a second";
  EXPECT_GE(pushed, 1'600U) << "the slices of one format pass";
  EXPECT_GE(behind_dropped, 1'500U) << "each comes behind one of the other format";
  EXPECT_EQ(pushed + Stat(h.get(), "slices-changing-format"), 3'200U) << "each is counted";
}

TEST(RtpLidarDepay, TellsInEachRunAnewOfAStreamThatTakesTurns) {
  const Harness h = Depay();
  const ElementBus bus(h->element);
  std::vector<std::uint8_t> ids(2);
  const char* fields[] = {"x:F32:0,y:F32:4,z:F32:8", "x:F32:0,y:F32:4,z:F32:8,range:U32:12"};
  for (int run = 0; run < 2; ++run) {
    std::uint16_t sequence = 0;
    for (std::size_t i = 0; i < ids.size(); ++i)
      gst_harness_push(h.get(), RtpOf(ConfigPayload(fields[i], &ids[i]), 7, sequence++));
    for (std::uint32_t scan = 0; scan < 2; ++scan)
      gst_harness_push(h.get(), RtpOf(TakingTurns(ids, scan, 32), 7, sequence++));
    const std::size_t pushed = Pull(h.get()).size();
    EXPECT_GE(pushed, 8U) << run;
    EXPECT_EQ(pushed + Stat(h.get(), "slices-changing-format"), 64U) << run;
    EXPECT_TRUE(bus.Pop(GST_MESSAGE_WARNING)) << run;
    EXPECT_FALSE(bus.Pop(GST_MESSAGE_WARNING)) << run;
    gst_element_set_state(h->element, GST_STATE_READY);
    gst_element_set_state(h->element, GST_STATE_PLAYING);
    EXPECT_EQ(Stat(h.get(), "slices-changing-format"), 0U) << run;
    gst_harness_push_event(h.get(), gst_event_new_stream_start("again"));
    gst_harness_set_src_caps_str(h.get(), kRtpCaps);
  }
}

TEST(RtpLidarDepay, DropsSlicesForAnotherDecoderAndGoesOn) {
  Harness pay(gst_harness_new("rtplidarpay"));
  const Harness h(gst_harness_new("rtplidardepay"));
  gst_harness_set_sink_caps_str(h.get(), GST_LIDAR_SLICE_MEDIA_TYPE);
  gst_harness_set_src_caps_str(h.get(), kRtpCaps);
  const ElementBus bus(h->element);
  guint scan = 0;
  for (const char* type : {GST_LIDAR_DRACO_MEDIA_TYPE, GST_LIDAR_SLICE_MEDIA_TYPE,
                           GST_LIDAR_DRACO_MEDIA_TYPE, GST_LIDAR_SLICE_MEDIA_TYPE}) {
    gst_harness_set_src_caps_str(pay.get(), EncodedCaps("range", 10, type).c_str());
    for (guint i = 0; i < kSlices; ++i) gst_harness_push(pay.get(), EncodedSlice(scan, i));
    while (GstBuffer* b = gst_harness_try_pull(pay.get()))
      EXPECT_EQ(gst_harness_push(h.get(), b), GST_FLOW_OK);
    const auto slices = Pull(h.get());
    EXPECT_EQ(slices.size(), scan++ % 2 == 0 ? 0U : kSlices);
    for (std::size_t i = 0; i < slices.size(); ++i)
      EXPECT_EQ(GST_BUFFER_FLAG_IS_SET(slices[i].get(), GST_BUFFER_FLAG_DISCONT), i == 0)
          << "behind the slices that were dropped";
  }
  EXPECT_EQ(Stat(h.get(), "slices-not-accepted"), 2 * kSlices);
  unsigned warnings = 0;
  while (const gst::MessagePtr message = bus.Pop())
    warnings += GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_WARNING ? 1U : 0U;
  EXPECT_EQ(warnings, 1U);
}

/// A flush begins while the element offers its caps, which the next element refuses. During a
/// flush, a refusal must not cause a warning.
TEST(RtpLidarDepay, WarnsOfNoDecoderWhereAFlushBegins) {
  const Harness h(gst_harness_new("rtplidardepay"));
  gst_harness_set_sink_caps_str(h.get(), "application/x-other");
  gst_harness_set_src_caps_str(h.get(), kRtpCaps);
  const ElementBus bus(h->element);
  const gst::PadPtr src(gst_element_get_static_pad(h->element, "src"));
  gst_pad_add_probe(
      src.get(), GST_PAD_PROBE_TYPE_QUERY_DOWNSTREAM,
      [](GstPad*, GstPadProbeInfo* info, gpointer harness) -> GstPadProbeReturn {
        if (GST_QUERY_TYPE(GST_PAD_PROBE_INFO_QUERY(info)) == GST_QUERY_ACCEPT_CAPS)
          gst_harness_push_event(static_cast<GstHarness*>(harness), gst_event_new_flush_start());
        return GST_PAD_PROBE_OK;
      },
      h.get(), nullptr);
  for (const auto& packet : Packets(1))
    gst_harness_push(h.get(), gst_buffer_copy_deep(packet.get()));
  EXPECT_EQ(Stat(h.get(), "slices-not-accepted"), 1U);
  EXPECT_FALSE(bus.Pop(GST_MESSAGE_WARNING));
}

constexpr const char* kVoxels =
    "application/x-voxels, alignment=(string)slice, "
    "fields=(string)\"x:F32:0\\,y:F32:4\\,z:F32:8\", "
    "framerate=(fraction)10/1, sensor-model=(buffer)0102ff, levels=(uint)7, loss=(double)0.25, "
    "dense=(boolean)true";

/// Returns the packets of `scans` scans. No plugin of this project has a decoder for them.
std::vector<gst::BufferPtr> PacketsOfVoxels(guint scans) {
  Harness pay(gst_harness_new("rtplidarpay"));
  gst_harness_set_src_caps_str(pay.get(), kVoxels);
  for (guint s = 0; s < scans; ++s)
    for (guint i = 0; i < kSlices; ++i)
      EXPECT_EQ(gst_harness_push(pay.get(), EncodedSlice(s, i)), GST_FLOW_OK);
  return Pull(pay.get());
}

TEST(RtpLidarDepay, SlicesOfACoderThatNobodyHereKnowsComeWithTheirCaps) {
  const Harness h = Depay();
  Push(h.get(), PacketsOfVoxels(2));
  const auto slices = Pull(h.get());
  ASSERT_EQ(slices.size(), 2 * kSlices);
  const gst::BufferPtr sent(EncodedSlice(1, 3));
  const gst::BufferMap a(slices.back().get(), GST_MAP_READ);
  const gst::BufferMap b(sent.get(), GST_MAP_READ);
  EXPECT_TRUE(std::equal(a.view().begin(), a.view().end(), b.view().begin(), b.view().end()));
  const gst::CapsPtr wanted(gst_caps_from_string(kVoxels));
  const gst::CapsPtr caps(gst_pad_get_current_caps(h->sinkpad));
  EXPECT_TRUE(gst_caps_is_equal(caps.get(), wanted.get()))
      << gst::StringPtr(gst_caps_to_string(caps.get())).get();
}

TEST(RtpLidarDepay, NamesTheDecoderThatTheStreamIsFor) {
  for (const auto& [type, decoder] : {std::pair(GST_LIDAR_SLICE_MEDIA_TYPE, "lidardec"),
                                      std::pair(GST_LIDAR_DRACO_MEDIA_TYPE, "dracodec")}) {
    const Harness pay(gst_harness_new("rtplidarpay"));
    gst_harness_set_src_caps_str(pay.get(), EncodedCaps("range", 10, type).c_str());
    gst_harness_push(pay.get(), EncodedSlice(0, 0));
    const Harness h(gst_harness_new("rtplidardepay"));
    gst_harness_set_sink_caps_str(h.get(), "application/x-voxels");
    gst_harness_set_src_caps_str(h.get(), kRtpCaps);
    const ElementBus bus(h->element);
    Push(h.get(), Pull(pay.get()));
    EXPECT_EQ(bus.Text(GST_MESSAGE_WARNING),
              std::string("The slices of this stream need ") + decoder +
                  ", but the next element does not accept them. They are dropped.");
  }
}

TEST(RtpLidarDepay, SaysOnceThatTheDecoderDoesNotKnowTheCoder) {
  const Harness h(gst_harness_new("rtplidardepay"));
  gst_harness_set_sink_caps_str(h.get(), GST_LIDAR_SLICE_MEDIA_TYPE);
  gst_harness_set_src_caps_str(h.get(), kRtpCaps);
  const ElementBus bus(h->element);
  Push(h.get(), PacketsOfVoxels(3));
  EXPECT_TRUE(Pull(h.get()).empty());
  EXPECT_EQ(Stat(h.get(), "slices-not-accepted"), 3 * kSlices);
  EXPECT_EQ(
      bus.Texts(GST_MESSAGE_WARNING),
      std::vector<std::string>{"The slices of this stream need a decoder of application/x-voxels, "
                               "but the next element does not accept them. They are dropped."});
}

/// A fixture with a depayloader whose packets cause the same warning again and again.
class OneWarning : public ::testing::Test {
 protected:
  std::size_t Warnings() { return bus_.Texts(GST_MESSAGE_WARNING).size(); }
  void Restart() {
    gst_element_set_state(h_->element, GST_STATE_NULL);
    gst_element_set_state(h_->element, GST_STATE_PLAYING);
    gst_harness_set_src_caps_str(h_.get(), kRtpCaps);
  }
  /// Calls `cause` repeatedly in two runs of the element. Expects one warning in each run.
  template <class Cause>
  void ExpectOne(const Cause& cause) {
    for (int run = 0; run < 2; ++run) {
      for (int i = 0; i < 3; ++i) cause();
      EXPECT_EQ(Warnings(), 1U) << "run " << run;
      Restart();
    }
  }

  Harness h_ = Depay();
  const ElementBus bus_{h_->element};
  std::uint16_t sequence_ = 0;
};

TEST_F(OneWarning, OfAStreamThatTakesTurns) {
  std::vector<std::uint8_t> ids(2);
  const char* fields[] = {"x:F32:0,y:F32:4,z:F32:8", "x:F32:0,y:F32:4,z:F32:8,range:U32:12"};
  std::uint32_t scan = 0;
  ExpectOne([&] {
    for (std::size_t i = 0; i < ids.size(); ++i)
      gst_harness_push(h_.get(), RtpOf(ConfigPayload(fields[i], &ids[i]), 7, sequence_++));
    gst_harness_push(h_.get(), RtpOf(TakingTurns(ids, scan++, 32), 7, sequence_++));
  });
}

TEST_F(OneWarning, OfASecondStream) {
  ExpectOne([&] {
    std::uint8_t id = 0;
    for (std::uint16_t i = 0; i < 150; ++i, ++sequence_)
      for (const guint32 ssrc : {7U, 8U, 9U})
        gst_harness_push(h_.get(),
                         RtpOf(ConfigPayload("x:F32:0,y:F32:4,z:F32:8", &id), ssrc, sequence_));
  });
}

TEST_F(OneWarning, OfPacketsOfAnotherPayloadType) {
  ExpectOne([&] {
    for (std::uint16_t i = 0; i < 30; ++i) {
      GstBuffer* packet = RtpOf({1, 2, 3}, 7, sequence_++);
      gst_buffer_memset(packet, 1, 97, 1);
      gst_harness_push(h_.get(), packet);
    }
  });
}

TEST_F(OneWarning, OfSlicesForAnotherDecoder) {
  gst_harness_set_sink_caps_str(h_.get(), "application/x-other");
  const auto packets = Packets(1);
  ExpectOne([&] {
    for (const auto& packet : packets)
      gst_harness_push(h_.get(), gst_buffer_copy_deep(packet.get()));
  });
}

TEST_F(OneWarning, OfPacketsThatCannotBeRead) {
  ExpectOne([&] {
    for (std::uint16_t i = 0; i < 30; ++i)
      gst_harness_push(h_.get(), RtpOf(std::vector<std::uint8_t>(50, 0xFF), 7, sequence_++));
  });
}

TEST(RtpLidarDepay, SaysOnceThatNothingCanBeRead) {
  const Harness h = Depay();
  const ElementBus bus(h->element);
  for (std::uint16_t i = 0; i < 60; ++i) {  // payloads of pseudo-random bytes
    std::vector<std::uint8_t> bytes(200);
    for (std::size_t k = 0; k < bytes.size(); ++k)
      bytes[k] = static_cast<std::uint8_t>((i * 7'919U + k * 104'729U) >> 3);
    bytes[0] = 0xFF;
    gst_harness_push(h.get(), RtpOf(bytes, 7, i));
  }
  unsigned warnings = 0;
  while (const gst::MessagePtr message = bus.Pop())
    warnings += GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_WARNING ? 1U : 0U;
  EXPECT_EQ(warnings, 1U);
  EXPECT_EQ(Stat(h.get(), "packets-invalid"), 60U);
}

class UndecodableConfigs : public ::testing::TestWithParam<const char*> {};
TEST_P(UndecodableConfigs, AreCountedAndTheStreamGoesOn) {
  const Harness h = Depay();
  const auto packets = Packets(1);
  EXPECT_EQ(gst_harness_push(h.get(), ConfigBefore(packets[0].get(), GetParam())), GST_FLOW_OK);
  EXPECT_EQ(Stat(h.get(), "configs-damaged"), 1U);
  EXPECT_FALSE(gst_pad_has_current_caps(h->sinkpad));
  Push(h.get(), packets);
  EXPECT_EQ(Pull(h.get()).size(), kSlices);
}
INSTANTIATE_TEST_SUITE_P(All, UndecodableConfigs,
                         ::testing::Values("range:U32:0", "x:F64:0,y:F64:8,z:F64:16",
                                           "x:F32:0,y:F32:4,z:F32:8,range:U32:8"));

}  // namespace
}  // namespace lidar::test
