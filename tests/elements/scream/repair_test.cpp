// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of GStreamer's own retransmission and FEC elements around screamtx and screamrx. The wire
// between them loses packets.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/elements/scream/pipeline.h"
#include "tests/elements/scream/rtp_support.h"

namespace lidar::test {
namespace {

using gst::ElementPtr;
using gst::PadPtr;

constexpr int kPackets = 250;
constexpr guint8 kMediaType = 96;
constexpr int kLossEvery = 25;

struct Repair {
  const char* name;
  std::string sender, receiver;
  const char* repairer;
  const char* counter;  // property of the repairer with the number of repaired packets
  guint ssrcs;
};
void PrintTo(const Repair& r, std::ostream* out) { *out << r.name; }

const Repair kRtx{"Rtx",
                  "rtprtxsend payload-type-map=\"application/x-rtp-pt-map,96=(uint)97\"",
                  "rtprtxreceive name=repairer "
                  "payload-type-map=\"application/x-rtp-pt-map,96=(uint)97\" ! "
                  "rtpssrcdemux ! rtpjitterbuffer name=jitter do-retransmission=true latency=600",
                  "repairer",
                  "num-rtx-assoc-packets",
                  2};
const Repair kFec{
    "Fec",
    "rtpulpfecenc percentage=100 pt=122",
    "rtpstorage size-time=1000000000 ! rtpssrcdemux ! "
    "application/x-rtp,payload=96,clock-rate=90000,media=application,encoding-name=X-GST ! "
    "rtpjitterbuffer name=jitter do-lost=true latency=600 ! rtpulpfecdec name=repairer pt=122",
    "repairer",
    "recovered",
    1};

struct Wire {
  int media = 0;
  int lost = 0;
};
/// Drops media packets at equal distances, but none near the start or the end, because a packet
/// that is lost at the end is not repaired.
GstPadProbeReturn Lose(GstPad*, GstPadProbeInfo* info, gpointer data) {
  Wire& wire = *static_cast<Wire*>(data);
  if (ReadRtp(GST_PAD_PROBE_INFO_BUFFER(info)).payload_type != kMediaType) return GST_PAD_PROBE_OK;
  const int n = wire.media++;
  if (n % kLossEvery != 15 || n < 30 || n > 180) return GST_PAD_PROBE_OK;
  ++wire.lost;
  return GST_PAD_PROBE_DROP;
}

void Count(GstElement*, GstBuffer*, GstPad*, int* arrived) { ++*arrived; }

/// Carries reports back to the sender by a function call, because a link between pads would make a
/// loop in the pipeline.
GstPadProbeReturn Back(GstPad*, GstPadProbeInfo* info, gpointer rtcp_sink) {
  gst_pad_chain(GST_PAD(rtcp_sink), gst_buffer_ref(GST_PAD_PROBE_INFO_BUFFER(info)));
  return GST_PAD_PROBE_DROP;
}

void Open(GstPad* rtcp_sink) {
  gst_pad_send_event(rtcp_sink, gst_event_new_stream_start("feedback"));
  gst_pad_send_event(rtcp_sink, NewSegment());
}

class RepairTest : public ::testing::TestWithParam<std::tuple<Repair, bool>> {};

TEST_P(RepairTest, BringsBackWhatTheWireLostAndCongestionControlSeesItAll) {
  const auto& [repair, pt_map] = GetParam();
  const std::string map =
      "pt-map=\"application/x-rtp-pt-map,96=(string)\\\"application/x-rtp,media=application,"
      "encoding-name=X-GST,clock-rate=90000\\\"\"";
  Pipeline pipeline(
      "audiotestsrc is-live=true samplesperbuffer=441 num-buffers=" + std::to_string(kPackets) +
      " ! audio/x-raw,rate=44100,channels=1,format=S16BE ! rtpgstpay pt=96 seqnum-offset=100 ! " +
      repair.sender + " ! screamtx name=tx start-bitrate=3000000 ! identity name=wire ! " +
      "screamrx name=rx " + (pt_map ? map : "") + " ! " + repair.receiver +
      " ! rtpgstdepay ! fakesink name=out sync=false signal-handoffs=true");
  Wire wire;
  int arrived = 0;
  const ElementPtr tx = pipeline.Get("tx");
  const PadPtr wire_pad(gst_element_get_static_pad(pipeline.Get("wire").get(), "src"));
  const PadPtr rtcp_sink(gst_element_get_static_pad(tx.get(), "rtcp_sink"));
  gst_pad_add_probe(wire_pad.get(), GST_PAD_PROBE_TYPE_BUFFER, Lose, &wire, nullptr);
  g_signal_connect(pipeline.Get("out").get(), "handoff", G_CALLBACK(Count), &arrived);
  const PadPtr reports(gst_element_get_static_pad(pipeline.Get("rx").get(), "rtcp_src"));
  pipeline.Play();
  Open(rtcp_sink.get());
  gst_pad_add_probe(reports.get(), GST_PAD_PROBE_TYPE_BUFFER, Back, rtcp_sink.get(), nullptr);
  ASSERT_TRUE(pipeline.Ends());
  const int lost = wire.lost;
  EXPECT_EQ(lost, 6);
  guint repaired = 0;
  g_object_get(pipeline.Get(repair.repairer).get(), repair.counter, &repaired, nullptr);
  EXPECT_GE(repaired, static_cast<guint>(lost / 2));
  // On a busy machine repaired packets may arrive after the jitter buffer has given them up.
  const auto jitter = [&](const char* name) {
    return static_cast<int>(StatOf(pipeline.Get("jitter").get(), name));
  };
  EXPECT_GE(arrived, kPackets - (repair.name == kRtx.name
                                     ? jitter("num-lost")
                                     : lost - static_cast<int>(repaired) + jitter("num-late")));
  EXPECT_LE(arrived, kPackets);
  const Stats sent(tx.get());
  const Stats received(pipeline.Get("rx").get());
  EXPECT_GE(sent["packets-sent"], static_cast<guint64>(kPackets) + repaired);
  EXPECT_EQ(received["packets-received"], sent["packets-sent"] - static_cast<guint64>(lost));
  EXPECT_EQ(received["ssrcs"], repair.ssrcs);
  EXPECT_EQ(sent["feedback-foreign-blocks"], 0U);
  // The stream may end before the last packets are reported.
  EXPECT_NEAR(static_cast<double>(sent["packets-lost"]), lost, 1);
  EXPECT_GE(sent["packets-acked"] + 40, received["packets-received"]);
}
INSTANTIATE_TEST_SUITE_P(Stock, RepairTest,
                         ::testing::Combine(::testing::Values(kRtx, kFec), ::testing::Bool()),
                         [](const auto& i) {
                           return std::string(std::get<0>(i.param).name) +
                                  (std::get<1>(i.param) ? "WithPtMap" : "");
                         });

}  // namespace
}  // namespace lidar::test
