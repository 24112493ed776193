// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of lidarenc, rtplidarpay, rtplidardepay and lidardec over a simulated link: which packets
// arrive, which are acknowledged, and what the decoder requests.
#include <gst/rtp/gstrtpbuffer.h>
#include <gtest/gtest.h>

#include <functional>

#include "tests/elements/coders/coder_harness.h"
#include "tests/elements/coders/stopped_clock.h"

namespace lidar::gst {
namespace {

constexpr guint kSlices = 8;

class StaticSensor : public ::testing::Test {
 protected:
  void Start(const std::string& properties = "", const std::string& between = "") {
    sender_ = Launch(
        "lidarenc name=enc effort=1 key-interval=0 error-check=" + std::to_string(checks_every_) +
        " " + properties + " ! " + between + " rtplidarpay name=pay config-interval=1");
    receiver_ = Launch("rtplidardepay ! lidardec name=dec");
    CloudInfo info = OrganisedInfo(model_, 64);
    SetCaps(sender_.get(), info);
  }

  /// Sends one scan. Packets for which `loses` returns true do not arrive. If `acknowledges_` is
  /// true, the packets that arrived are acknowledged after each slice.
  void Scan(const std::function<bool(guint packet)>& loses = nullptr) {
    for (guint i = 0; i < kSlices; ++i) {
      const GstLidarSlice slice{scan_, i, kSlices, 64 * i};
      GstBuffer* input = OrganisedBuffer(model_, 64, slice);
      AddNoise(input);
      ASSERT_EQ(gst_harness_push(sender_.get(), input), GST_FLOW_OK);
      while (BufferPtr packet{gst_harness_try_pull(sender_.get())}) Carry(std::move(packet), loses);
      if (acknowledges_) Acknowledge();
    }
    ++scan_;
  }
  void Scans(int count) {
    for (int i = 0; i < count; ++i) Scan();
  }
  void Acknowledge(guint receiver = 1) {
    GstLidarPacketsReceived received{ssrc_, receiver, 0, {}};
    for (const guint16 seq : arrived_) {
      if (received.count == GST_LIDAR_MAX_RECEIVED) break;
      received.ranges[received.count++] = {seq, seq};
    }
    arrived_.clear();
    gst_harness_push_upstream_event(sender_.get(), gst_lidar_event_new_packets_received(&received));
  }
  /// Sends acknowledgements of slices that the encoder never sent.
  void AcknowledgeUnknown() {
    GstLidarSlicesReceived received{1, GST_LIDAR_MAX_RECEIVED, {}};
    for (GstLidarReceivedSlice& slice : received.slices) slice = {4'000'000, 0};
    gst_harness_push_upstream_event(sender_.get(), gst_lidar_event_new_slices_received(&received));
  }
  void AskForKeyUnit() {
    gst_harness_push_upstream_event(
        sender_.get(), gst_event_new_custom(GST_EVENT_CUSTOM_UPSTREAM,
                                            gst_structure_new_empty("GstForceKeyUnit")));
  }
  /// Expects that the receiver's requests for key units are numbered from 1 on. Passes them to the
  /// sender if `arrives` is true. Returns true if there was a request.
  bool CarryKeyRequest(bool arrives = true) {
    bool asked = false;
    while (EventPtr event{gst_harness_try_pull_upstream_event(receiver_.get())}) {
      if (!gst_event_has_name(event.get(), "GstForceKeyUnit")) continue;
      guint count = 0;
      gst_structure_get_uint(gst_event_get_structure(event.get()), "count", &count);
      EXPECT_EQ(count, ++key_requests_);
      asked = true;
      if (arrives) gst_harness_push_upstream_event(sender_.get(), event.release());
    }
    return asked;
  }
  std::string Mode() {
    const StructurePtr stats(StatsOf(Get("enc", sender_).get()));
    return gst_structure_get_string(stats.get(), "mode");
  }
  guint64 Encoded(const char* name) { return test::StatOf(Get("enc", sender_).get(), name); }
  guint64 Decoded(const char* name) { return test::StatOf(Get("dec", receiver_).get(), name); }
  static ElementPtr Get(const char* name, const Harness& harness) {
    return ElementPtr(gst_bin_get_by_name(GST_BIN(harness->element), name));
  }
  ElementPtr AtSender(const char* name) { return Get(name, sender_); }
  /// Restarts the decoder, which drops its slices but keeps its caps.
  void RestartDecoder() {
    const ElementPtr dec = Get("dec", receiver_);
    gst_element_set_state(dec.get(), GST_STATE_READY);
    gst_element_sync_state_with_parent(dec.get());
  }

