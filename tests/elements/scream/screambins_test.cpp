// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of screamsink and screamsrc with real sockets of the loopback interface.
#include <gtest/gtest.h>

#include <memory>

#include "tests/elements/scream/pipeline.h"
#include "tests/elements/scream/rtp_support.h"
#include "tests/support/free_ports.h"
#include "tests/support/patience.h"

namespace lidar::test {
namespace {

using gst::ElementPtr;
using gst::MessagePtr;
using gst::PadPtr;

/// A playing receiver of raw audio, and its port.
struct Receiver {
  explicit Receiver(const std::string& properties = "", const std::string& rest = "rtpL16depay")
      : pipeline("screamsrc name=in port=0 " + properties + " ! " + rest +
                 " ! fakesink name=out sync=false") {
    pipeline.Play();
    in = pipeline.Get("in");
    port = PortOf(in.get());
  }
  Pipeline pipeline;
  ElementPtr in;
  guint port = 0;
};

constexpr const char* kAudioCaps =
    "caps=\"application/"
    "x-rtp,media=audio,encoding-name=L16,clock-rate=44100,channels=1,payload=96\"";
const std::string kAudio =
    "audiotestsrc name=src samplesperbuffer=441 is-live=true ! "
    "audio/x-raw,rate=44100,channels=1,format=S16BE ! rtpL16pay name=pay ! ";

std::string Sink(guint port, const std::string& more = "") {
  return "screamsink name=out host=127.0.0.1 port=" + std::to_string(port) + " " + more;
}

TEST(ScreamBins, TheSourceUsesAGivenSocketForBothWaysAndLeavesItOpen) {
  GSocket* given =
      g_socket_new(G_SOCKET_FAMILY_IPV4, G_SOCKET_TYPE_DATAGRAM, G_SOCKET_PROTOCOL_UDP, nullptr);
  GSocketAddress* any = g_inet_socket_address_new_from_string("127.0.0.1", 0);
  ASSERT_TRUE(g_socket_bind(given, any, FALSE, nullptr));
  g_object_unref(any);
  Pipeline receiver(std::string("screamsrc name=in ") + kAudioCaps +
                    " ! rtpL16depay ! fakesink sync=false");
  const ElementPtr in = receiver.Get("in");
  g_object_set(in.get(), "socket", given, "close-socket", FALSE, nullptr);
  receiver.Play();
  Pipeline sender(kAudio + Sink(PortOf(in.get())));
  g_object_set(sender.Get("src").get(), "num-buffers", 100, nullptr);
  sender.Play();
  EXPECT_TRUE(sender.Ends());
  EXPECT_TRUE(receiver.Ends());
  EXPECT_GT(Stats(sender.Get("out").get())["feedback-accepted"], 0U);
  gst_element_set_state(in.get(), GST_STATE_NULL);
  EXPECT_FALSE(g_socket_is_closed(given));
  g_object_set(in.get(), "close-socket", TRUE, nullptr);
  gst_element_set_state(in.get(), GST_STATE_READY);
  gst_element_set_state(in.get(), GST_STATE_NULL);
  EXPECT_TRUE(g_socket_is_closed(given));
  g_object_unref(given);
}

TEST(ScreamBins, ASocketThatIsReplacedWhileItIsUsedStaysOpen) {
  GSocket* given =
      g_socket_new(G_SOCKET_FAMILY_IPV4, G_SOCKET_TYPE_DATAGRAM, G_SOCKET_PROTOCOL_UDP, nullptr);
  GSocketAddress* any = g_inet_socket_address_new_from_string("127.0.0.1", 0);
  ASSERT_TRUE(g_socket_bind(given, any, FALSE, nullptr));
  g_object_unref(any);
  const ElementPtr in(gst_element_factory_make("screamsrc", nullptr));
  g_object_set(in.get(), "socket", given, "close-socket", FALSE, nullptr);
  gst_element_set_state(in.get(), GST_STATE_READY);
  g_object_set(in.get(), "socket", nullptr, nullptr);
  gst_element_set_state(in.get(), GST_STATE_NULL);
  EXPECT_FALSE(g_socket_is_closed(given));
  g_object_unref(given);
}

TEST(ScreamBins, CarryAStreamAndEndBothEnds) {
  Receiver receiver(kAudioCaps);
  Pipeline sender(kAudio + Sink(receiver.port, kPatientQueue));
  g_object_set(sender.Get("src").get(), "num-buffers", 100, nullptr);
  sender.Play();
  EXPECT_TRUE(sender.Ends());
  EXPECT_TRUE(receiver.pipeline.Ends());
  const Stats tx(sender.Get("out").get());
  const Stats rx(receiver.in.get());
  EXPECT_EQ(tx["packets-sent"], 100U);
  EXPECT_EQ(rx["packets-received"], 100U);
  EXPECT_EQ(rx["packets-lost"], 0U);
  EXPECT_GT(tx["feedback-accepted"], 10U);
  EXPECT_EQ(tx["feedback-foreign-address"], 0U);
  EXPECT_EQ(tx.Text("ecn-state"), "capable");
  EXPECT_GT(tx["rtt"], 0U);
}

TEST(ScreamBins, TheReceiverKnowsWhatTheSenderSees) {
  g_setenv("LIDAR_BINS_KEY", std::string(60, '5').c_str(), TRUE);
  const ElementPtr srtp(gst_element_factory_make("srtpenc", nullptr));
  for (const char* key : {"", " srtp-key=env:LIDAR_BINS_KEY"}) {
    if (*key != '\0' && !srtp) GTEST_SKIP() << "srtpenc is not installed";
    Receiver receiver(std::string(kAudioCaps) + key);
    Pipeline sender(kAudio + Sink(receiver.port, "sender-report-interval=100000000") + key);
    sender.Play();
    ASSERT_TRUE(Eventually([&] { return Stats(receiver.in.get())["sender-rtt"] > 0; })) << key;
    const Stats rx(receiver.in.get());
    EXPECT_GT(rx["sender-reports"], 0U);
    EXPECT_GT(rx["sender-target-bitrate"], 0U);
    EXPECT_GT(rx["sender-packets-sent"], 0U);
    EXPECT_EQ(rx["malformed"], 0U);
  }
}

TEST(ScreamBins, EndBothEndsWhenTheApplicationEndsTheSender) {
  Receiver receiver(kAudioCaps);
  Pipeline sender(kAudio + Sink(receiver.port));
  sender.Play();
  ASSERT_TRUE(sender.Wait(GST_MESSAGE_STREAM_START));
  ASSERT_TRUE(Eventually([&] { return Stats(receiver.in.get())["packets-received"] > 0; }));
  sender.SendEos();
  EXPECT_TRUE(sender.Ends());
  EXPECT_TRUE(receiver.pipeline.Ends());
}

TEST(ScreamBins, TheReceiverEndsWhenItsApplicationSaysSo) {
  Receiver receiver(kAudioCaps);
  receiver.pipeline.SendEos();
  EXPECT_TRUE(receiver.pipeline.Ends());
}

TEST(ScreamBins, NegotiateWithoutCapsWhereDownstreamSaysEnough) {
  Receiver receiver("", "rtpgstdepay");
  Pipeline sender("audiotestsrc num-buffers=20 is-live=true ! rtpgstpay ! " + Sink(receiver.port));
  sender.Play();
  EXPECT_TRUE(sender.Ends());
  EXPECT_TRUE(receiver.pipeline.Ends());
  const PadPtr pad(gst_element_get_static_pad(receiver.in.get(), "src"));
  const gst::CapsPtr caps(gst_pad_get_current_caps(pad.get()));
  ASSERT_TRUE(caps);
  gint payload = 0;
  gst_structure_get_int(gst_caps_get_structure(caps.get(), 0), "payload", &payload);
  EXPECT_EQ(payload, 96);
}

TEST(ScreamBins, InputThatIsNotLiveTakesItsTimeAndLosesNothing) {
  Receiver receiver(kAudioCaps);
  Pipeline sender(
      "audiotestsrc name=src samplesperbuffer=441 num-buffers=60 ! "
      "audio/x-raw,rate=44100,channels=1,format=S16BE ! rtpL16pay ! " +
      Sink(receiver.port));
  const gint64 start = g_get_monotonic_time();
  sender.Play();
  EXPECT_TRUE(sender.Ends());
  const double seconds = static_cast<double>(g_get_monotonic_time() - start) / 1e6;
  EXPECT_GE(seconds, 0.55);  // 60 buffers of 10 ms
  EXPECT_TRUE(receiver.pipeline.Ends());
  EXPECT_EQ(Stats(receiver.in.get())["packets-received"], 60U);
  EXPECT_EQ(Stats(sender.Get("out").get())["packets-dropped"], 0U);
}

TEST(ScreamBins, InputThatIsNotLiveTakesItsTimeAfterAFlushingSeekToo) {
  Receiver receiver(kAudioCaps);
  Pipeline sender(
      "audiotestsrc name=src samplesperbuffer=441 ! "
      "audio/x-raw,rate=44100,channels=1,format=S16BE ! rtpL16pay name=pay ! " +
      Sink(receiver.port));
  sender.Play();
  const ElementPtr out = sender.Get("out");
  EXPECT_TRUE(Eventually([&] { return Stats(out.get())["packets-sent"] > 80; }));
  const gint64 start = g_get_monotonic_time();
  EXPECT_TRUE(
      gst_element_seek_simple(sender.Get("pay").get(), GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, 0));
  const auto sent = Stats(out.get())["packets-sent"];
  EXPECT_TRUE(Eventually([&] { return Stats(out.get())["packets-sent"] >= sent + 100; }));
  const auto after = static_cast<double>(Stats(out.get())["packets-sent"] - sent);
  const double seconds = static_cast<double>(g_get_monotonic_time() - start) / 1e6;
  // One packet per 10 ms, and the packets that the queue may contain.
  EXPECT_LE(after, 100 * seconds + 25);
}

TEST(ScreamBins, MoreThanTheNetworkTakesIsHeldBackNotDroppedWhereInputIsNotLive) {
  Receiver receiver(kAudioCaps);
  Pipeline sender(
      "audiotestsrc samplesperbuffer=441 num-buffers=150 ! "
      "audio/x-raw,rate=44100,channels=1,format=S16BE ! rtpL16pay ! " +
      Sink(receiver.port, "max-bitrate=400000 start-bitrate=300000"));
  sender.Play();
  EXPECT_TRUE(sender.Ends());
  EXPECT_EQ(Stats(sender.Get("out").get())["frames-dropped"], 0U);
}

TEST(ScreamBins, FeedbackFromAnotherAddressIsIgnoredAndCounted) {
  Receiver receiver(kAudioCaps);
  Pipeline sender(kAudio + Sink(receiver.port, "bind-address=127.0.0.1"));
  sender.Play();
  ASSERT_TRUE(sender.Wait(GST_MESSAGE_STREAM_START));
  ASSERT_TRUE(Eventually([&] { return Stats(receiver.in.get())["packets-received"] > 0; }));
  const ElementPtr udp = sender.Get("ecnudpsink");
  const guint port = PortOf(udp.get());
  Pipeline liar(
      "videotestsrc num-buffers=5 ! video/x-raw,width=8,height=8 ! ecnudpsink "
      "sync=false host=127.0.0.1 port=" +
      std::to_string(port));
  liar.Play();
  EXPECT_TRUE(liar.Ends());
  ASSERT_TRUE(
      Eventually([&] { return Stats(sender.Get("out").get())["feedback-foreign-address"] >= 5; }));
  EXPECT_EQ(Stats(sender.Get("out").get())["rtcp-malformed"], 0U);
}

TEST(ScreamBins, ASenderThatComesBackWithAnotherSsrcIsTakenUp) {
  Receiver receiver(std::string(kAudioCaps) + " eos-on-bye=false");
  for (guint64 run = 1; run <= 2; ++run) {
    Pipeline sender(kAudio + Sink(receiver.port));
    sender.Play();
    EXPECT_TRUE(Eventually([&] { return Stats(sender.Get("out").get())["feedback-accepted"] > 0; }))
        << run;
    sender.SendEos();
    EXPECT_TRUE(sender.Ends());
  }
  EXPECT_EQ(Stats(receiver.in.get())["peer-moves"], 1U);
}

TEST(ScreamBins, AReceiverThatRestartsIsFoundAgain) {
  const guint port = FreePort();
  const std::string options = std::string(kAudioCaps) + " port=" + std::to_string(port);
  auto receiver = std::make_unique<Receiver>(options);
  Pipeline sender(kAudio + Sink(port));
  sender.Play();
  const auto received = [&] { return Stats(receiver->in.get())["packets-received"]; };
  ASSERT_TRUE(Eventually([&] { return received() >= 10; }));
  receiver.reset();
  receiver = std::make_unique<Receiver>(options);
  ASSERT_EQ(receiver->port, port);
  const guint64 accepted = Stats(sender.Get("out").get())["feedback-accepted"];
  EXPECT_TRUE(Eventually([&] { return received() >= 50; }));
  EXPECT_TRUE(
      Eventually([&] { return Stats(sender.Get("out").get())["feedback-accepted"] > accepted; }));
}

TEST(ScreamBins, SeveralStreamsShareOnePath) {
  Receiver receiver(
      "pt-map=\"application/x-rtp-pt-map,"
      "96=(string)\\\"application/x-rtp,media=audio,encoding-name=L16,clock-rate=44100\\\","
      "97=(string)\\\"application/x-rtp,media=audio,encoding-name=L8,clock-rate=44100\\\"\"",
      "application/x-rtp,encoding-name=L16 ! rtpL16depay");
  struct Linked {
    GstElement* bin;
    int pads = 0;
  } linked{receiver.in.get()};
  g_signal_connect(receiver.in.get(), "pad-added",
                   G_CALLBACK(+[](GstElement* e, GstPad* pad, Linked* l) {
                     GstElement* parent = GST_ELEMENT(gst_element_get_parent(e));
                     GstElement* sink = gst_element_factory_make("fakesink", nullptr);
                     g_object_set(sink, "sync", FALSE, "async", FALSE, nullptr);
                     gst_bin_add(GST_BIN(parent), sink);
                     gst_element_sync_state_with_parent(sink);
                     GstPad* to = gst_element_get_static_pad(sink, "sink");
                     l->pads += gst_pad_link(pad, to) == GST_PAD_LINK_OK ? 1 : 0;
                     gst_object_unref(to);
                     gst_object_unref(parent);
                   }),
                   &linked);
  Pipeline sender("screamsink name=out host=127.0.0.1 port=" + std::to_string(receiver.port) + " " +
                  kPatientQueue +
                  " audiotestsrc num-buffers=50 samplesperbuffer=441 is-live=true ! rtpL16pay "
                  "pt=96 ! out.sink_0"
                  " audiotestsrc num-buffers=50 samplesperbuffer=441 is-live=true ! rtpL8pay pt=97 "
                  "! out.sink_1");
  sender.Play();
  EXPECT_TRUE(sender.Ends());
  EXPECT_TRUE(receiver.pipeline.Ends());
  EXPECT_EQ(linked.pads, 1);
  EXPECT_EQ(Stats(receiver.in.get())["packets-lost"], 0U);
}

TEST(ScreamBins, AStreamThatNoElementTakesIsAnErrorThatNamesTheDepayloader) {
  // The element lidardec is linked when screamsrc adds a suitable pad.
  Pipeline receiver("screamsrc name=in port=0 ! lidardec ! fakesink");
  receiver.Play();
  Pipeline sender(kAudio + Sink(PortOf(receiver.Get("in").get())));
  sender.Play();
  const MessagePtr message = receiver.Wait(GST_MESSAGE_ERROR);
  ASSERT_TRUE(message);
  EXPECT_EQ(MessageText(message.get()),
            "The src pad is not linked; its stream is application/x-rtp.");
  EXPECT_NE(MessageDetails(message.get()).find("rtplidardepay"), std::string::npos);
}

TEST(ScreamBins, APortInUseIsAnErrorThatNamesIt) {
  Receiver receiver(kAudioCaps);
  Pipeline second("screamsrc address=0.0.0.0 port=" + std::to_string(receiver.port) +
                  " ! fakesink");
  second.Play();
  const MessagePtr message = second.Wait(GST_MESSAGE_ERROR);
  ASSERT_TRUE(message);
  EXPECT_NE(MessageText(message.get()).find(std::to_string(receiver.port)), std::string::npos);
}

TEST(ScreamBins, AnUnknownHostIsAnErrorThatNamesIt) {
  Pipeline sender(kAudio + "screamsink host=no-such-host.invalid");
  sender.Play();
  const MessagePtr message = sender.Wait(GST_MESSAGE_ERROR);
  ASSERT_TRUE(message);
  EXPECT_NE(MessageDetails(message.get()).find("no-such-host.invalid"), std::string::npos);
}

TEST(ScreamBins, AnUnknownNameInTuningIsAnErrorThatListsTheNames) {
  Pipeline sender(kAudio + "screamsink tuning=tuning,beta-los=0.6");
  sender.Play();
  const MessagePtr message = sender.Wait(GST_MESSAGE_ERROR);
  ASSERT_TRUE(message);
  const std::string text = MessageText(message.get());
  EXPECT_NE(text.find("\"beta-los\" is not one of"), std::string::npos);
  EXPECT_NE(text.find("beta-loss"), std::string::npos);
}

TEST(ScreamBins, AreNeitherSinkNorSourceWithTheirBackChannel) {
  const ElementPtr sink(gst_element_factory_make("screamsink", nullptr));
  const ElementPtr source(gst_element_factory_make("screamsrc", nullptr));
  gst_object_ref_sink(sink.get());
  gst_object_ref_sink(source.get());
  EXPECT_TRUE(GST_OBJECT_FLAG_IS_SET(sink.get(), GST_ELEMENT_FLAG_SINK));
  EXPECT_FALSE(GST_OBJECT_FLAG_IS_SET(sink.get(), GST_ELEMENT_FLAG_SOURCE));
  EXPECT_TRUE(GST_OBJECT_FLAG_IS_SET(source.get(), GST_ELEMENT_FLAG_SOURCE));
  EXPECT_FALSE(GST_OBJECT_FLAG_IS_SET(source.get(), GST_ELEMENT_FLAG_SINK));
}

TEST(ScreamBins, TakePadPropertiesFromALaunchLine) {
  for (const char* name : {"screamsink", "screamtx"}) {
    Pipeline pipeline("audiotestsrc ! rtpL16pay ! " + std::string(name) +
                      " name=out sink_0::priority=3 ");
    gdouble priority = 0;
    gst_child_proxy_get(GST_CHILD_PROXY(pipeline.Get("out").get()), "sink_0::priority", &priority,
                        nullptr);
    EXPECT_EQ(priority, 3) << name;
  }
}

TEST(ScreamBins, ForwardPadPropertiesToTheController) {
  const ElementPtr sink(gst_element_factory_make("screamsink", nullptr));
  gst_object_ref_sink(sink.get());
  const PadPtr pad(gst_element_request_pad_simple(sink.get(), "sink_%u"));
  ASSERT_TRUE(pad);
  g_object_set(pad.get(), "priority", 0.5, "max-bitrate", 123456, nullptr);
  const ElementPtr tx(gst_bin_get_by_name(GST_BIN(sink.get()), "screamtx"));
  const PadPtr inner(gst_element_get_static_pad(tx.get(), "sink_0"));
  gdouble priority = 0;
  guint max = 0;
  g_object_get(inner.get(), "priority", &priority, "max-bitrate", &max, nullptr);
  EXPECT_EQ(priority, 0.5);
  EXPECT_EQ(max, 123456U);
  gst_element_release_request_pad(sink.get(), pad.get());
  EXPECT_FALSE(PadPtr(gst_element_get_static_pad(tx.get(), "sink_0")));
}

}  // namespace
}  // namespace lidar::test
