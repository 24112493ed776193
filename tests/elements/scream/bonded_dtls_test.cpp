// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests in which screamsink and screamsrc agree on a key by DTLS, over two links or one.
#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <thread>

#include "gst/net/udp_socket.h"
#include "tests/elements/scream/bonded_ends.h"
#include "tests/support/free_ports.h"
#include "tests/support/test_certificates.h"

namespace lidar::test {
namespace {

const TestCertificates& Papers() {
  static const TestCertificates made({"robot", "edge", "stranger"});
  return made;
}
std::string OfEdge() { return Papers().Trusting("edge", "robot"); }
std::string OfRobot() { return Papers().Trusting("robot", "edge"); }

/// A case of the test below: one of the two links dies after it has carried `left` datagrams. The
/// values are such that it dies before the hello, within the hello, within the handshake, after the
/// handshake, and after some packets.
struct Death {
  int left;
  bool of_first = false;  // false: the second link dies
};
class BondedDtls : public ::testing::TestWithParam<Death> {};

TEST_P(BondedDtls, GoesOnOverOneLinkWhereTheOtherDies) {
  BondReceiver receiver(OfEdge());
  Router router(receiver.port);
  router.left = GetParam().left;
  const std::string links = router.Addresses();
  const auto comma = links.find(',');
  const std::string swapped = links.substr(comma + 1) + "," + links.substr(0, comma);
  Pipeline sender(Bonded(GetParam().of_first ? swapped : links, OfRobot()));
  const ElementPtr out = sender.Get("out"), in = receiver.pipeline.Get("in");
  // While this many packets arrive after the death, packets of the dead link can be sent again over
  // the other link.
  constexpr guint kAfterDeath = 100;
  std::optional<guint> at_death;
  Stream(sender, receiver, [&] {
    if (router.left < 0 && !at_death) at_death = receiver.passed;
    return at_death && receiver.passed >= *at_death + kAfterDeath &&
           OfAllLinks(out.get(), "feedback-accepted") > 10;
  });
  // On a busy machine some packets of the dead link may be too old to be sent again over the other
  // link.
  EXPECT_LT(PacketsOf(out.get()) - receiver.passed, kAfterDeath / 2);
  EXPECT_EQ(Stats(out.get())["dtls-handshakes"], 1U);
  EXPECT_EQ(Stats(in.get())["dtls-handshakes"], 1U);
  EXPECT_EQ(Stats(out.get())["srtp-refused"], 0U);
}
INSTANTIATE_TEST_SUITE_P(After, BondedDtls,
                         ::testing::Values(Death{0}, Death{1}, Death{5}, Death{12}, Death{100},
                                           Death{0, true}));

TEST(Dtls, BothLinksCarryWhatOneHandshakeProtects) {
  BondReceiver receiver(OfEdge());
  const std::string to = "127.0.0.1:" + receiver.port;
  Pipeline sender(
      Bonded(to + "@127.0.0.1," + to + "@127.0.0.2", "bonding-method=broadcast" + OfRobot()));
  const ElementPtr out = sender.Get("out"), in = receiver.pipeline.Get("in");
  Stream(sender, receiver, [&] {
    return receiver.passed >= 100 && BothHear(out.get()) && Stats(in.get())["srtp-copies"] > 50;
  });
  ExpectAllPassed(receiver, sender, PacketsOf(out.get()));
  EXPECT_EQ(OfLinks(out.get(), "packets-lost"), (std::vector<guint64>{0, 0}));
}

TEST(Dtls, TakesTheEdgeThatRestartsByAnotherHandshake) {
  auto receiver = std::make_unique<BondReceiver>(OfEdge() + " port=" + std::to_string(FreePort()));
  Router router(receiver->port);
  Pipeline sender(Bonded(router.Addresses(), OfRobot()));
  const ElementPtr out = sender.Get("out");
  g_object_set(sender.Get("src").get(), "num-buffers", -1, nullptr);
  sender.Play();
  ASSERT_TRUE(Eventually([&] { return receiver->passed >= 50; }));
  const ElementPtr in = receiver->pipeline.Get("in");
  gst_element_set_state(in.get(), GST_STATE_NULL);
  const guint before = receiver->passed;
  gst_element_set_state(in.get(), GST_STATE_PLAYING);
  EXPECT_TRUE(Eventually([&] { return receiver->passed >= before + 50; }));
  EXPECT_EQ(Stats(out.get())["dtls-handshakes"], 2U);
}

TEST(Dtls, RefusesAStrangerAndStillTakesTheRobot) {
  BondReceiver receiver(OfEdge());
  const ElementPtr in = receiver.pipeline.Get("in");
  const std::string to = "127.0.0.1:" + receiver.port;
  {
    Pipeline stranger(kBondedAudio + "screamsink port=" + receiver.port +
                      Papers().Trusting("stranger", "edge"));
    g_object_set(stranger.Get("src").get(), "num-buffers", -1, nullptr);
    stranger.Play();
    const MessagePtr message = receiver.pipeline.Wait(GST_MESSAGE_WARNING);
    ASSERT_TRUE(message);
    EXPECT_NE(MessageText(message.get()).find("its certificate is not the one to trust"),
              std::string::npos);
    EXPECT_GE(Stats(in.get())["dtls-refused"], 1U);
  }
  EXPECT_EQ(receiver.passed, 0U);
  EXPECT_EQ(Stats(in.get())["dtls-handshakes"], 0U);
  Pipeline sender(kBondedAudio + "screamsink name=out port=" + receiver.port + OfRobot());
  Stream(sender, receiver, [&] { return receiver.passed >= 100; });
  EXPECT_EQ(Stats(in.get())["dtls-handshakes"], 1U);
}

TEST(Dtls, ARobotRefusesAnotherEdge) {
  BondReceiver receiver(Papers().Trusting("stranger", "robot"));
  Pipeline sender(kBondedAudio + "screamsink name=out port=" + receiver.port + OfRobot());
  g_object_set(sender.Get("src").get(), "num-buffers", -1, nullptr);
  sender.Play();
  const MessagePtr message = sender.Wait(GST_MESSAGE_WARNING);
  ASSERT_TRUE(message);
  EXPECT_NE(MessageText(message.get()).find("its certificate is not the one to trust"),
            std::string::npos);
  EXPECT_TRUE(Eventually([&] { return Stats(sender.Get("out").get())["packets-unkeyed"] > 0; }));
  EXPECT_GE(Stats(sender.Get("out").get())["dtls-refused"], 1U);
  EXPECT_EQ(Stats(sender.Get("out").get())["dtls-handshakes"], 0U);
  EXPECT_EQ(Stats(sender.Get("out").get())["packets-sent"], 0U) << "nothing leaves without a key";
  EXPECT_EQ(Stats(sender.Get("out").get())["dtls-dropped"], 0U);
}

TEST(Dtls, ShakesHandsWhileItPlaysOnly) {
  const gst::SocketPtr edge(
      gst::OpenUdpSocket({"127.0.0.1", 0, G_SOCKET_FAMILY_INVALID, false}, nullptr));
  const gst::SocketAddressPtr address(g_socket_get_local_address(edge.get(), nullptr));
  const auto port = g_inet_socket_address_get_port(G_INET_SOCKET_ADDRESS(address.get()));
  Pipeline sender(kBondedAudio + "screamsink name=out port=" + std::to_string(port) + OfRobot());
  char bytes[2'000];
  const auto heard = [&] {
    return g_socket_receive(edge.get(), bytes, sizeof bytes, nullptr, nullptr) > 0;
  };
  for (const GstState state : {GST_STATE_READY, GST_STATE_PAUSED}) {
    sender.Set(state);
    g_usleep(200'000);
    EXPECT_FALSE(heard()) << "no answer would be read";
  }
  sender.Play();
  EXPECT_TRUE(Eventually(heard));
  sender.Set(GST_STATE_PAUSED);
  g_usleep(100'000);
  while (heard()) continue;
  g_usleep(1'500'000);
  EXPECT_FALSE(heard()) << "a hello that is repeated after 1 s";
}

TEST(Dtls, NoHelloOfALinkLeavesByAnotherInterface) {
  std::vector<gst::SocketPtr> edges;
  std::string links;
  for (const std::string interface : {"none0", "lo"}) {
    edges.emplace_back(
        gst::OpenUdpSocket({"127.0.0.1", 0, G_SOCKET_FAMILY_INVALID, false}, nullptr));
    const gst::SocketAddressPtr address(g_socket_get_local_address(edges.back().get(), nullptr));
    const auto port = g_inet_socket_address_get_port(G_INET_SOCKET_ADDRESS(address.get()));
    links +=
        (links.empty() ? "127.0.0.1:" : ",127.0.0.1:") + std::to_string(port) + "@" + interface;
  }
  Pipeline sender(Bonded(links, OfRobot()));
  char bytes[2'000];
  const auto heard = [&](const gst::SocketPtr& edge) {
    return g_socket_receive(edge.get(), bytes, sizeof bytes, nullptr, nullptr) > 0;
  };
  sender.Play();
  ASSERT_TRUE(Eventually([&] { return heard(edges[1]); }));
  EXPECT_FALSE(heard(edges[0])) << "it would have left first";
}

TEST(Dtls, WhatIsNotLiveWaitsForTheKeyAndLosesNothing) {
  BondReceiver receiver(OfEdge());
  receiver.pipeline.Set(GST_STATE_PAUSED);
  Pipeline sender(
      "audiotestsrc num-buffers=20 samplesperbuffer=441 ! "
      "audio/x-raw,rate=44100,channels=1,format=S16BE ! rtpL16pay ! screamsink name=out port=" +
      receiver.port + " " + kPatientQueue + OfRobot());
  sender.Play();
  g_usleep(300'000);
  EXPECT_EQ(Stats(sender.Get("out").get())["packets-unkeyed"], 0U);
  receiver.pipeline.Play();
  EXPECT_TRUE(sender.Ends());
  EXPECT_TRUE(receiver.pipeline.Ends());
  EXPECT_EQ(receiver.passed, 20U);
}

/// A pad that pushes packets into a screamsink, and answers that its stream is not live.
class WaitingSource {
 public:
  explicit WaitingSource(GstElement* sink) : sink_(sink) {
    gst_element_set_state(sink, GST_STATE_PLAYING);
    entry_.reset(gst_element_request_pad_simple(sink, "sink_0"));
    gst_pad_set_query_function(src_.get(), [](GstPad*, GstObject*, GstQuery* query) -> gboolean {
      if (GST_QUERY_TYPE(query) != GST_QUERY_LATENCY) return FALSE;
      gst_query_set_latency(query, FALSE, 0, GST_CLOCK_TIME_NONE);
      return TRUE;
    });
    gst_pad_set_active(src_.get(), TRUE);
    gst_pad_link(src_.get(), entry_.get());
    const gst::CapsPtr caps(gst_caps_from_string(
        "application/x-rtp,media=audio,clock-rate=44100,encoding-name=L16,payload=96"));
    gst_pad_push_event(src_.get(), gst_event_new_stream_start("source"));
    gst_pad_push_event(src_.get(), gst_event_new_caps(caps.get()));
    gst_pad_push_event(src_.get(), NewSegment());
  }
  /// Pushes a packet, and calls `wake` while the push is blocked. Returns the result of the push.
  GstFlowReturn PushUntil(const std::function<void()>& wake) {
    std::atomic<bool> is_done{false};
    GstFlowReturn flow = GST_FLOW_OK;
    std::thread pusher([&] {
      flow = gst_pad_push(src_.get(), NewRtp({}));
      is_done = true;
    });
    EXPECT_TRUE(Eventually([&] { return gst_pad_is_blocking(entry_.get()) != FALSE; }));
    EXPECT_FALSE(is_done);
    wake();
    pusher.join();
    return flow;
  }
  GstPad* src() { return src_.get(); }
  void Release() { gst_element_release_request_pad(sink_, entry_.get()); }

 private:
  GstElement* sink_;
  gst::PadPtr src_{GST_PAD(gst_object_ref_sink(gst_pad_new("src", GST_PAD_SRC)))};
  gst::PadPtr entry_;
};

TEST(Dtls, AFlushAndAStopAndAReleasedPadEndTheWaitForTheKey) {
  const ElementPtr out(GST_ELEMENT(
      gst_object_ref_sink(gst_parse_launch(("screamsink port=9" + OfRobot()).c_str(), nullptr))));
  WaitingSource source(out.get());
  EXPECT_EQ(
      source.PushUntil([&] { gst_pad_push_event(source.src(), gst_event_new_flush_start()); }),
      GST_FLOW_FLUSHING);
  gst_pad_push_event(source.src(), gst_event_new_flush_stop(TRUE));
  gst_pad_push_event(source.src(), NewSegment());
  EXPECT_EQ(source.PushUntil([&] { source.Release(); }), GST_FLOW_FLUSHING);
  WaitingSource next(out.get());
  EXPECT_EQ(next.PushUntil([&] { gst_element_set_state(out.get(), GST_STATE_NULL); }),
            GST_FLOW_FLUSHING);
}

TEST(Dtls, FailsWithAWordWhereItCannotStart) {
  const std::string no_file = Papers().Public("nobody"), key = std::string(60, '5');
  const std::pair<std::string, const char*> wrong[] = {
      {"dtls-certificate=" + Papers().WithKey("robot"), "must be set together"},
      {OfRobot() + "srtp-key=" + key, "srtp-key cannot be set together with dtls-certificate"},
      {OfRobot() + "srtp-cipher=aes-256-icm", "aes-128-icm"},
      {"dtls-certificate=" + no_file + " dtls-peer-certificate=" + no_file, "nobody"},
      {"dtls-certificate=" + Papers().Public("robot") +
           " dtls-peer-certificate=" + Papers().Public("edge"),
       "private key"},
  };
  for (const auto& [properties, word] : wrong) {
    Pipeline sender(kBondedAudio + "screamsink port=5004 " + properties);
    sender.Play();
    const MessagePtr message = sender.Wait(GST_MESSAGE_ERROR);
    ASSERT_TRUE(message) << properties;
    const std::string text = MessageText(message.get());
    EXPECT_NE(text.find(word), std::string::npos) << text;
  }
}

TEST(Dtls, AKeyIsNotTakenFromElsewhere) {
  BondReceiver receiver(OfEdge());
  g_object_set(receiver.pipeline.Get("in").get(), "srtp-key", std::string(60, '5').c_str(),
               nullptr);
  const MessagePtr message = receiver.pipeline.Wait(GST_MESSAGE_WARNING);
  ASSERT_TRUE(message);
  EXPECT_EQ(MessageText(message.get()), "The SRTP key stays as it is: DTLS negotiates the keys.");
}

}  // namespace
}  // namespace lidar::test