  /// Links a second branch to the tee `t`.
  void AddBranch() {
    GstElement* sink = gst_element_factory_make("fakesink", nullptr);
    g_object_set(sink, "sync", FALSE, "async", FALSE, nullptr);
    gst_bin_add(GST_BIN(sender_->element), sink);
    gst_element_sync_state_with_parent(sink);
    ASSERT_TRUE(gst_element_link(Get("t", sender_).get(), sink));
  }

  test::StoppedClock clock_;
  guint checks_every_ = 1;  // interval between error checks, in slices
  bool acknowledges_ = true;
  guint key_requests_ = 0;

 private:
  /// Adds simulated sensor noise to the ranges, because the room itself is the same in all scans.
  void AddNoise(GstBuffer* buffer) {
    BufferMap map(buffer, GST_MAP_READWRITE);
    const RangeProjection projection(model_);
    GstLidarSlice slice{};
    gst_lidar_buffer_get_slice(buffer, &slice);
    for (gsize i = 0; i < map.size() / 20; ++i) {
      guint8* point = map.data() + 20 * i;
      guint32 range = 0;
      std::memcpy(&range, point + 16, sizeof range);
      if (range == 0) continue;
      range += (scan_ * 7 + static_cast<guint>(i) * 5) % 9;
      const auto xyz = projection.Point(static_cast<guint>(i) / 64,
                                        slice.first_column + static_cast<guint>(i) % 64, range);
      std::memcpy(point, xyz.data(), sizeof xyz);
      std::memcpy(point + 16, &range, sizeof range);
    }
  }

  void Carry(BufferPtr packet, const std::function<bool(guint)>& loses) {
    if (!receiver_has_caps_) {
      const PadPtr pad(gst_element_get_static_pad(sender_->element, "src"));
      const CapsPtr caps(gst_pad_get_current_caps(pad.get()));
      gst_harness_set_src_caps(receiver_.get(), gst_caps_ref(caps.get()));
      receiver_has_caps_ = true;
    }
    GstRTPBuffer rtp = GST_RTP_BUFFER_INIT;
    ASSERT_TRUE(gst_rtp_buffer_map(packet.get(), GST_MAP_READ, &rtp));
    ssrc_ = gst_rtp_buffer_get_ssrc(&rtp);
    const guint16 seq = gst_rtp_buffer_get_seq(&rtp);
    gst_rtp_buffer_unmap(&rtp);
    if (loses && loses(packets_++)) return;
    arrived_.push_back(seq);
    ASSERT_EQ(gst_harness_push(receiver_.get(), packet.release()), GST_FLOW_OK);
  }

