// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of ecnudpsink and ecnudpsrc with real sockets of the loopback interface.
#include <gio/gio.h>
#include <gst/net/gstnetaddressmeta.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <ctime>
#include <functional>
#include <string>
#include <thread>

#include "tests/elements/ecnudp/ecnudp_support.h"
#include "tests/support/element_bus.h"
#include "tests/support/ipv6.h"
#include "tests/support/patience.h"

static std::atomic<gint64> clock_ahead{0};  // added to g_get_real_time() [us]

/// Replaces GLib's function in this program and in the plugins that it loads.
extern "C" gint64 g_get_real_time() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return gint64{now.tv_sec} * G_USEC_PER_SEC + now.tv_nsec / 1'000 + clock_ahead;
}

namespace lidar::gst {
namespace {

using test::Harness;
using test::SetPlaying;

struct Family {
  const char* host;
  const char* address;
};
class Loopback : public ::testing::TestWithParam<Family> {
 protected:
  void SetUp() override {
    if (std::string(GetParam().host).find("::1") == std::string::npos || test::HasIpv6()) return;
    GTEST_SKIP() << "no IPv6 here";
  }
};

TEST_P(Loopback, EveryPacketArrivesWithItsOwnEcnCodepoint) {
  const Harness src = NewSource(GetParam().address);
  const Harness sink = NewSink(GetParam().host, LocalPort(src.get()));
  gst_util_set_object_arg(G_OBJECT(sink->element), "ecn", "ect0");
  const auto before = static_cast<GstClockTime>(g_get_real_time()) * GST_USECOND;
  GstBufferList* list = gst_buffer_list_new();
  for (guint i = 0; i < 4; ++i) {
    GstBuffer* buffer = Payload("packet " + std::to_string(i));
    gst_lidar_buffer_set_ecn(buffer, static_cast<GstLidarEcn>(i), GST_CLOCK_TIME_NONE);
    gst_buffer_list_add(list, buffer);
  }
  // This buffer has no meta, so the property applies.
  gst_buffer_list_add(list, Payload("packet 4"));
  ASSERT_EQ(gst_pad_push_list(sink->srcpad, list), GST_FLOW_OK);
  for (guint i = 0; i < 5; ++i) {
    const BufferPtr got(gst_harness_pull(src.get()));
    ASSERT_TRUE(got) << i;
    EXPECT_EQ(Text(got.get()), "packet " + std::to_string(i));
    GstLidarEcn ecn{};
    GstClockTime arrival = 0;
    ASSERT_TRUE(gst_lidar_buffer_get_ecn(got.get(), &ecn, &arrival));
    EXPECT_EQ(static_cast<guint>(ecn), i < 4 ? i : guint{GST_LIDAR_ECN_ECT0});
    EXPECT_GE(arrival + GST_USECOND, before);
    EXPECT_LT(arrival, before + 10 * GST_SECOND);
    EXPECT_TRUE(gst_buffer_get_net_address_meta(got.get()) != nullptr);
  }
  EXPECT_EQ(Stat(sink.get(), "packets-sent"), 5U);
  EXPECT_EQ(Stat(src.get(), "packets-received"), 5U);
  EXPECT_EQ(Stat(src.get(), "packets-ce"), 1U);
}

INSTANTIATE_TEST_SUITE_P(Families, Loopback,
                         ::testing::Values(Family{"127.0.0.1", nullptr},
                                           Family{"127.0.0.1", "127.0.0.1"}, Family{"::1", nullptr},
                                           Family{"[::1]", "::1"}, Family{"localhost", nullptr}));

TEST(EcnUdp, BatchesLargerThanOneSystemCallArriveWholeAndInOrder) {
  const Harness src = NewSource();
  const Harness sink = NewSink("127.0.0.1", LocalPort(src.get()));
  GstBufferList* list = gst_buffer_list_new();
  for (guint i = 0; i < 150; ++i) gst_buffer_list_add(list, Payload(std::to_string(i)));
  ASSERT_EQ(gst_pad_push_list(sink->srcpad, list), GST_FLOW_OK);
  for (guint i = 0; i < 150; ++i) {
    const BufferPtr got(gst_harness_pull(src.get()));
    ASSERT_TRUE(got);
    EXPECT_EQ(Text(got.get()), std::to_string(i));
  }
}

/// When the first run stops, the source is handling a batch, and the kernel has dropped datagrams.
TEST(EcnUdp, ASecondRunHasNothingOfTheFirst) {
  const Harness src(gst_harness_new_with_padnames("ecnudpsrc", nullptr, "src"));
  g_object_set(src->element, "port", 0, "buffer-size", 4'096, nullptr);
  const auto drops = [&] { return Stat(src.get(), "dropped-by-kernel"); };
  gst_element_set_state(src->element, GST_STATE_PAUSED);  // opens the socket, but does not read yet
  Harness sink = NewSink("127.0.0.1", LocalPort(src.get()));
  for (int i = 0; i < 50; ++i) gst_harness_push(sink.get(), Payload(std::string(1'000, 'x')));
  SetPlaying(src.get());
  EXPECT_TRUE(test::Eventually([&] {
    gst_harness_push(sink.get(), Payload("behind the loss"));
    return drops() > 0;
  }));
  gst_element_set_state(src->element, GST_STATE_PAUSED);
  for (int i = 0; i < 3; ++i) gst_harness_push(sink.get(), Payload("old"));
  std::atomic<bool> blocked{false};
  const PadPtr pad(gst_element_get_static_pad(src->element, "src"));
  const gulong probe = gst_pad_add_probe(
      pad.get(), static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BLOCK | GST_PAD_PROBE_TYPE_BUFFER),
      [](GstPad*, GstPadProbeInfo*, gpointer flag) -> GstPadProbeReturn {
        *static_cast<std::atomic<bool>*>(flag) = true;
        return GST_PAD_PROBE_OK;
      },
      &blocked, nullptr);
  gst_element_set_state(src->element, GST_STATE_PLAYING);
  EXPECT_TRUE(test::Eventually([&] { return blocked.load(); }));
  gst_element_set_state(src->element, GST_STATE_NULL);
  gst_pad_remove_probe(pad.get(), probe);
  while (GstBuffer* old = gst_harness_try_pull(src.get())) gst_buffer_unref(old);
  SetPlaying(src.get());
  sink = NewSink("127.0.0.1", LocalPort(src.get()));
  gst_harness_push(sink.get(), Payload("new"));
  const BufferPtr got(gst_harness_pull(src.get()));
  ASSERT_TRUE(got);
  EXPECT_EQ(Text(got.get()), "new");
  EXPECT_EQ(Stat(src.get(), "packets-received"), 1U);
  EXPECT_EQ(drops(), 0U);
}

/// Each datagram either arrives or is counted as dropped, exactly once.
TEST(EcnUdp, WhatArrivesAndWhatTheKernelDropsIsWhatWasSent) {
  const Harness src(gst_harness_new_with_padnames("ecnudpsrc", nullptr, "src"));
  g_object_set(src->element, "port", 0, "buffer-size", 4'096, nullptr);
  gst_element_set_state(src->element, GST_STATE_PAUSED);  // opens the socket, but does not read yet
  const Harness sink = NewSink("127.0.0.1", LocalPort(src.get()));
  guint64 sent = 0;
  const auto send = [&] {
    gst_harness_push(sink.get(), Payload(std::string(1'000, 'x')));
    ++sent;
  };
  const auto received = [&] { return Stat(src.get(), "packets-received"); };
  const auto dropped = [&] { return Stat(src.get(), "dropped-by-kernel"); };
  while (sent < 50) send();
  SetPlaying(src.get());
  // The kernel reports dropped datagrams together with the next datagram that it delivers, so the
  // test sends more.
  int looks = 0;
  ASSERT_TRUE(test::Eventually([&] {
    if (looks++ % 50 == 0) send();
    return received() + dropped() == sent;
  }));
  const guint64 before = dropped();
  EXPECT_GT(before, 0U);
  for (int i = 0; i < 3; ++i) {
    send();
    EXPECT_TRUE(test::Eventually([&] { return received() + before == sent; }));
    EXPECT_EQ(dropped(), before);
  }
}

TEST(EcnUdp, ADatagramThatCannotGoCostsNoOther) {
  const Harness src = NewSource();
  const Harness sink = NewSink("127.0.0.1", LocalPort(src.get()));
  GstBufferList* list = gst_buffer_list_new();
  for (const std::string& text :
       {std::string("first"), std::string(70'000, 'x'), std::string("second"),
        std::string(70'000, 'x'), std::string("third")})
    gst_buffer_list_add(list, Payload(text));
  EXPECT_EQ(gst_pad_push_list(sink->srcpad, list), GST_FLOW_OK);
  EXPECT_EQ(Stat(sink.get(), "packets-sent"), 3U);
  EXPECT_EQ(Stat(sink.get(), "send-errors"), 2U);
  for (const char* text : {"first", "second", "third"}) {
    const BufferPtr got(gst_harness_pull(src.get()));
    ASSERT_TRUE(got);
    EXPECT_EQ(Text(got.get()), text);
  }
}

TEST(EcnUdp, AnEmptyDatagramIsPassedOver) {
  const Harness src = NewSource();
  const Harness sink = NewSink("127.0.0.1", LocalPort(src.get()));
  for (const char* text : {"", "x"})
    ASSERT_EQ(gst_harness_push(sink.get(), Payload(text)), GST_FLOW_OK);
  EXPECT_EQ(Stat(sink.get(), "packets-sent"), 2U);
  const BufferPtr got(gst_harness_pull(src.get()));
  ASSERT_TRUE(got);
  EXPECT_EQ(Text(got.get()), "x");
}

TEST(EcnUdp, APauseOrAFlushEndsNothing) {
  const Harness src = NewSource();
  const Harness sink = NewSink("127.0.0.1", LocalPort(src.get()));
  const std::array<std::function<void()>, 3> interruptions = {
      [] {},
      [&] {
        gst_element_set_state(src->element, GST_STATE_PAUSED);
        gst_element_set_state(src->element, GST_STATE_PLAYING);
      },
      [&] {
        EXPECT_TRUE(gst_element_send_event(src->element, gst_event_new_flush_start()));
        EXPECT_TRUE(gst_element_send_event(src->element, gst_event_new_flush_stop(FALSE)));
      }};
  for (const auto& interrupt : interruptions) {
    interrupt();
    // Each datagram arrives alone, because the source waits for it.
    for (int i = 0; i < 3; ++i) {
      gst_harness_push(sink.get(), Payload(std::to_string(i)));
      const BufferPtr got(gst_harness_pull(src.get()));
      ASSERT_TRUE(got) << i;
      EXPECT_EQ(Text(got.get()), std::to_string(i));
    }
  }
}

TEST(EcnUdp, TellsOnceOfAnErrorUntilDatagramsLeaveAgain) {
  const Harness src = NewSource();
  const Harness sink = NewSink("127.0.0.1", LocalPort(src.get()));
  const test::ElementBus bus(sink->element);
  for (guint outage = 1; outage <= 2; ++outage) {
    for (int i = 0; i < 3; ++i) gst_harness_push(sink.get(), Payload(std::string(70'000, 'x')));
    const auto warnings = bus.Texts(GST_MESSAGE_WARNING);
    ASSERT_EQ(warnings.size(), 1U) << outage;
    EXPECT_EQ(warnings[0], std::string("Sending failed: ") + g_strerror(EMSGSIZE) + ".");
    EXPECT_EQ(Stat(sink.get(), "send-errors"), 3 * outage);
    gst_harness_push(sink.get(), Payload("fits"));
    EXPECT_EQ(Stat(sink.get(), "packets-sent"), outage);
  }
}

TEST(EcnUdpSink, TellsOfAnErrorInEachRun) {
  GstElement* element = SinkElement();
  g_object_set(element, "host", "127.0.0.1", "port", 9, nullptr);
  const test::ElementBus bus(element);
  for (int run = 0; run < 2; ++run) {
    const Harness sink(gst_harness_new_with_element(element, "sink", nullptr));
    gst_harness_set_src_caps_str(sink.get(), "application/x-rtp");
    for (int i = 0; i < 2; ++i) gst_harness_push(sink.get(), Payload(std::string(70'000, 'x')));
    EXPECT_EQ(bus.Texts(GST_MESSAGE_WARNING).size(), 1U) << run;
  }
  gst_element_set_state(element, GST_STATE_NULL);
  gst_object_unref(element);
}

TEST(EcnUdp, BuffersOfManyMemoriesAreOneDatagram) {
  const Harness src = NewSource();
  const Harness sink = NewSink("127.0.0.1", LocalPort(src.get()));
  for (guint pieces : {2U, 4U, 7U, 2U}) {
    GstBuffer* buffer = gst_buffer_new();
    std::string whole;
    for (guint i = 0; i < pieces; ++i) {
      const std::string piece(i + 1, static_cast<char>('a' + i));
      GstBuffer* one = Payload(piece);
      gst_buffer_append_memory(buffer, gst_buffer_get_memory(one, 0));
      gst_buffer_unref(one);
      whole += piece;
    }
    ASSERT_EQ(gst_harness_push(sink.get(), buffer), GST_FLOW_OK);
    const BufferPtr got(gst_harness_pull(src.get()));
    ASSERT_TRUE(got);
    EXPECT_EQ(Text(got.get()), whole);
  }
}

TEST(EcnUdp, ReplyGoesToThePeerThatTheBufferNames) {
  const Harness edge = NewSource();
  const Harness robot_a = NewSource("127.0.0.1");
  const Harness robot_b = NewSource("127.0.0.1");
  const auto socket = GetObject<GSocket>(edge.get(), "used-socket");
  GstElement* element = SinkElement();
  g_object_set(element, "socket", socket.get(), "close-socket", FALSE, "reply", TRUE, nullptr);
  const Harness reply = Wrap(element);
  ASSERT_EQ(gst_harness_push(reply.get(), Payload("to nobody")), GST_FLOW_OK);
  EXPECT_EQ(Stat(reply.get(), "dropped-no-peer"), 1U);
  for (GstHarness* robot : {robot_a.get(), robot_b.get()}) {
    GstBuffer* named = Payload("named");
    const Object<GSocketAddress> address(
        g_inet_socket_address_new_from_string("127.0.0.1", LocalPort(robot)));
    gst_buffer_add_net_address_meta(named, address.get());
    ASSERT_EQ(gst_harness_push(reply.get(), named), GST_FLOW_OK);
    EXPECT_EQ(GetObject<GSocketAddress>(reply.get(), "peer-address"), address);
    ASSERT_EQ(gst_harness_push(reply.get(), Payload("to the last")), GST_FLOW_OK);
    for (const char* text : {"named", "to the last"}) {
      const BufferPtr got(gst_harness_pull(robot));
      ASSERT_TRUE(got);
      EXPECT_EQ(Text(got.get()), text);
    }
  }
  EXPECT_TRUE(GetObject<GSocketAddress>(reply.get(), "peer-address"));
  gst_element_set_state(reply->element, GST_STATE_NULL);
  EXPECT_FALSE(GetObject<GSocketAddress>(reply.get(), "peer-address"));
}

/// Returns the TOS byte of the next datagram on `fd`, or -1 if the kernel does not report it.
int ReceiveTos(int fd) {
  char data[16];
  alignas(cmsghdr) char control[64];
  iovec iov{data, sizeof data};
  msghdr header{};
  header.msg_iov = &iov;
  header.msg_iovlen = 1;
  header.msg_control = control;
  header.msg_controllen = sizeof control;
  if (recvmsg(fd, &header, 0) < 0) return -1;
  for (cmsghdr* c = CMSG_FIRSTHDR(&header); c != nullptr; c = CMSG_NXTHDR(&header, c))
    if (c->cmsg_level == IPPROTO_IP && c->cmsg_type == IP_TOS) return *CMSG_DATA(c);
  return -1;
}

TEST_P(Loopback, PacketsLeaveByTheInterfaceAndByNoOther) {
  const Harness src = NewSource(GetParam().address);
  const Harness sink = NewSink(GetParam().host, LocalPort(src.get()));
  g_object_set(sink->element, "interface", "none0", nullptr);
  EXPECT_EQ(gst_harness_push(sink.get(), Payload("lost")), GST_FLOW_OK);
  EXPECT_EQ(Stat(sink.get(), "send-errors"), 1U);
  g_object_set(sink->element, "interface", "lo", nullptr);
  EXPECT_EQ(gst_harness_push(sink.get(), Payload("sent")), GST_FLOW_OK);
  const BufferPtr got(gst_harness_pull(src.get()));
  ASSERT_TRUE(got);
  EXPECT_EQ(Text(got.get()), "sent");
}

/// Returns a socket on the loopback interface. An IPv6 socket is bound to any address and receives
/// IPv4 datagrams, too.
Object<GSocket> LoopbackSocket(GSocketFamily family = G_SOCKET_FAMILY_IPV4) {
  const Object<GInetAddress> address(family == G_SOCKET_FAMILY_IPV4
                                         ? g_inet_address_new_loopback(family)
                                         : g_inet_address_new_any(family));
  const Object<GSocketAddress> local(g_inet_socket_address_new(address.get(), 0));
  Object<GSocket> socket(
      g_socket_new(family, G_SOCKET_TYPE_DATAGRAM, G_SOCKET_PROTOCOL_UDP, nullptr));
  EXPECT_TRUE(g_socket_bind(socket.get(), local.get(), FALSE, nullptr));
  return socket;
}

class EcnUdpSinkOn : public ::testing::TestWithParam<GSocketFamily> {};

TEST_P(EcnUdpSinkOn, KeepsTheDscpBesideTheEcnBits) {
  const auto receiver = LoopbackSocket();
  ASSERT_TRUE(g_socket_set_option(receiver.get(), IPPROTO_IP, IP_RECVTOS, 1, nullptr));
  const Object<GSocketAddress> bound(g_socket_get_local_address(receiver.get(), nullptr));
  const auto given = LoopbackSocket(GetParam());
  ASSERT_TRUE(g_socket_set_option(given.get(), IPPROTO_IP, IP_TOS, 18 << 2 | 2, nullptr));
  GstElement* element = SinkElement();
  g_object_set(element, "socket", given.get(), "host", "127.0.0.1", "port",
               g_inet_socket_address_get_port(G_INET_SOCKET_ADDRESS(bound.get())), nullptr);
  const Harness sink = Wrap(element);
  for (const int dscp : {46, 0, 1, 63, -1, 0}) {
    g_object_set(sink->element, "qos-dscp", dscp, nullptr);
    for (const int ecn : {GST_LIDAR_ECN_NOT_ECT, GST_LIDAR_ECN_ECT1, GST_LIDAR_ECN_ECT0}) {
      g_object_set(sink->element, "ecn", ecn, nullptr);
      ASSERT_EQ(gst_harness_push(sink.get(), Payload("x")), GST_FLOW_OK);
      EXPECT_EQ(ReceiveTos(g_socket_get_fd(receiver.get())), (dscp < 0 ? 18 : dscp) << 2 | ecn)
          << dscp;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(ASocket, EcnUdpSinkOn,
                         ::testing::Values(G_SOCKET_FAMILY_IPV4, G_SOCKET_FAMILY_IPV6));

/// An IPv6 socket sends datagrams to an IPv4 host through the IPv4 stack.
TEST(EcnUdpSink, MarksWhatLeavesThroughTheIpv4StackOfAnIpv6Socket) {
  const Harness src = NewSource(), both = NewSource();
  GstElement* element = SinkElement();
  gst_util_set_object_arg(G_OBJECT(element), "ecn", "ect1");
  g_object_set(element, "socket", GetObject<GSocket>(both.get(), "used-socket").get(),
               "close-socket", FALSE, "host", "127.0.0.1", "port", LocalPort(src.get()), nullptr);
  const Harness sink = Wrap(element);
  ASSERT_EQ(gst_harness_push(sink.get(), Payload("x")), GST_FLOW_OK);
  const BufferPtr got(gst_harness_pull(src.get()));
  ASSERT_TRUE(got);
  GstLidarEcn ecn{};
  ASSERT_TRUE(gst_lidar_buffer_get_ecn(got.get(), &ecn, nullptr));
  EXPECT_EQ(ecn, GST_LIDAR_ECN_ECT1);
}

TEST(EcnUdpSink, CountsEachRunAlone) {
  const Harness src = NewSource();
  GstElement* element = SinkElement();
  const auto pushed = [&](const std::string& text) {
    const Harness sink(gst_harness_new_with_element(element, "sink", nullptr));
    gst_harness_set_src_caps_str(sink.get(), "application/x-rtp");
    for (const char* field : {"packets-sent", "bytes-sent", "send-errors", "dropped-no-peer"})
      EXPECT_EQ(Stat(sink.get(), field), 0U) << field;
    EXPECT_EQ(gst_harness_push(sink.get(), Payload(text)), GST_FLOW_OK);
    return std::array{Stat(sink.get(), "packets-sent"), Stat(sink.get(), "bytes-sent"),
                      Stat(sink.get(), "send-errors"), Stat(sink.get(), "dropped-no-peer")};
  };
  using Counts = std::array<guint64, 4>;
  g_object_set(element, "host", "127.0.0.1", "port", LocalPort(src.get()), nullptr);
  EXPECT_EQ(pushed("fits"), (Counts{1, 4, 0, 0}));
  EXPECT_EQ(pushed(std::string(70'000, 'x')), (Counts{0, 0, 1, 0}));
  EXPECT_EQ(pushed("fit"), (Counts{1, 3, 0, 0}));
  g_object_set(element, "reply", TRUE, nullptr);
  EXPECT_EQ(pushed("to nobody"), (Counts{0, 0, 0, 1}));
  EXPECT_EQ(pushed("to nobody"), (Counts{0, 0, 0, 1}));
  gst_element_set_state(element, GST_STATE_NULL);
  gst_object_unref(element);
}

TEST(EcnUdpSink, ForgetsABatchThatItCannotMap) {
  const Harness src = NewSource();
  GstElement* element = SinkElement();
  g_object_set(element, "host", "127.0.0.1", "port", LocalPort(src.get()), nullptr);
  GstMemory* busy = gst_allocator_alloc(nullptr, 4, nullptr);
  GstMapInfo map;
  ASSERT_TRUE(gst_memory_map(busy, &map, GST_MAP_WRITE));
  {
    const Harness sink(gst_harness_new_with_element(element, "sink", nullptr));
    gst_harness_set_src_caps_str(sink.get(), "application/x-rtp");
    GstBufferList* list = gst_buffer_list_new();
    gst_buffer_list_add(list, Payload("first"));
    GstBuffer* unreadable = gst_buffer_new();
    gst_buffer_append_memory(unreadable, gst_memory_ref(busy));
    gst_buffer_list_add(list, unreadable);
    EXPECT_EQ(gst_pad_push_list(sink->srcpad, list), GST_FLOW_ERROR);
  }
  const Harness sink(gst_harness_new_with_element(element, "sink", nullptr));
  gst_harness_set_src_caps_str(sink.get(), "application/x-rtp");
  EXPECT_EQ(gst_harness_push(sink.get(), Payload("next")), GST_FLOW_OK);
  EXPECT_EQ(Stat(sink.get(), "packets-sent"), 1U);
  const BufferPtr got(gst_harness_pull(src.get()));
  ASSERT_TRUE(got);
  EXPECT_EQ(Text(got.get()), "next");
  gst_memory_unmap(busy, &map);
  gst_memory_unref(busy);
  gst_element_set_state(element, GST_STATE_NULL);
  gst_object_unref(element);
}

TEST(EcnUdpSink, AnUnknownHostIsAnElementErrorThatNamesIt) {
  const ElementPtr sink(gst_element_factory_make("ecnudpsink", nullptr));
  gst_object_ref_sink(sink.get());
  g_object_set(sink.get(), "host", "no-such-host.invalid", nullptr);
  const test::ElementBus bus(sink.get());
  EXPECT_EQ(gst_element_set_state(sink.get(), GST_STATE_PAUSED), GST_STATE_CHANGE_FAILURE);
  const MessagePtr message = bus.Pop(GST_MESSAGE_ERROR);
  ASSERT_TRUE(message);
  EXPECT_NE(test::MessageDetails(message.get()).find("no-such-host.invalid"), std::string::npos);
  gst_element_set_state(sink.get(), GST_STATE_NULL);
}

TEST(EcnUdpSrc, APortInUseIsAnElementErrorThatSaysWhatToDo) {
  const Harness first = NewSource("127.0.0.1");
  const ElementPtr second(gst_element_factory_make("ecnudpsrc", nullptr));
  gst_object_ref_sink(second.get());
  g_object_set(second.get(), "address", "127.0.0.1", "port", LocalPort(first.get()), nullptr);
  const test::ElementBus bus(second.get());
  EXPECT_EQ(gst_element_set_state(second.get(), GST_STATE_PAUSED), GST_STATE_CHANGE_FAILURE);
  const MessagePtr message = bus.Pop(GST_MESSAGE_ERROR);
  ASSERT_TRUE(message);
  GError* error = nullptr;
  gst_message_parse_error(message.get(), &error, nullptr);
  EXPECT_TRUE(g_error_matches(error, GST_RESOURCE_ERROR, GST_RESOURCE_ERROR_OPEN_READ));
  EXPECT_NE(std::string(error->message).find(std::to_string(LocalPort(first.get()))),
            std::string::npos);
  g_error_free(error);
  EXPECT_NE(test::MessageDetails(message.get()).find("is another program using the port?"),
            std::string::npos);
  // If this machine does not have the address, the error must not suggest that another program uses
  // the port.
  g_object_set(second.get(), "address", "203.0.113.9", nullptr);
  EXPECT_EQ(gst_element_set_state(second.get(), GST_STATE_PAUSED), GST_STATE_CHANGE_FAILURE);
  const MessagePtr elsewhere = bus.Pop(GST_MESSAGE_ERROR);
  ASSERT_TRUE(elsewhere);
  EXPECT_EQ(test::MessageDetails(elsewhere.get()).find("another program"), std::string::npos);
  gst_element_set_state(second.get(), GST_STATE_NULL);
}

TEST(EcnUdpSrc, AnInterfaceThatIsNotThereIsAnElementErrorThatNamesIt) {
  const ElementPtr src(gst_element_factory_make("ecnudpsrc", nullptr));
  gst_object_ref_sink(src.get());
  g_object_set(src.get(), "port", 0, "multicast-group", "239.201.7.1", "multicast-iface", "nosuch0",
               nullptr);
  const test::ElementBus bus(src.get());
  EXPECT_EQ(gst_element_set_state(src.get(), GST_STATE_PAUSED), GST_STATE_CHANGE_FAILURE);
  const MessagePtr message = bus.Pop(GST_MESSAGE_ERROR);
  ASSERT_TRUE(message);
  EXPECT_NE(test::MessageText(message.get()).find("nosuch0"), std::string::npos);
  gst_element_set_state(src.get(), GST_STATE_NULL);
}

TEST(EcnUdpSink, WarnsOfAnInterfaceThatIsNotThere) {
  const ElementPtr sink(gst_element_factory_make("ecnudpsink", nullptr));
  gst_object_ref_sink(sink.get());
  g_object_set(sink.get(), "host", "239.201.7.1", "port", 9, "multicast-iface", "nosuch0", nullptr);
  const test::ElementBus bus(sink.get());
  gst_element_set_state(sink.get(), GST_STATE_PAUSED);
  EXPECT_EQ(bus.Text(GST_MESSAGE_WARNING).find("The multicast-iface nosuch0 cannot be used: "), 0U);
  gst_element_set_state(sink.get(), GST_STATE_NULL);
}

Harness ListenerOf(const char* group, guint port) {
  Harness src(gst_harness_new_with_padnames("ecnudpsrc", nullptr, "src"));
  g_object_set(src->element, "port", port, "multicast-group", group, "multicast-iface", "lo",
               nullptr);
  return src;
}

TEST(EcnUdpSrc, SeveralOfAMachineReceiveAMulticastGroup) {
  const Harness first = ListenerOf("239.201.7.1", 0);
  if (gst_element_set_state(first->element, GST_STATE_PAUSED) == GST_STATE_CHANGE_FAILURE)
    GTEST_SKIP() << "no multicast here";
  const Harness second = ListenerOf("239.201.7.1", LocalPort(first.get()));
  EXPECT_NE(gst_element_set_state(second->element, GST_STATE_PAUSED), GST_STATE_CHANGE_FAILURE);
}

void SendToGroup(const char* group, guint port, const std::string& text,
                 GSocket* socket = nullptr) {
  GstElement* sink = SinkElement();
  g_object_set(sink, "host", group, "port", port, "multicast-iface", "lo", "socket", socket,
               nullptr);
  const Harness harness = Wrap(sink);
  EXPECT_EQ(gst_harness_push(harness.get(), Payload(text)), GST_FLOW_OK);
}

TEST(EcnUdpSink, ASocketOfIpv6SendsToAGroupOfIpv4ByItsInterface) {
  const Harness src = ListenerOf("239.201.7.3", 0);
  if (gst_element_set_state(src->element, GST_STATE_PLAYING) == GST_STATE_CHANGE_FAILURE)
    GTEST_SKIP() << "no multicast here";
  SendToGroup("239.201.7.3", LocalPort(src.get()), "dual",
              LoopbackSocket(G_SOCKET_FAMILY_IPV6).get());
  const BufferPtr got(gst_harness_pull(src.get()));
  ASSERT_TRUE(got);
  EXPECT_EQ(Text(got.get()), "dual");
}

/// By default, the kernel delivers to a socket the datagrams of all groups that any program on this
/// machine has joined.
TEST(EcnUdpSrc, TakesNothingOfAnotherGroupOnItsPort) {
  const Harness ours = ListenerOf("239.201.7.1", 0);
  if (gst_element_set_state(ours->element, GST_STATE_PLAYING) == GST_STATE_CHANGE_FAILURE)
    GTEST_SKIP() << "no multicast here";
  const guint port = LocalPort(ours.get());
  const Harness theirs = ListenerOf("239.201.7.2", port);
  SetPlaying(theirs.get());
  SendToGroup("239.201.7.2", port, "theirs");
  SendToGroup("239.201.7.1", port, "ours");
  const BufferPtr got(gst_harness_pull(ours.get()));
  ASSERT_TRUE(got);
  EXPECT_EQ(Text(got.get()), "ours");
}

/// A machine without multicast cannot join a group. Then both forms of the address must fail.
TEST(EcnUdpSrc, TakesAMulticastGroupInBrackets) {
  const auto joins = [](const std::string& group) {
    const Harness src(gst_harness_new_with_padnames("ecnudpsrc", nullptr, "src"));
    g_object_set(src->element, "port", 0, "multicast-group", group.c_str(), "multicast-iface", "lo",
                 nullptr);
    return gst_element_set_state(src->element, GST_STATE_PAUSED) != GST_STATE_CHANGE_FAILURE;
  };
  for (const std::string group : {"239.201.7.1", "ff12::7:1"})
    EXPECT_EQ(joins("[" + group + "]"), joins(group)) << group;
}

struct Peer {
  const char* accepts;
  const char* wants;  // caps that the source then sets; null: none
};
class WithoutCaps : public ::testing::TestWithParam<Peer> {};
TEST_P(WithoutCaps, TheSourceTakesWhatDownstreamWants) {
  Harness src(gst_harness_new_with_padnames("ecnudpsrc", nullptr, "src"));
  g_object_set(src->element, "port", 0, "address", "127.0.0.1", nullptr);
  gst_harness_set_sink_caps_str(src.get(), GetParam().accepts);
  SetPlaying(src.get());
  const Harness sink = NewSink("127.0.0.1", LocalPort(src.get()));
  ASSERT_EQ(gst_harness_push(sink.get(), Payload("x")), GST_FLOW_OK);
  const BufferPtr got(gst_harness_pull(src.get()));
  ASSERT_TRUE(got);
  const CapsPtr caps(gst_pad_get_current_caps(src->sinkpad));
  if (GetParam().wants == nullptr) {
    EXPECT_FALSE(caps);
    return;
  }
  const CapsPtr wanted(gst_caps_from_string(GetParam().wants));
  ASSERT_TRUE(caps);
  EXPECT_TRUE(gst_caps_is_equal(caps.get(), wanted.get()))
      << StringPtr(gst_caps_to_string(caps.get())).get();
}
INSTANTIATE_TEST_SUITE_P(
    Peers, WithoutCaps,
    ::testing::Values(
        Peer{"application/x-rtp,encoding-name=(string)X",
             "application/x-rtp,encoding-name=(string)X,payload=(int)96"},
        Peer{"ANY", nullptr}, Peer{"application/x-rtcp", "application/x-rtcp"},
        Peer{"application/x-rtp,media=application,encoding-name=X-LIDAR-DRACO,"
             "clock-rate=90000,payload=[0,127]",
             "application/x-rtp,media=application,encoding-name=X-LIDAR-DRACO,"
             "clock-rate=90000,payload=96"},
        Peer{"application/x-rtp,media={video,audio},clock-rate=90000;application/x-other",
             "application/x-rtp,media=video,clock-rate=90000"}));

TEST(EcnUdpSrc, AClockThatWasSetIsNoArrivalTime) {
  const Harness src = NewSource();
  gst_harness_use_testclock(src.get());
  gst_harness_set_time(src.get(), 100 * GST_SECOND);
  const Harness sink = NewSink("127.0.0.1", LocalPort(src.get()));
  for (const gint64 hours : {1, -1}) {
    clock_ahead = hours * 3'600 * G_USEC_PER_SEC;
    ASSERT_EQ(gst_harness_push(sink.get(), Payload("x")), GST_FLOW_OK);
    const BufferPtr got(gst_harness_pull(src.get()));
    ASSERT_TRUE(got);
    EXPECT_EQ(GST_BUFFER_PTS(got.get()), 100 * GST_SECOND) << hours;
    EXPECT_EQ(GST_BUFFER_DTS(got.get()), 100 * GST_SECOND) << "the arrival of a jitter buffer";
  }
  clock_ahead = 0;
}

TEST(EcnUdpSrc, EosFromTheApplicationEndsTheStream) {
  const Harness src = NewSource();
  ASSERT_TRUE(gst_element_send_event(src->element, gst_event_new_eos()));
  for (;;) {
    const EventPtr event(gst_harness_pull_event(src.get()));
    ASSERT_TRUE(event);
    if (GST_EVENT_TYPE(event.get()) == GST_EVENT_EOS) break;
  }
}

TEST(EcnUdpSrc, SilenceIsReportedAfterTheTimeout) {
  Harness src(gst_harness_new_with_padnames("ecnudpsrc", nullptr, "src"));
  constexpr guint64 kTimeout = 200 * GST_MSECOND;
  g_object_set(src->element, "port", 0, "timeout", kTimeout, nullptr);
  const test::ElementBus bus(src->element);
  const gint64 begin_us = g_get_monotonic_time();
  SetPlaying(src.get());
  const MessagePtr message = bus.Wait(GST_MESSAGE_ELEMENT);
  ASSERT_TRUE(message);
  EXPECT_TRUE(gst_message_has_name(message.get(), "GstEcnUdpSrcTimeout"));
  EXPECT_GE(static_cast<guint64>(g_get_monotonic_time() - begin_us) * GST_USECOND, kTimeout)
      << "and no sooner";
  gst_element_set_state(src->element, GST_STATE_NULL);
}

TEST(EcnUdpSrc, SilenceIsReportedInNoRunWithoutATimeout) {
  Harness src(gst_harness_new_with_padnames("ecnudpsrc", nullptr, "src"));
  g_object_set(src->element, "port", 0, "timeout", guint64{GST_MSECOND}, nullptr);
  const test::ElementBus bus(src->element);
  SetPlaying(src.get());
  ASSERT_TRUE(bus.Wait(GST_MESSAGE_ELEMENT));
  gst_element_set_state(src->element, GST_STATE_READY);
  while (bus.Pop()) continue;
  g_object_set(src->element, "timeout", guint64{0}, nullptr);
  SetPlaying(src.get());
  g_usleep(50'000);
  EXPECT_FALSE(bus.Pop(GST_MESSAGE_ELEMENT));
  gst_element_set_state(src->element, GST_STATE_NULL);
}

TEST(EcnUdpSink, GivesItsSocketWhatItsPropertiesSay) {
  GstElement* element = SinkElement();
  g_object_set(element, "host", "127.0.0.1", "port", 9, "ttl-mc", 7, "buffer-size", 8'192U,
               nullptr);
  const Harness sink = Wrap(element);
  const auto socket = GetObject<GSocket>(sink.get(), "used-socket");
  ASSERT_TRUE(socket);
  EXPECT_EQ(g_socket_get_multicast_ttl(socket.get()), 7U);
  gint granted = 0;
  ASSERT_TRUE(g_socket_get_option(socket.get(), SOL_SOCKET, SO_SNDBUF, &granted, nullptr));
  EXPECT_EQ(granted, 2 * 8'192) << "the kernel doubles it";
}

TEST(EcnUdp, WorksAgainAfterEveryStateCycle) {
  Harness src(gst_harness_new_with_padnames("ecnudpsrc", nullptr, "src"));
  g_object_set(src->element, "port", 0, "address", "127.0.0.1", nullptr);
  for (int cycle = 0; cycle < 3; ++cycle) {
    SetPlaying(src.get());
    const Harness sink = NewSink("127.0.0.1", LocalPort(src.get()));
    ASSERT_EQ(gst_harness_push(sink.get(), Payload("again")), GST_FLOW_OK);
    const BufferPtr got(gst_harness_pull(src.get()));
    ASSERT_TRUE(got) << cycle;
    ASSERT_EQ(gst_element_set_state(src->element, GST_STATE_NULL), GST_STATE_CHANGE_SUCCESS);
    EXPECT_FALSE(GetObject<GSocket>(src.get(), "used-socket"));
  }
}

/// While downstream handles the first datagram, two more wait in the element.
TEST(EcnUdpSrc, AStopForgetsDatagramsThatWait) {
  Harness src(gst_harness_new_with_padnames("ecnudpsrc", nullptr, "src"));
  g_object_set(src->element, "port", 0, "address", "127.0.0.1", nullptr);
  gst_element_set_state(src->element, GST_STATE_PAUSED);
  {
    const Harness sink = NewSink("127.0.0.1", LocalPort(src.get()));
    for (int i = 0; i < 3; ++i)
      ASSERT_EQ(gst_harness_push(sink.get(), Payload("before")), GST_FLOW_OK);
  }
  const PadPtr pad(gst_element_get_static_pad(src->element, "src"));
  const gulong probe = gst_pad_add_probe(
      pad.get(), static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BLOCK | GST_PAD_PROBE_TYPE_BUFFER),
      [](GstPad*, GstPadProbeInfo*, gpointer) { return GST_PAD_PROBE_OK; }, nullptr, nullptr);
  gst_element_set_state(src->element, GST_STATE_PLAYING);
  ASSERT_TRUE(test::Eventually([&] { return Stat(src.get(), "packets-received") == 3; }));
  gst_element_set_state(src->element, GST_STATE_READY);
  gst_pad_remove_probe(pad.get(), probe);
  SetPlaying(src.get());
  const Harness sink = NewSink("127.0.0.1", LocalPort(src.get()));
  ASSERT_EQ(gst_harness_push(sink.get(), Payload("after")), GST_FLOW_OK);
  EXPECT_EQ(Text(BufferPtr(gst_harness_pull(src.get())).get()), "after");
}

/// Sends datagrams to a port of this machine as fast as possible, until the object is destroyed.
class Flood {
 public:
  explicit Flood(guint port)
      : socket_(g_socket_new(G_SOCKET_FAMILY_IPV4, G_SOCKET_TYPE_DATAGRAM, G_SOCKET_PROTOCOL_UDP,
                             nullptr)) {
    const Object<GInetAddress> host(g_inet_address_new_loopback(G_SOCKET_FAMILY_IPV4));
    to_.reset(g_inet_socket_address_new(host.get(), static_cast<guint16>(port)));
    thread_ = std::thread([this] {
      while (!done_) g_socket_send_to(socket_.get(), to_.get(), "flood", 5, nullptr, nullptr);
    });
  }
  ~Flood() {
    done_ = true;
    thread_.join();
  }

 private:
  Object<GSocket> socket_;
  Object<GSocketAddress> to_;
  std::atomic<bool> done_ = false;
  std::thread thread_;
};

TEST(EcnUdp, StopsAndEndsInAFloodWithoutComplaints) {
  Harness src(gst_harness_new_with_padnames("ecnudpsrc", nullptr, "src"));
  g_object_set(src->element, "port", 0, "address", "127.0.0.1", nullptr);
  for (int cycle = 0; cycle < 40; ++cycle) {
    SetPlaying(src.get());
    const Flood flood(LocalPort(src.get()));
    ASSERT_TRUE(BufferPtr(gst_harness_pull(src.get()))) << cycle;
    if (cycle % 2 == 0) {
      ASSERT_TRUE(gst_element_send_event(src->element, gst_event_new_eos()));
      while (const EventPtr event{gst_harness_pull_event(src.get())})
        if (GST_EVENT_TYPE(event.get()) == GST_EVENT_EOS) break;
    }
    ASSERT_NE(gst_element_set_state(src->element, GST_STATE_READY), GST_STATE_CHANGE_FAILURE);
    while (gst_harness_buffers_in_queue(src.get()) > 0) BufferPtr(gst_harness_pull(src.get()));
  }
}

}  // namespace
}  // namespace lidar::gst
