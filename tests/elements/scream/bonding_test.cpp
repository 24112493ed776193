// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of screamsink that sends over several links to one screamsrc, with sockets of the loopback
// interface.
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <atomic>
#include <string>
#include <utility>

#include "gst/scream/bond/addresses.h"
#include "tests/elements/scream/bonded_ends.h"
#include "tests/elements/scream/rtp_support.h"
#include "tests/support/ipv6.h"

static std::atomic<bool> loopback_has_carrier{true}, loopback_has_ipv4{true},
    loopback_has_ipv6{true};

/// Replaces libc's function in this program and in the plugins that it loads. Changes what the
/// function reports about the loopback interface.
extern "C" int getifaddrs(ifaddrs** first) noexcept {
  using Get = int (*)(ifaddrs**);
  static const auto next = reinterpret_cast<Get>(dlsym(RTLD_NEXT, "getifaddrs"));
  if (next(first) != 0) return -1;
  for (ifaddrs* a = *first; a != nullptr; a = a->ifa_next) {
    if (std::string(a->ifa_name) != "lo") continue;
    if (!loopback_has_carrier) a->ifa_flags &= ~static_cast<unsigned>(IFF_RUNNING);
    const int family = a->ifa_addr != nullptr ? a->ifa_addr->sa_family : AF_UNSPEC;
    if (!loopback_has_ipv4 && family == AF_INET) a->ifa_addr = nullptr;
    if (!loopback_has_ipv6 && family == AF_INET6) a->ifa_addr = nullptr;
  }
  return 0;
}