  SensorModel model_ = test::RoomSensor();
  Harness sender_;
  Harness receiver_;
  bool receiver_has_caps_ = false;
  guint scan_ = 0;
  guint packets_ = 0;
  guint32 ssrc_ = 0;
  std::vector<guint16> arrived_;
};

TEST_F(StaticSensor, IsCodedByTheScansThatTheReceiverHas) {
  Start();
  Scans(4);
  EXPECT_EQ(Mode(), "range-temporal1");
  Scans(6);
  EXPECT_EQ(Decoded("slices"), 10 * kSlices);
  EXPECT_EQ(Decoded("slices-dropped"), 0U);
  EXPECT_EQ(Encoded("error-checks"), 10 * kSlices);
  EXPECT_EQ(Encoded("error-checks-failed"), 0U);
}

/// The error check decodes every third slice, but does not decode the slices that these refer to.
TEST_F(StaticSensor, IsCheckedByTheScansThatTheReceiverHas) {
  checks_every_ = 3;
  Start();
  Scans(10);
  EXPECT_EQ(Mode(), "range-temporal1");
  EXPECT_EQ(Encoded("error-checks"), (10 * kSlices + 2) / 3);
  EXPECT_EQ(Encoded("error-checks-failed"), 0U);
}

TEST_F(StaticSensor, IsCodedSliceBySliceWhereNobodyAcknowledges) {
  Start();
  acknowledges_ = false;
  Scans(4);
  EXPECT_EQ(Mode(), "range-mixing1");
}

TEST_F(StaticSensor, IsCodedSliceBySliceWithoutReferences) {
  Start("reference=none");
  Scans(4);
  EXPECT_EQ(Mode(), "range-mixing1");
}

TEST_F(StaticSensor, IsCodedSliceBySliceBehindATee) {
  Start("", "tee name=t t. ! fakesink sync=false async=false t. ! ");
  Scans(4);
  EXPECT_EQ(Mode(), "range-mixing1");
}

TEST_F(StaticSensor, IsCodedSliceBySliceOnceABranchOfATeeIsAdded) {
  Start("", "tee name=t ! ");
  Scans(4);
  ASSERT_EQ(Mode(), "range-temporal1");
  AddBranch();
  clock_.Advance(G_USEC_PER_SEC / 10);  // the encoder looks for tees once in this time
  Scan();
  EXPECT_EQ(Mode(), "range-mixing1") << "the new branch has none of what was sent before";
}

TEST_F(StaticSensor, IsCodedByItsScansThoughAPadOfATeeIsNotLinked) {
  Start("", "tee name=t ! ");
  const ElementPtr tee = AtSender("t");
  const PadPtr pad(gst_element_request_pad_simple(tee.get(), "src_%u"));
  ASSERT_TRUE(pad);
  Scans(4);
  EXPECT_EQ(Mode(), "range-temporal1") << "no second receiver is there";
  gst_element_release_request_pad(tee.get(), pad.get());
}

TEST_F(StaticSensor, IsCodedSliceBySliceOnceInEachKeyInterval) {
  Start("key-interval=1000000000");
  const auto alone = [&] {
    unsigned scans = 0;
    for (int i = 0; i < 30; ++i) {
      clock_.Advance(G_USEC_PER_SEC / 10);
      Scan();
      scans += Mode() == "range-mixing1" ? 1U : 0U;
    }
    return scans;
  };
  Scans(2);
  EXPECT_NEAR(alone(), 3, 1) << "of three seconds";
  g_object_set(AtSender("enc").get(), "key-interval", guint64{0}, nullptr);
  Scan();
  EXPECT_EQ(alone(), 0U);
}

TEST_F(StaticSensor, IsCodedByWhatIsThereWhateverWasLost) {
  Start();
  int referring = 0;  // number of scans whose last slice refers to another slice
  for (int i = 0; i < 12; ++i) {
    Scan([](guint packet) { return packet % 5 == 2; });
    referring += Mode() == "range-temporal1" ? 1 : 0;
  }
  EXPECT_GE(referring, 3);
  EXPECT_GT(Decoded("slices"), 5 * kSlices);
  EXPECT_EQ(Decoded("slices-dropped"), 0U);
}

TEST_F(StaticSensor, IsAskedForSlicesThatStandAloneByAReceiverThatHasNone) {
  Start();
  Scans(4);
  RestartDecoder();
  Scan();
  EXPECT_EQ(Decoded("slices"), 0U);
  EXPECT_EQ(Decoded("slices-unreferenced"), kSlices);
  EXPECT_TRUE(CarryKeyRequest());
  EXPECT_EQ(key_requests_, 1U) << "for all slices within half a second";
  Scans(3);
  EXPECT_EQ(Decoded("slices"), 3 * kSlices);
  EXPECT_EQ(Mode(), "range-temporal1");
}

TEST_F(StaticSensor, IsAskedForSlicesThatStandAloneTwiceASecondAtMost) {
  Start();
  Scans(4);
  RestartDecoder();
  for (const gint64 later_us : {0, 400'000, 90'000, 20'000, 400'000, 90'000, 20'000}) {
    clock_.Advance(later_us);
    Scan();
    EXPECT_EQ(CarryKeyRequest(false), later_us == 0 || later_us == 20'000) << later_us;
  }
  EXPECT_EQ(key_requests_, 3U);
}

/// Until the next cloud, the encoder stores at most 4,096 acknowledgements and drops the rest.
TEST_F(StaticSensor, IsCodedByNoMoreReportsThanTheEncoderKeeps) {
  Start();
  Scans(2);
  acknowledges_ = false;
  for (const guint events : {15U, 16U}) {
    AskForKeyUnit();
    Scan();
    for (guint i = 0; i < events; ++i) AcknowledgeUnknown();
    Acknowledge();
    Scan();
    EXPECT_EQ(Mode(), events == 15 ? "range-temporal1" : "range-mixing1") << events;
  }
}

TEST_F(StaticSensor, IsCodedSliceBySliceForTwoReceivers) {
  Start();
  Scans(3);
  for (int i = 0; i < 3; ++i) {
    Acknowledge(2);
    Scan();
    EXPECT_EQ(Mode(), "range-mixing1");
  }
}

}  // namespace
}  // namespace lidar::gst