namespace lidar::test {
namespace {

using gst::ParseBondAddresses;

bool Warns(Pipeline& pipeline, const char* text) {
  const MessagePtr message =
      pipeline.Wait(GST_MESSAGE_WARNING | GST_MESSAGE_ERROR | GST_MESSAGE_EOS);
  if (!message || GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_EOS) return false;
  const std::string words = MessageText(message.get());
  EXPECT_NE(words.find(text), std::string::npos) << words;
  return true;
}

TEST(Bonding, EachPacketPassesOnceOverTwoLinks) {
  BondReceiver receiver;
  const std::string to = "127.0.0.1:" + receiver.port;
  Pipeline sender(Bonded(to + "@127.0.0.1, " + to + "@127.0.0.2"));
  sender.Play();
  EXPECT_TRUE(sender.Ends());
  EXPECT_TRUE(receiver.pipeline.Ends());
  ExpectAllPassed(receiver, sender, 150);
  const ElementPtr out = sender.Get("out"), in = receiver.pipeline.Get("in");
  const auto accepted = OfLinks(out.get(), "feedback-accepted");
  ASSERT_EQ(accepted.size(), 2U);
  EXPECT_GT(accepted[0], 10U);
  EXPECT_GT(accepted[1], 10U);
  EXPECT_EQ(OfLinks(out.get(), "feedback-ignored"), (std::vector<guint64>{0, 0}));
  const auto received = OfLinks(in.get(), "packets-received");
  ASSERT_EQ(received.size(), 2U);
  EXPECT_EQ(received[0] + received[1] - Stats(in.get())["packets-copies"], receiver.passed);
}

TEST(Bonding, BroadcastsWhereAskedTo) {
  BondReceiver receiver;
  const std::string to = "127.0.0.1:" + receiver.port;
  Pipeline sender(Bonded(to + "@127.0.0.1," + to + "@127.0.0.2", "bonding-method=broadcast"));
  sender.Play();
  EXPECT_TRUE(sender.Ends());
  EXPECT_TRUE(receiver.pipeline.Ends());
  ExpectAllPassed(receiver, sender, 150);
  const auto first = OfLinks(sender.Get("out").get(), "packets-first");
  const auto copies = OfLinks(sender.Get("out").get(), "packets-copies");
  EXPECT_EQ(first[0] + first[1], 150U);
  EXPECT_EQ(copies[0] + copies[1], 150U);
}

TEST(Bonding, GoesOnWhereTheFirstLinkAndAnotherAreDead) {
  BondReceiver receiver;
  const std::string to = "127.0.0.1:" + receiver.port;
  Pipeline sender(Bonded("127.0.0.1:9@127.0.0.1," + to + "@127.0.0.2,127.0.0.1:9@127.0.0.3"));
  sender.Play();
  EXPECT_TRUE(sender.Ends());
  EXPECT_TRUE(receiver.pipeline.Ends());
  ExpectAllPassed(receiver, sender, 150);
}

TEST(Bonding, GoesOnWithoutALinkWhoseInterfaceIsMissingAndSaysSo) {
  BondReceiver receiver;
  const std::string to = "127.0.0.1:" + receiver.port;
  Pipeline sender(Bonded(to + "@none0," + to + "@lo"));
  sender.Play();
  EXPECT_TRUE(Warns(sender, "none0"));
  EXPECT_TRUE(sender.Ends());
  EXPECT_TRUE(receiver.pipeline.Ends());
  ExpectAllPassed(receiver, sender, 150);
  const auto sent = OfLinks(sender.Get("out").get(), "packets-first");
  ASSERT_EQ(sent.size(), 2U);
  EXPECT_EQ(sent[0], 0U);
  EXPECT_EQ(sent[1], 150U);
}

TEST(Bonding, SaysWhatTheInterfaceOfALinkLacks) {
  struct Case {
    bool carrier, ipv4;
    std::string trouble;
  };
  const ElementPtr sink(gst_element_factory_make("screamsink", nullptr));
  gst_object_ref_sink(sink.get());
  const ElementBus bus(sink.get());
  g_object_set(sink.get(), "bonding-addresses", "127.0.0.1:9@127.0.0.1,127.0.0.1:9@lo", nullptr);
  for (const Case& c : {Case{true, true, ""}, Case{false, true, "the interface lo is down"},
                        Case{true, false, "the interface lo has no IPv4 address"}}) {
    loopback_has_carrier = c.carrier;
    loopback_has_ipv4 = c.ipv4;
    EXPECT_EQ(gst_element_set_state(sink.get(), GST_STATE_READY), GST_STATE_CHANGE_SUCCESS);
    EXPECT_EQ(
        bus.Text(GST_MESSAGE_WARNING),
        c.trouble.empty() ? "" : "The link 127.0.0.1:9@lo cannot be used: " + c.trouble + ".");
    gst_element_set_state(sink.get(), GST_STATE_NULL);
  }
  loopback_has_carrier = loopback_has_ipv4 = true;
}

TEST(Bonding, SaysThatNoInterfaceHasTheLocalAddressOfALink) {
  if (!HasIpv6()) GTEST_SKIP() << "no IPv6 here";
  const ElementPtr sink(gst_element_factory_make("screamsink", nullptr));
  gst_object_ref_sink(sink.get());
  const ElementBus bus(sink.get());
  g_object_set(sink.get(), "bonding-addresses", "127.0.0.1:9@127.0.0.1,[::1]:9@::1", nullptr);
  for (const bool has_it : {true, false}) {
    loopback_has_ipv6 = has_it;
    EXPECT_EQ(gst_element_set_state(sink.get(), GST_STATE_READY), GST_STATE_CHANGE_SUCCESS);
    EXPECT_EQ(
        bus.Text(GST_MESSAGE_WARNING),
        has_it ? "" : "The link [::1]:9@::1 cannot be used: no interface has the address ::1.");
    gst_element_set_state(sink.get(), GST_STATE_NULL);
  }
  loopback_has_ipv6 = true;
}

TEST(Bonding, GoesOnWhereTheFeedbackOfTwoLinksIsSwapped) {
  BondReceiver receiver;
  Router router(receiver.port);
  Pipeline sender(Bonded(router.Addresses(), "bonding-method=backup"));
  const ElementPtr out = sender.Get("out");
  Stream(sender, receiver, [&] {
    router.swaps = receiver.passed >= 50;
    // A link ignores feedback about packets that it never sent.
    return receiver.passed >= 150 && OfAllLinks(out.get(), "feedback-ignored") > 0;
  });
  ExpectAllPassed(receiver, sender, PacketsOf(out.get()));
}

TEST(Bonding, GoesOnWhereFeedbackOfALinkNeverComes) {
  BondReceiver receiver;
  Router router(receiver.port);
  router.mutes = true;
  Pipeline sender(Bonded(router.Addresses()));
  const ElementPtr out = sender.Get("out");
  Stream(sender, receiver, [&] {
    EXPECT_TRUE(Eventually([&] { return OfLinks(out.get(), "feedback-accepted")[0] > 10; }));
    const guint64 first = OfLinks(out.get(), "packets-first")[1], before = PacketsOf(out.get());
    EXPECT_TRUE(Eventually([&] { return PacketsOf(out.get()) >= before + 100; }));
    EXPECT_EQ(OfLinks(out.get(), "packets-first")[1], first) << "it has proved nothing";
    return true;
  });
  ExpectAllPassed(receiver, sender, PacketsOf(out.get()));
  EXPECT_EQ(OfLinks(out.get(), "feedback-accepted")[1], 0U);
}

TEST(Bonding, GoesOnWhereTheAddressOfALinkChangesEachSecond) {
  BondReceiver receiver;
  Router router(receiver.port);
  router.moves_each_ms = 1'000;
  Pipeline sender(Bonded(router.Addresses()));
  const ElementPtr out = sender.Get("out"), in = receiver.pipeline.Get("in");
  Stream(sender, receiver, [&] {
    return router.moves >= 4 && receiver.passed >= 450 &&
           OfLinks(out.get(), "feedback-accepted")[1] > 50;  // each address is answered
  });
  // Each time the router changes the address of link 1, it loses the datagrams that wait in the old
  // socket.
  EXPECT_GE(receiver.passed, PacketsOf(out.get()) * 9 / 10);
  EXPECT_EQ(OfLinks(out.get(), "packets-sent").size(), 2U);
  EXPECT_LE(OfLinks(in.get(), "packets-received").size(), 4U);
}

TEST(Bonding, ShowsEachLinksFigures) {
  BondReceiver receiver;
  Router router(receiver.port);
  Pipeline sender(Bonded(router.Addresses()));
  const ElementPtr out = sender.Get("out");
  const auto of_link = [&](const char* field, std::size_t i) {
    return OfLinks(out.get(), field)[i];
  };
  Stream(sender, receiver, [&] {
    EXPECT_TRUE(Eventually([&] {
      return receiver.passed >= 40 &&
             of_link("packets-first", 1) + of_link("packets-copies", 1) > 20;
    }));
    router.loses = true;  // link 1 loses all media until the end
    const guint64 sent = of_link("packets-sent", 1);
    return Eventually([&] {
      return of_link("packets-sent", 1) > sent && of_link("link-gaps", 1) > 0 &&
             of_link("packets-first", 0) > of_link("packets-first", 1) &&
             of_link("packets-copies", 1) > 20 && of_link("copies-cancelled", 1) > 0 &&
             of_link("packets-acked", 0) > of_link("packets-acked", 1) + 50;
    });
  });
  ExpectAllPassed(receiver, sender, PacketsOf(out.get()));
  EXPECT_TRUE(Eventually([&] { return Stats(out.get()).Of("links", 1).True("in-gap"); }));
  const Stats all(out.get());
  const Stats links[] = {all.Of("links", 0), all.Of("links", 1)};
  const std::string addresses = router.Addresses();
  EXPECT_EQ(links[0].Text("link") + "," + links[1].Text("link"), addresses);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LE(links[i]["packets-sent"] + links[i]["copies-cancelled"],
              links[i]["packets-first"] + links[i]["packets-copies"]);
    EXPECT_EQ(links[i]["bottleneck"], i);
    EXPECT_EQ(links[i]["send-errors"], 0U);
    EXPECT_GE(links[i]["packets-sent"], links[i]["packets-acked"]);
    EXPECT_TRUE(links[i].True("usable"));
  }
  EXPECT_EQ(all["packets-sent"], links[0]["packets-sent"]) << "the first link's";
}

TEST(Bonding, WhatOneLinkDeliveredLeavesTheQueueOfTheOtherAndWhatNoneDidStays) {
  BondReceiver receiver;
  Router router(receiver.port);
  Pipeline sender(
      Bonded(router.Addresses(), "bonding-method=broadcast max-queue-delay=5000000000"));
  const ElementPtr out = sender.Get("out");
  const auto of_link = [&](const char* field, std::size_t i) {
    return OfLinks(out.get(), field)[i];
  };
  Stream(sender, receiver, [&] {
    EXPECT_TRUE(Eventually([&] { return receiver.passed >= 40; }));
    router.loses = true;  // the window of link 1 fills, and its copies wait
    const guint64 cancelled = of_link("copies-cancelled", 1);
    return Eventually([&] { return of_link("copies-cancelled", 1) > cancelled + 30; });
  });
  const guint64 count = PacketsOf(out.get());
  ExpectAllPassed(receiver, sender, count);
  for (const std::size_t i : {0U, 1U}) {
    EXPECT_GE(of_link("packets-dropped", i), of_link("copies-cancelled", i)) << i;
    EXPECT_EQ(of_link("packets-sent", i) + of_link("packets-dropped", i), count) << i;
  }
}

TEST(Bonding, WhatIsLateOnAllLinksLeavesTheirQueuesAndNewerPacketsGoOn) {
  BondReceiver receiver;
  Router router(receiver.port);
  Pipeline sender(
      Bonded(router.Addresses(), "bonding-method=broadcast max-queue-delay=5000000000"));
  const ElementPtr out = sender.Get("out");
  const auto late = [&](std::size_t i) {
    return OfLinks(out.get(), "packets-dropped")[i] - OfLinks(out.get(), "copies-cancelled")[i];
  };
  Stream(sender, receiver, [&] {
    EXPECT_TRUE(Eventually([&] { return receiver.passed >= 40; }));
    router.dark = true;  // both windows fill, and packets wait on both links
    EXPECT_TRUE(Eventually([&] { return std::min(late(0), late(1)) >= 20; }));
    router.dark = false;
    const guint before = receiver.passed;
    return Eventually([&] { return receiver.passed > before + 50; });
  });
  const guint64 count = PacketsOf(out.get());
  EXPECT_LE(receiver.passed, count - std::min(late(0), late(1)));
  for (const std::size_t i : {0U, 1U})
    EXPECT_EQ(OfLinks(out.get(), "packets-sent")[i] + OfLinks(out.get(), "packets-dropped")[i],
              count)
        << i;
}

TEST(Bonding, CarriesSlicesThatReferToOnesWhichArrivedByAnyLink) {
  Pipeline receiver(
      "screamsrc name=in port=0 ! rtplidardepay max-reorder-time=5000000000 "
      "! lidardec name=decoder ! fakesink sync=false");
  receiver.Play();
  const std::string to = "127.0.0.1:" + BoundPort(receiver);
  Pipeline sender(
      "lidartestsrc name=src is-live=true model=os1-32 mode=512x10 slices-per-scan=8 "
      "! lidarenc name=encoder effort=1 max-error=0.05 ! rtplidarpay ! screamsink "
      "bonding-addresses=\"" +
      to + "@127.0.0.1," + to + "@127.0.0.2\"");
  sender.Play();
  const ElementPtr encoder = sender.Get("encoder");
  const auto refers = [&] { return Stats(encoder.get()).Text("mode") == "range-temporal1"; };
  EXPECT_TRUE(Eventually(refers));
  const ElementPtr decoder = receiver.Get("decoder");
  const guint64 from = Stats(decoder.get())["slices"];
  EXPECT_TRUE(Eventually([&] { return Stats(decoder.get())["slices"] >= from + 80; }));
  sender.SendEos();
  EXPECT_TRUE(sender.Ends());
  EXPECT_TRUE(receiver.Ends());
  EXPECT_EQ(Stats(decoder.get())["slices-unreferenced"], 0U);
  EXPECT_EQ(Stats(decoder.get())["slices-dropped"], 0U);
}

TEST(Bonding, GivesAVideoEncoderItsBitrate) {
  Pipeline receiver(
      "screamsrc name=in port=0 caps=\"application/x-rtp,media=video,encoding-name=H264,"
      "clock-rate=90000,payload=96\" ! fakesink sync=false");
  receiver.Play();
  const std::string to = "127.0.0.1:" + BoundPort(receiver);
  Pipeline sender(
      "videotestsrc is-live=true num-buffers=60 ! video/x-raw,width=320,height=240,framerate=60/1 "
      "! openh264enc name=encoder bitrate=128000 rate-control=bitrate ! bitrateadapter "
      "min=300000 max=1000000 ! h264parse ! rtph264pay ! screamsink name=out "
      "start-bitrate=2000000 bonding-addresses=\"" +
      to + "@127.0.0.1," + to + "@127.0.0.2\"");
  sender.Play();
  EXPECT_TRUE(sender.Ends());
  EXPECT_TRUE(receiver.Ends());
  guint bitrate = 0;
  g_object_get(sender.Get("encoder").get(), "bitrate", &bitrate, nullptr);
  EXPECT_GE(bitrate, 300000U);
  EXPECT_EQ(OfLinks(sender.Get("out").get(), "packets-sent").size(), 2U);
}

TEST(Bonding, FailsWhereNoLinkCanBeUsed) {
  Pipeline sender(Bonded("127.0.0.1:5004@none0,127.0.0.1:5004@none1"));
  sender.Play();
  EXPECT_TRUE(Warns(sender, "none0"));
  EXPECT_TRUE(Warns(sender, "none1"));
  EXPECT_TRUE(Warns(sender, "No link"));
}

TEST(Bonding, SaysWhyTheSocketOfALinkDoesNotOpen) {
  Pipeline sender(Bonded("127.0.0.1:5004@203.0.113.9"));  // no machine has this address
  sender.Play();
  EXPECT_TRUE(Warns(sender, "The link 127.0.0.1:5004@203.0.113.9 cannot be used: Error binding"));
  EXPECT_TRUE(Warns(sender, "No link can be used: Error binding"));
}

class BondedSrtp : public ::testing::TestWithParam<const char*> {};

/// Sends an RTP packet without SRTP to the local `port`.
void SendPlain(const std::string& port) {
  GSocket* socket =
      g_socket_new(G_SOCKET_FAMILY_IPV4, G_SOCKET_TYPE_DATAGRAM, G_SOCKET_PROTOCOL_UDP, nullptr);
  GSocketAddress* from = Address("127.0.0.3", 0);
  GSocketAddress* to = Address("127.0.0.1", static_cast<guint>(std::stoi(port)));
  EXPECT_TRUE(g_socket_bind(socket, from, FALSE, nullptr));
  const auto bytes = ToBytes(gst::BufferPtr(NewRtp({})).get());
  g_socket_send_to(socket, to, reinterpret_cast<const char*>(bytes.data()), bytes.size(), nullptr,
                   nullptr);
  for (GObject* object : {G_OBJECT(socket), G_OBJECT(from), G_OBJECT(to)}) g_object_unref(object);
}

TEST_P(BondedSrtp, EachPacketPassesOnceAndEachLinkIsHeardOf) {
  BondReceiver receiver(GetParam());
  // The receiver expects copies only after a second address has sent. This packet makes the first
  // link's address the second.
  SendPlain(receiver.port);
  const std::string to = "127.0.0.1:" + receiver.port;
  Pipeline sender(Bonded(to + "@127.0.0.1," + to + "@127.0.0.2",
                         std::string("bonding-method=broadcast ") + GetParam()));
  const ElementPtr out = sender.Get("out"), in = receiver.pipeline.Get("in");
  g_object_set(out.get(), "sender-report-interval", guint64{100'000'000}, nullptr);
  Stream(sender, receiver, [&] {
    return BothHear(out.get()) && Stats(in.get())["srtp-copies"] > 100 &&
           Stats(in.get())["packets-copies"] > 100;
  });
  ExpectAllPassed(receiver, sender, PacketsOf(out.get()));
  EXPECT_EQ(OfLinks(out.get(), "packets-lost"), (std::vector<guint64>{0, 0}));
  EXPECT_EQ(Stats(out.get())["srtp-refused"], 0U);
  // More packets may arrive between the two reads. So the smaller count is read first.
  const guint64 accepted = OfAllLinks(out.get(), "feedback-accepted");
  EXPECT_GE(Stats(out.get())["srtp-received"], accepted);
  const guint64 received = Stats(in.get())["packets-received"];
  EXPECT_GE(Stats(in.get())["srtp-received"], received);
  EXPECT_EQ(Stats(in.get())["srtp-refused"], 1U) << "the packet without SRTP";
  EXPECT_EQ(Stats(in.get())["goodbyes"], 1U);
}
INSTANTIATE_TEST_SUITE_P(Ciphers, BondedSrtp,
                         ::testing::Values("srtp-key=555555555555555555555555555555555555555555555"
                                           "555555555555555",
                                           "srtp-cipher=aes-128-gcm srtp-key=555555555555555555555"
                                           "55555555555555555555555555555555555"));

/// The receiver gets the new key first. It uses the key for feedback only after it has received
/// media with the new key.
TEST(Bonding, TakesANewKeyWithoutAGap) {
  const std::string old_key = std::string(60, '5'), new_key = std::string(60, '6');
  BondReceiver receiver("srtp-key=" + old_key);
  const std::string to = "127.0.0.1:" + receiver.port;
  Pipeline sender(Bonded(to + "@127.0.0.1," + to + "@127.0.0.2", "srtp-key=" + old_key));
  const ElementPtr out = sender.Get("out"), in = receiver.pipeline.Get("in");
  Stream(sender, receiver, [&] {
    EXPECT_TRUE(Eventually([&] { return receiver.passed >= 40; }));
    g_object_set(in.get(), "srtp-key", new_key.c_str(), nullptr);
    const guint64 accepted = Stats(out.get())["feedback-accepted"];
    EXPECT_TRUE(Eventually([&] { return Stats(out.get())["feedback-accepted"] >= accepted + 5; }));
    EXPECT_EQ(Stats(out.get())["srtp-key-changes"], 0U) << "feedback has the key of the media";
    g_object_set(out.get(), "srtp-key", new_key.c_str(), nullptr);
    const guint passed = receiver.passed;
    return Eventually(
        [&] { return receiver.passed >= passed + 40 && Stats(out.get())["srtp-key-changes"] > 0; });
  });
  ExpectAllPassed(receiver, sender, PacketsOf(out.get()));
  EXPECT_EQ(Stats(out.get())["srtp-key-changes"], 1U);
  EXPECT_EQ(Stats(in.get())["srtp-key-changes"], 1U);
  EXPECT_EQ(Stats(out.get())["srtp-refused"], 0U);
}

TEST(Bonding, StartsAgainAndWithOneLink) {
  BondReceiver receiver;
  const std::string to = "127.0.0.1:" + receiver.port;
  Pipeline sender(Bonded(to + "@127.0.0.1," + to + "@127.0.0.2", kPatientQueue));
  const ElementPtr out = sender.Get("out");
  g_object_set(sender.Get("src").get(), "num-buffers", 5, nullptr);
  for (int i = 0; i < 3; ++i) {
    gst_element_set_state(out.get(), GST_STATE_READY);
    EXPECT_EQ(GST_BIN_NUMCHILDREN(out.get()), 7);
    gst_element_set_state(out.get(), GST_STATE_NULL);
    EXPECT_EQ(GST_BIN_NUMCHILDREN(out.get()), 3);
  }
  g_object_set(out.get(), "bonding-addresses", (to + "@127.0.0.1").c_str(), nullptr);
  sender.Play();
  EXPECT_TRUE(sender.Ends());
  EXPECT_TRUE(receiver.pipeline.Ends());
  EXPECT_EQ(receiver.passed, 5U);
}

/// Returns the RTP datagrams that screamsink sends for a fixed piece of audio.
std::vector<std::string> Datagrams(const std::string& sink_options, const std::string& to_suffix) {
  GSocket* socket =
      g_socket_new(G_SOCKET_FAMILY_IPV4, G_SOCKET_TYPE_DATAGRAM, G_SOCKET_PROTOCOL_UDP, nullptr);
  GSocketAddress* any = g_inet_socket_address_new_from_string("127.0.0.1", 0);
  EXPECT_TRUE(g_socket_bind(socket, any, FALSE, nullptr));
  g_object_unref(any);
  GSocketAddress* local = g_socket_get_local_address(socket, nullptr);
  const std::string port =
      std::to_string(g_inet_socket_address_get_port(G_INET_SOCKET_ADDRESS(local)));
  g_object_unref(local);
  g_socket_set_timeout(socket, 5);
  Pipeline sender(
      "audiotestsrc num-buffers=20 samplesperbuffer=441 ! "
      "audio/x-raw,rate=44100,channels=1,format=S16BE ! rtpL16pay ssrc=7 seqnum-offset=65530 "
      "timestamp-offset=9 perfect-rtptime=true ! screamsink sender-report-interval=0 " +
      sink_options + port + to_suffix);
  sender.Play();
  EXPECT_TRUE(sender.Ends());
  std::vector<std::string> datagrams;
  for (;;) {
    char bytes[2'000];
    const gssize n = g_socket_receive(socket, bytes, sizeof bytes, nullptr, nullptr);
    const auto type = static_cast<guint8>(bytes[1]);
    if (n < 2 || (type >= 192 && type < 224)) break;  // stops at the sender's goodbye
    datagrams.emplace_back(bytes, static_cast<std::size_t>(n));
  }
  g_object_unref(socket);
  return datagrams;
}

TEST(Bonding, OneLinkSendsTheSameBytesAsWithoutBonding) {
  const auto plain = Datagrams("host=127.0.0.1 port=", "");
  EXPECT_EQ(plain.size(), 20U);
  EXPECT_TRUE(Datagrams("bonding-addresses=127.0.0.1:", "@127.0.0.1") == plain);
  EXPECT_TRUE(Datagrams("bonding-addresses=127.0.0.1:", "@lo") == plain);
}

TEST(Bonding, GivesPadsTheirShareOnEachLink) {
  Pipeline sender(Bonded("127.0.0.1:9@127.0.0.1,127.0.0.1:9@127.0.0.2", "sink_0::priority=3"));
  const ElementPtr out = sender.Get("out");
  gst_element_set_state(out.get(), GST_STATE_READY);
  const gst::PadPtr pad(gst_element_get_static_pad(out.get(), "sink_0"));
  for (const char* name : {"screamtx", "screamtx1"}) {
    const ElementPtr tx(gst_bin_get_by_name(GST_BIN(out.get()), name));
    const gst::PadPtr tx_pad(gst_element_get_static_pad(tx.get(), "sink_0"));
    gdouble priority = 0;
    g_object_get(tx_pad.get(), "priority", &priority, nullptr);
    EXPECT_EQ(priority, 3) << name;
    g_object_set(pad.get(), "max-bitrate", 2'000'000U, nullptr);
    guint max = 0;
    g_object_get(tx_pad.get(), "max-bitrate", &max, nullptr);
    EXPECT_EQ(max, 2'000'000U) << name;
  }
}

TEST(BondAddresses, AreHostPortAndWhatPacketsLeaveBy) {
  std::string error;
  const auto links =
      ParseBondAddresses("edge:5004@wwan0, [2001:db8::1]:7@2001:db8::2,10.0.0.1:9", &error);
  ASSERT_TRUE(links) << error;
  ASSERT_EQ(links->size(), 3U);
  EXPECT_EQ((*links)[0].target.host, "edge");
  EXPECT_EQ((*links)[0].target.port, 5004U);
  EXPECT_EQ((*links)[0].interface, "wwan0");
  EXPECT_EQ((*links)[1].target.host, "[2001:db8::1]");
  EXPECT_EQ((*links)[1].target.bind_address, "2001:db8::2");
  EXPECT_EQ((*links)[2].interface + (*links)[2].target.bind_address, "");
}

TEST(BondAddresses, MayHaveBlanksAroundEach) {
  std::string error;
  const auto links = ParseBondAddresses("  edge:1@lo  ,edge:2@lo ", &error);
  ASSERT_TRUE(links) << error;
  ASSERT_EQ(links->size(), 2U);
  for (const gst::BondAddress& link : *links) EXPECT_EQ(link.interface, "lo");
  EXPECT_EQ(links->front().text, "edge:1@lo") << "as it is shown";
}

// A local address is converted to the form in which the system returns the addresses of interfaces,
// because the two are compared.
TEST(BondAddresses, AreKeptInOneForm) {
  for (const char* local : {"fd00::2", "FD00::2", "fd00:0:0::2", "[fd00::2]"}) {
    std::string error;
    const auto links = ParseBondAddresses(std::string("[::1]:7@") + local, &error);
    ASSERT_TRUE(links) << error;
    EXPECT_EQ(links->front().target.bind_address, "fd00::2") << local;
    EXPECT_EQ(links->front().interface, "") << local;
  }
}

TEST(BondAddresses, KeepTheInterfaceOfALinkLocalAddress) {
  for (const char* local : {"fe80::2%wwan0", "[FE80::2%wwan0]"}) {
    std::string error;
    const auto links = ParseBondAddresses(std::string("edge:7@") + local, &error);
    ASSERT_TRUE(links) << error;
    EXPECT_EQ(links->front().target.bind_address, "fe80::2%wwan0");
    EXPECT_EQ(links->front().interface, "");
  }
}

TEST(BondAddresses, RefuseAllElseWithAWord) {
  const std::string no_link =
      "must be HOST:PORT or HOST:PORT@INTERFACE (an IPv6 address in brackets)";
  const std::string no_interface = "is neither the name of an interface nor an address";
  const std::string twice = "\"a:1\" is listed twice", count = "it must list 1 to 4 links";
  const std::pair<const char*, std::string> wrong[] = {
      {"", count},
      {",", "\"\" " + no_link},
      {"edge", "\"edge\" " + no_link},
      {"edge:", no_link},
      {"edge:0", no_link},
      {"edge:65536", no_link},
      {"edge:99999999999999999999", no_link},
      {"edge:5004@", "\"edge:5004@\": \"\" " + no_interface},
      {":5004", no_link},
      {"2001:db8::1:7", no_link},
      {"edge:5004@averyveryverylonginterface", no_interface},
      {"edge:5004@interface0123456", "\"interface0123456\" " + no_interface},
      {"a:1,a:1", twice},
      {"a:1, a:1", twice},
      {"a:1,b:1,c:1,d:1,e:1", count},
      {"a:1,,b:1", "\"\" " + no_link},
      {"edge:5004:wwan0", no_link},
      {"edge:-1", no_link},
  };
  for (const auto& [text, why] : wrong) {
    std::string error;
    EXPECT_FALSE(ParseBondAddresses(text, &error)) << text;
    EXPECT_NE(error.find(why), std::string::npos) << text << ": " << error;
  }
}

}  // namespace
}  // namespace lidar::test
