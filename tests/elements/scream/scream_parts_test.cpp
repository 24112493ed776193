// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of the parts of the SCReAM elements that need no pads, for example RTP headers, goodbyes,
// and the receiver's latch.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <limits>
#include <optional>
#include <variant>

#include "gst/net/udp_batch.h"
#include "gst/scream/feedback_peer.h"
#include "gst/scream/key_request.h"
#include "gst/scream/peer_latch.h"
#include "gst/scream/rtp_packet.h"
#include "gst/scream/srtp/key_gate.h"
#include "gst/scream/tx/figures.h"
#include "gst/scream/tx/settings.h"
#include "src/scream/tuning.h"
#include "tests/elements/scream/rtp_support.h"

namespace lidar::gst {
namespace {

using namespace std::chrono_literals;
using AddressPtr = std::unique_ptr<GSocketAddress, GObjectUnref>;

TEST(RtpHeader, IsReadWithItsExtensionAndSources) {
  test::Rtp r;
  r.seq = 65535;
  r.timestamp = 0xfffffff0;
  r.marker = true;
  const BufferPtr buffer(test::NewRtp(r));
  const auto plain = ReadRtpHeader(buffer.get());
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->seq, 65535);
  EXPECT_EQ(plain->timestamp, 0xfffffff0);
  EXPECT_EQ(plain->ssrc, 0x1234U);
  EXPECT_TRUE(plain->marker);
  EXPECT_EQ(plain->payload_type, 96);
  EXPECT_EQ(plain->header_size, 12U);

  std::vector<std::uint8_t> bytes{0x92, 96, 0, 1, 0, 0, 0, 0, 0, 0, 0, 7};
  bytes.insert(bytes.end(), 8, 0);                               // two CSRCs
  bytes.insert(bytes.end(), {0xbe, 0xde, 0, 1, 0, 0, 0, 0, 9});  // an extension of one word
  const BufferPtr extended(test::FromBytes(bytes));
  const auto header = ReadRtpHeader(extended.get());
  ASSERT_TRUE(header);
  EXPECT_EQ(header->header_size, 28U);
}

TEST(RtpHeader, IsReadWithoutAPayload) {
  for (const std::vector<std::uint8_t>& bytes :
       {std::vector<std::uint8_t>{0x80, 96, 0, 1, 0, 0, 0, 0, 0, 0, 0, 7},
        {0x90, 96, 0, 1, 0, 0, 0, 0, 0, 0, 0, 7, 0xbe, 0xde, 0, 1, 0, 0, 0, 0}}) {
    const BufferPtr buffer(test::FromBytes(bytes));
    const auto header = ReadRtpHeader(buffer.get());
    ASSERT_TRUE(header) << bytes.size();
    EXPECT_EQ(header->header_size, bytes.size());
  }
}

class NotRtp : public ::testing::TestWithParam<std::vector<std::uint8_t>> {};
TEST_P(NotRtp, IsRefused) {
  const BufferPtr buffer(test::FromBytes(GetParam()));
  EXPECT_FALSE(ReadRtpHeader(buffer.get()));
}
INSTANTIATE_TEST_SUITE_P(
    All, NotRtp,
    ::testing::Values(std::vector<std::uint8_t>{}, std::vector<std::uint8_t>{0x80},
                      std::vector<std::uint8_t>(11, 0x80),  // too short
                      std::vector<std::uint8_t>(40, 0x00),  // version 0
                      std::vector<std::uint8_t>{0x8f, 96, 0, 1, 0, 0, 0, 0, 0, 0, 0,
                                                7},  // 15 CSRCs
                      std::vector<std::uint8_t>{0x90, 96, 0, 1, 0, 0, 0, 0, 0, 0, 0, 7},
                      std::vector<std::uint8_t>{0x90, 96, 0, 1, 0, 0, 0, 0, 0, 0, 0, 7, 0, 0, 0xff,
                                                0xff}));  // extensions past the end

/// The pad has no peer that answers a latency query. Without an answer, the gate treats the stream
/// as live.
TEST(KeyGate, CountsEachPacketThatItDropsAndPassesAllOnceItIsOpen) {
  const auto gate = std::make_shared<KeyGate>();
  const PadPtr pad(GST_PAD(gst_object_ref_sink(gst_pad_new("sink", GST_PAD_SINK))));
  static guint passed;
  passed = 0;
  gst_pad_set_chain_function(pad.get(), [](GstPad*, GstObject*, GstBuffer* buffer) {
    gst_buffer_unref(buffer);
    ++passed;
    return GST_FLOW_OK;
  });
  gst_pad_set_active(pad.get(), TRUE);
  gst_pad_send_event(pad.get(), gst_event_new_stream_start("media"));
  gst_pad_send_event(pad.get(), test::NewSegment());
  const auto send = [&] {
    GstBufferList* list = gst_buffer_list_new();
    for (int i = 0; i < 3; ++i) gst_buffer_list_add(list, test::NewRtp({}));
    gst_pad_chain_list(pad.get(), list);
    gst_pad_chain(pad.get(), test::NewRtp({}));
  };
  KeyGate::Guard(gate, pad.get());
  send();
  EXPECT_EQ(gate->dropped(), 4U);
  EXPECT_EQ(passed, 0U);
  gate->Open();
  send();
  EXPECT_EQ(gate->dropped(), 4U);
  EXPECT_EQ(passed, 4U);
}

TEST(KeyRequest, RoundTripsAndNothingElseIsOne) {
  const auto request = BuildKeyRequest(1, 0xfedcba98);
  EXPECT_EQ(ParseKeyRequest({request.data(), request.size()}), 0xfedcba98U);
  for (std::size_t size = 0; size < request.size(); ++size)
    EXPECT_FALSE(ParseKeyRequest({request.data(), size}));
  for (const std::size_t at : {0U, 1U, 2U, 3U}) {
    auto other = request;
    other[at] ^= 4;
    EXPECT_FALSE(ParseKeyRequest({other.data(), other.size()})) << at;
  }
  auto longer = request;
  longer.push_back(0);
  EXPECT_FALSE(ParseKeyRequest({longer.data(), longer.size()}));
}

TEST(Rtcp, IsToldFromRtpByItsSecondByte) {  // RFC 5761, section 4
  std::vector<std::uint8_t> bytes(8, 0x80);
  for (const auto& [type, is_rtcp] : std::vector<std::pair<int, bool>>{
           {96, false}, {191, false}, {192, true}, {223, true}, {224, false}}) {
    bytes[1] = static_cast<std::uint8_t>(type);
    EXPECT_EQ(IsRtcp({bytes.data(), bytes.size()}), is_rtcp) << type;
  }
}

TEST(Bye, RoundTripsThroughACompound) {
  const auto bye = BuildBye({1, 0xfffffffe});
  EXPECT_TRUE(IsRtcp({bye.data(), bye.size()}));
  EXPECT_EQ(bye[1], 201);  // a compound packet begins with a report
  EXPECT_EQ(ParseBye({bye.data(), bye.size()}), (std::vector<guint32>{1, 0xfffffffe}));
  EXPECT_TRUE(BuildBye({}).empty());
}

TEST(Bye, CutOffAnywhereGivesNoFalseGoodbye) {
  const auto bye = BuildBye({1, 2, 3});
  for (std::size_t n = 0; n < bye.size(); ++n) EXPECT_TRUE(ParseBye({bye.data(), n}).empty()) << n;
}

TEST(Bye, HasNoSourceInItsReason) {  // RFC 3550, section 6.6
  const std::vector<std::uint8_t> bye{0x81, 203, 0,   3,   0,   0,   0, 7,
                                      5,    'd', 'o', 'n', 'e', '.', 0, 0};
  EXPECT_EQ(ParseBye({bye.data(), bye.size()}), std::vector<guint32>{7});
}

TEST(Bye, NamesNoMoreSourcesThanItsCountCanSay) {
  const auto bye = BuildBye(std::vector<guint32>(100, 7));
  EXPECT_EQ(ParseBye({bye.data(), bye.size()}).size(), 31U);
}

constexpr auto kAccepted = PeerLatch::Verdict::kAccepted;
constexpr auto kMoved = PeerLatch::Verdict::kMoved;
constexpr auto kForeign = PeerLatch::Verdict::kForeign;

struct Latch : ::testing::Test {
  PeerLatch::Verdict Send(const AddressPtr& from, std::uint32_t ssrc, std::uint16_t seq,
                          bool with_slice = false) {
    static const std::vector<std::uint8_t> kSlice = test::WholeSlice();
    const ByteView payload = with_slice ? ByteView{kSlice.data(), kSlice.size()} : ByteView{};
    return latch.OnPacket(now, {from.get(), ssrc, seq, payload});
  }
  /// Sends one packet every 10 ms. Returns true if the latch moved to another peer.
  bool Stream(const AddressPtr& from, std::uint32_t ssrc, std::uint16_t first, int packets,
              bool with_slices = false) {
    bool moved = false;
    for (int i = 0; i < packets; ++i, now += 10ms)
      moved =
          Send(from, ssrc, static_cast<std::uint16_t>(first + i), with_slices) == kMoved || moved;
    return moved;
  }

  AddressPtr robot{test::Address("10.0.0.1", 5000)};
  AddressPtr other{test::Address("10.0.0.3", 5001)};
  AddressPtr thief{test::Address("10.0.0.2", 5000)};
  PeerLatch latch;
  Time now{1s};
};

TEST_F(Latch, FirstPeerIsBelievedAtOnceAndByAnyObjectOfItsAddress) {
  EXPECT_EQ(Send(robot, 1, 0), kAccepted);
  const AddressPtr same(test::Address("10.0.0.1", 5000));
  EXPECT_EQ(Send(same, 1, 1), kAccepted);
  EXPECT_TRUE(latch.IsPeer(robot.get()));
  EXPECT_FALSE(latch.IsPeer(thief.get()));
}

TEST(UdpAddress, ALinkLocalOneKeepsItsInterface) {
  const guint lo = if_nametoindex("lo");
  for (const char* host : {"fe80::1%lo", "[fe80::1%lo]"}) {
    const gst::SocketAddressPtr address(gst::ResolveUdpAddress(host, 5004, nullptr));
    ASSERT_TRUE(address) << host;
    EXPECT_EQ(g_inet_socket_address_get_scope_id(G_INET_SOCKET_ADDRESS(address.get())), lo);
    const gst::SocketAddressPtr again(
        gst::ResolveUdpAddress(gst::HostOf(address.get()), 5004, nullptr));
    EXPECT_TRUE(gst::SameAddress(address.get(), again.get()));
  }
}

TEST(UdpAddress, IsTheSameInEitherFamilyAndItsHostAtAnyPort) {
  const SocketAddressPtr robot(test::Address("10.0.0.1", 5004)),
      mapped(test::Address("::ffff:10.0.0.1", 5004)), port(test::Address("10.0.0.1", 5005)),
      host(test::Address("10.0.0.2", 5004)), v6(test::Address("fd00::1", 5004));
  EXPECT_TRUE(SameAddress(robot.get(), mapped.get()));
  EXPECT_TRUE(SameHost(robot.get(), mapped.get()));
  EXPECT_FALSE(SameAddress(robot.get(), port.get()));
  EXPECT_TRUE(SameHost(robot.get(), port.get()));
  for (const SocketAddressPtr* other : {&host, &v6}) {
    EXPECT_FALSE(SameAddress(robot.get(), other->get()));
    EXPECT_FALSE(SameHost(robot.get(), other->get()));
  }
  EXPECT_FALSE(SameAddress(robot.get(), nullptr));
  EXPECT_FALSE(SameAddress(nullptr, robot.get()));
  EXPECT_FALSE(SameHost(robot.get(), nullptr));
  EXPECT_FALSE(SameHost(nullptr, robot.get()));
  EXPECT_TRUE(SameAddress(nullptr, nullptr));
  EXPECT_FALSE(ToNative(v6.get(), G_SOCKET_FAMILY_IPV4).valid());
}

TEST(UdpAddress, IsShownAsUsersWriteIt) {
  const SocketAddressPtr v4(test::Address("10.0.0.1", 5004)), v6(test::Address("fd00::1", 5004));
  EXPECT_EQ(AddressToString(v4.get()), "10.0.0.1:5004");
  EXPECT_EQ(AddressToString(v6.get()), "[fd00::1]:5004");
  EXPECT_EQ(AddressToString(nullptr), "(none)");
  EXPECT_EQ(HostOf(v4.get()), "10.0.0.1");
  EXPECT_EQ(HostOf(v6.get()), "fd00::1");
  EXPECT_EQ(WithoutBrackets("[fd00::1]"), "fd00::1");
  for (const char* host : {"", "[]", "[x", "x]", "fd00::1", "edge"})
    EXPECT_EQ(WithoutBrackets(host), host);
}

TEST(WakeFd, StaysWokenUntilItIsClearedAndComesBeforeData) {
  int data[2];
  ASSERT_EQ(pipe2(data, O_CLOEXEC), 0);
  WakeFd wake;
  const auto outcome = [&](gint64 timeout_ns) { return wake.Wait(data[0], POLLIN, timeout_ns); };
  using Outcome = WakeFd::Outcome;
  EXPECT_EQ(outcome(0), Outcome::kTimeout);
  const gint64 before = g_get_monotonic_time();
  EXPECT_EQ(outcome(20'000'000), Outcome::kTimeout);
  EXPECT_GE(g_get_monotonic_time() - before, 20'000) << "nanoseconds";
  ASSERT_EQ(write(data[1], "x", 1), 1);
  EXPECT_EQ(outcome(-1), Outcome::kReady);
  for (int i = 0; i < 2; ++i) wake.Wake();
  EXPECT_EQ(outcome(-1), Outcome::kWoken);
  EXPECT_EQ(outcome(0), Outcome::kWoken);
  for (int i = 0; i < 2; ++i) wake.Clear();
  EXPECT_EQ(outcome(0), Outcome::kReady);
  close(data[0]);
  close(data[1]);
}

struct Destination {
  const char* address;
  GSocketFamily of_socket;
  bool is_v4;  // the IPv4 stack sends the datagram
};
class UdpControl : public ::testing::TestWithParam<Destination> {};

/// Returns the value of the control message with this `level` and `type`, or nothing if there is
/// none.
template <class Value>
std::optional<Value> ControlOf(msghdr* message, int level, int type) {
  for (cmsghdr* c = CMSG_FIRSTHDR(message); c != nullptr; c = CMSG_NXTHDR(message, c)) {
    if (c->cmsg_level != level || c->cmsg_type != type) continue;
    Value value{};
    EXPECT_EQ(c->cmsg_len, CMSG_LEN(sizeof value));
    std::memcpy(&value, CMSG_DATA(c), sizeof value);
    return value;
  }
  return std::nullopt;
}

TEST_P(UdpControl, HasTheCodepointAndTheInterfaceOfTheStackThatSends) {
  const Destination& d = GetParam();
  const SocketAddressPtr to(test::Address(d.address, 5004));
  const NativeAddress native = ToNative(to.get(), d.of_socket);
  for (const unsigned interface : {0U, 7U}) {
    net::SendControl control;
    msghdr message{};
    net::SetControl(0xb9, native, interface, &control, &message);
    EXPECT_EQ(message.msg_control, control.bytes);
    EXPECT_LE(message.msg_controllen, sizeof control.bytes);
    const auto tos = ControlOf<int>(&message, IPPROTO_IP, IP_TOS);
    const auto traffic_class = ControlOf<int>(&message, IPPROTO_IPV6, IPV6_TCLASS);
    const auto v4 = ControlOf<in_pktinfo>(&message, IPPROTO_IP, IP_PKTINFO);
    const auto v6 = ControlOf<in6_pktinfo>(&message, IPPROTO_IPV6, IPV6_PKTINFO);
    EXPECT_EQ(d.is_v4 ? tos : traffic_class, 0xb9);
    EXPECT_FALSE(d.is_v4 ? traffic_class : tos);
    EXPECT_EQ(v4 ? v4->ipi_ifindex : 0, d.is_v4 ? static_cast<int>(interface) : 0);
    EXPECT_EQ(v6 ? v6->ipi6_ifindex : 0, d.is_v4 ? 0 : interface);
  }
}
INSTANTIATE_TEST_SUITE_P(All, UdpControl,
                         ::testing::Values(Destination{"10.0.0.1", G_SOCKET_FAMILY_IPV4, true},
                                           Destination{"10.0.0.1", G_SOCKET_FAMILY_IPV6, true},
                                           Destination{"fd00::1", G_SOCKET_FAMILY_IPV6, false}));

/// This test uses a Unix socket, because its receive queue can fill up and block the sender. A UDP
/// socket would drop datagrams instead.
TEST(UdpBatch, WhatWaitsForAFullSocketIsGivenUpWhenTheElementStops) {
  const auto unix_socket = [] { return socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0); };
  const int receiver = unix_socket(), sender = unix_socket();
  NativeAddress to;
  sockaddr_un any{};
  any.sun_family = AF_UNIX;
  ASSERT_EQ(bind(receiver, reinterpret_cast<sockaddr*>(&any), sizeof any.sun_family), 0);
  to.length = sizeof to.storage;
  ASSERT_EQ(getsockname(receiver, to.get(), &to.length), 0);
  while (sendto(sender, "?", 1, MSG_DONTWAIT, to.get(), to.length) == 1) continue;
  ASSERT_EQ(errno, EAGAIN);
  char byte = 0;
  for (int i = 0; i < 2; ++i) ASSERT_EQ(recv(receiver, &byte, 1, MSG_DONTWAIT), 1);
  WakeFd wake;
  wake.Wake();
  UdpBatchSender batch;
  const BufferPtr buffer(test::FromBytes({'f', 'o', 'u', 'r'}));
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(batch.Add(buffer.get(), 0, to));
  const UdpBatchSender::Result result = batch.Flush(sender, wake);
  EXPECT_EQ(result.packets, 2U);
  EXPECT_EQ(result.bytes, 8U);
  EXPECT_EQ(result.errors, 3U);
  EXPECT_TRUE(result.woken);
  EXPECT_EQ(result.last_errno, 0);
  while (recv(receiver, &byte, 1, MSG_DONTWAIT) == 1) continue;
  const UdpBatchSender::Result next = batch.Flush(sender, wake);
  EXPECT_EQ(next.packets + next.errors, 0U) << "nothing is sent later";
  EXPECT_FALSE(next.woken);
  close(receiver);
  close(sender);
}

TEST_F(Latch, CannotBeStolenWhileThePeerSends) {
  Stream(robot, 1, 0, 10);
  for (std::uint16_t seq = 10; seq < 1000; ++seq, now += 10ms) {
    EXPECT_EQ(Send(thief, 1, seq), kForeign);
    EXPECT_EQ(Send(robot, 1, seq), kAccepted);
  }
}

TEST_F(Latch, OnePacketAfterSilenceDoesNotMoveItButAStreamDoes) {
  Stream(robot, 1, 0, 10);
  now += 10s;
  EXPECT_FALSE(Stream(thief, 2, 0, PeerLatch::kProbation));
  EXPECT_TRUE(Stream(thief, 2, PeerLatch::kProbation, 1));
  EXPECT_FALSE(latch.IsPeer(robot.get()));
}

TEST_F(Latch, ScatteredOrRepeatedSequenceNumbersAreNoStream) {
  Stream(robot, 1, 0, 10);
  now += 10s;
  for (std::uint16_t seq = 0; seq < 100; ++seq) {
    EXPECT_EQ(Send(thief, 1, static_cast<std::uint16_t>(seq * 1103)), kForeign);
    EXPECT_EQ(Send(thief, 2, 7), kForeign);
  }
}

TEST_F(Latch, AStreamWithGapsIsAStream) {
  Stream(robot, 1, 0, 10);
  now += 10s;
  bool moved = false;
  for (std::uint16_t seq = 0; seq < 10; ++seq)
    moved |= Send(thief, 1, static_cast<std::uint16_t>(seq * 90)) == kMoved;
  EXPECT_TRUE(moved);
}

TEST_F(Latch, FollowsASenderThatMovesWithAnyNumberOfInterleavedStreams) {
  for (std::uint32_t streams : {1U, 2U, 3U, 16U}) {
    latch = PeerLatch();
    std::uint16_t seq = 0;
    for (; seq < 100; ++seq, now += 20ms)
      for (std::uint32_t s = 0; s < streams; ++s) Send(robot, s, seq);
    const Time moved_at = now;
    bool moved = false;
    for (; !moved && now < moved_at + 5s; ++seq, now += 20ms)
      for (std::uint32_t s = 0; s < streams; ++s) moved |= Send(other, s, seq) == kMoved;
    EXPECT_LT(now - moved_at, 1s) << streams;
  }
}

TEST_F(Latch, WhoSendsFirstAndSeldomLosesThePlaceToTheFirstStream) {
  Send(thief, 9, 0);
  std::uint16_t knock = 1;
  std::uint16_t seq = 0;
  bool moved = false;
  for (int ms = 0; ms < 2000; ms += 20, now += 20ms) {
    if (ms % 400 == 0) Send(thief, 9, knock++);
    moved |= Send(robot, 1, seq++) == kMoved;
  }
  EXPECT_TRUE(moved);
  EXPECT_TRUE(latch.IsPeer(robot.get()));
}

TEST_F(Latch, AStreamWithoutSlicesNeitherKeepsNorTakesThePlaceOfOneWithSlices) {
  Stream(thief, 9, 0, 500);  // the thief sends before the robot, and for a longer time
  EXPECT_TRUE(Stream(robot, 1, 0, 10, true));
  now += 1s;  // the robot's link is interrupted
  EXPECT_FALSE(Stream(thief, 9, 500, 200));
  EXPECT_TRUE(latch.IsPeer(robot.get()));
}

TEST_F(Latch, TheSenderComesBackWhenAnotherTookItsPlaceInAnOutage) {
  Stream(robot, 1, 0, 100, true);
  now += 6s;
  EXPECT_TRUE(Stream(thief, 9, 0, 20));
  EXPECT_TRUE(Stream(robot, 1, 150, 6));  // the thief sent until just before this
  now += 1s;
  EXPECT_TRUE(Stream(thief, 9, 20, 20, true));  // the thief makes slices of its own
  EXPECT_TRUE(Stream(other, 1, 200, 6));        // the sender's address has changed
  EXPECT_FALSE(Stream(thief, 9, 40, 40, true));
}

TEST_F(Latch, AKnownSenderMayHaveLostMuchOnTheWay) {
  Stream(robot, 1, 0, 100, true);
  now += 1s;
  EXPECT_TRUE(Stream(other, 1, 5'000, 8));
}

TEST_F(Latch, NumbersOfBeforeAMoveAreKnownNoMore) {
  Stream(robot, 1, 0, 100, true);
  now += 1s;
  EXPECT_TRUE(Stream(other, 1, 5'000, 100, true));
  now += 1s;
  EXPECT_FALSE(Stream(thief, 1, 101, 20));
  EXPECT_TRUE(Stream(robot, 1, 5'101, 8));
}

TEST_F(Latch, WhoWasOutweighedWhileItSentIsNotKnown) {
  Stream(robot, 1, 0, 100, true);
  now += 6s;
  EXPECT_TRUE(Stream(thief, 9, 0, 20, true));
  EXPECT_TRUE(Stream(robot, 1, 150, 6));
  now += 1s;
  EXPECT_FALSE(Stream(thief, 9, 20, 20));
}

TEST_F(Latch, AnSsrcIsKnownForMinutesAndNotForEver) {
  Stream(robot, 1, 0, 100, true);
  now += 6s;
  EXPECT_TRUE(Stream(thief, 9, 0, 20, true));
  now += PeerLatch::kStandingMemory;
  Stream(thief, 9, 20, 20, true);
  EXPECT_FALSE(Stream(robot, 1, 150, 20));
}

TEST_F(Latch, TheSenderComesBackWhenAnotherBeganTheNextSession) {
  Stream(robot, 1, 0, 100, true);
  latch.Restart();
  now += 1s;
  EXPECT_FALSE(Stream(thief, 9, 0, 100, true));
  EXPECT_TRUE(Stream(robot, 1, 150, 6));
  EXPECT_FALSE(Stream(thief, 9, 100, 40, true));
}

TEST_F(Latch, AKnownSsrcIsNotKnownTwiceInTheNextSession) {
  Stream(robot, 1, 0, 100, true);
  latch.Restart();
  Stream(robot, 1, 100, 100);  // a new sender with that SSRC
  EXPECT_FALSE(Stream(thief, 1, 150, 20, true));
}

TEST_F(Latch, AnSsrcThatWentBackBeginsAnewAfterAWhile) {
  Stream(robot, 1, 0, 10);
  now += 10s;
  Send(other, 2, 40'000);
  now += 2s;
  EXPECT_TRUE(Stream(other, 2, 0, 8));
}

TEST_F(Latch, RemembersSoManySsrcsOfAPeer) {
  Stream(robot, 1, 0, 10, true);
  for (std::uint32_t ssrc = 2; ssrc < 500; ++ssrc, now += 1ms) Send(robot, ssrc, 10);
  now += 1s;
  EXPECT_FALSE(Stream(thief, 1, 10, 20));
  EXPECT_TRUE(Stream(other, 499, 11, 8));
}

TEST_F(Latch, ForgetsNoSsrcOfAPeerThatHasAsManyAsItRemembers) {
  Stream(robot, 1, 0, 10, true);
  for (std::uint16_t seq = 0; seq < 3; ++seq, now += 10ms)
    for (std::uint32_t ssrc = 2; ssrc <= 64; ++ssrc) Send(robot, ssrc, seq);
  now += 1s;
  EXPECT_TRUE(Stream(other, 1, 10, 8));
}

TEST_F(Latch, APacketNowAndThenIsNoStream) {
  Stream(robot, 1, 0, 10);
  now += 10s;
  for (std::uint16_t seq = 0; seq < 50; ++seq, now += 400ms)
    EXPECT_EQ(Send(thief, 2, seq), kForeign) << seq;
}

TEST_F(Latch, AFloodOfRandomSsrcsDoesNotHideASenderThatMoved) {
  std::uint16_t seq = 0;
  for (; seq < 100; ++seq, now += 10ms) Send(robot, 1, seq, true);
  const Time moved_at = now;
  bool moved = false;
  for (std::uint32_t flood = 1000; !moved && now < moved_at + 5s; ++flood, now += 5ms) {
    const AddressPtr from(test::Address("10.9.9.9", static_cast<guint16>(flood)));
    EXPECT_EQ(Send(from, flood, 7), kForeign);
    EXPECT_EQ(Send(thief, flood, 7), kForeign);
    if (flood % 2 == 0) moved = Send(other, 1, seq++) == kMoved;
  }
  EXPECT_LT(now - moved_at, 1s);
}

TEST_F(Latch, PacketsWithoutAddressBelongToAnyPeer) {
  EXPECT_EQ(latch.OnPacket(now, {nullptr, 1, 0, {}}), kAccepted);
  EXPECT_EQ(latch.peer(), nullptr);
  EXPECT_EQ(Send(robot, 1, 1), kAccepted);
  EXPECT_EQ(latch.peer(), robot.get());
  EXPECT_EQ(Send(thief, 1, 2), kForeign);
}

TEST_F(Latch, FeedbackFromAnotherAddressIsANewPathOnceTheOldOneIsSilent) {
  FeedbackPeer peer;
  EXPECT_FALSE(peer.OnFeedback(now, robot.get()));
  EXPECT_FALSE(peer.OnFeedback(now + 400ms, thief.get()));
  EXPECT_FALSE(peer.OnFeedback(now + 400ms, robot.get()));
  EXPECT_TRUE(peer.OnFeedback(now + 1s, thief.get()));
  EXPECT_FALSE(peer.OnFeedback(now + 1s, nullptr));
  EXPECT_TRUE(peer.OnFeedback(now - 1h, robot.get()));  // after the clock was set back
}

DataRate Bps(int n) { return DataRate::BitsPerSecond(n); }

/// Expects that the fields `names` of `shown` have the values 1, 2, and so on, in this order.
void ExpectInOrder(const StructurePtr& shown, const std::vector<const char*>& names) {
  const test::Stats stats(shown.get());
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(stats[names[i]], i + 1) << names[i];
}

TEST(TxFigures, OfTheControllerHaveEachItsOwnName) {
  scream::Statistics s;
  s.target_bitrate = Bps(1);
  s.sent_bitrate = Bps(2);
  s.acked_bitrate = Bps(3);
  s.estimated_capacity = Bps(4);
  s.pace_bitrate = Bps(5);
  s.qdelay = 6ns;
  s.qdelay_avg = 7ns;
  s.qdelay_target = 8ns;
  s.s_rtt = 9ns;
  s.min_rtt = 10ns;
  s.ref_wnd = DataSize::Bytes(11);
  s.bytes_in_flight = DataSize::Bytes(12);
  s.queued = DataSize::Bytes(13);
  s.media_qdelay = 14ns;
  s.packets_sent = 15;
  s.packets_acked = 16;
  s.packets_lost = 17;
  s.packets_late = 18;
  s.packets_ce = 19;
  s.packets_dropped = 20;
  s.bytes_sent = DataSize::Bytes(21);
  s.bytes_acked = DataSize::Bytes(22);
  s.feedback_accepted = 23;
  s.feedback_ignored = 24;
  s.foreign_blocks = 25;
  s.feedback_timeouts = 26;
  s.loss_events = 27;
  s.ce_events = 28;
  s.delay_events = 29;
  s.capacity_drops = 30;
  s.gaps = 31;
  s.clock_resets = 32;
  s.l4s_alpha = 0.25;
  s.loss_rate = 0.5;
  s.cross_traffic = 0.75;
  s.ecn_state = scream::EcnState::kBleached;
  s.reason = scream::RateReason::kDrop;
  const StructurePtr shown = ShowController(s);
  ExpectInOrder(shown, {"target-bitrate",
                        "sent-bitrate",
                        "acked-bitrate",
                        "estimated-capacity",
                        "pace-bitrate",
                        "queue-delay",
                        "queue-delay-avg",
                        "queue-delay-target",
                        "rtt",
                        "min-rtt",
                        "ref-wnd",
                        "bytes-in-flight",
                        "queued-bytes",
                        "sender-queue-delay",
                        "packets-sent",
                        "packets-acked",
                        "packets-lost",
                        "packets-late",
                        "packets-ce",
                        "packets-dropped",
                        "bytes-sent",
                        "bytes-acked",
                        "feedback-accepted",
                        "feedback-ignored",
                        "feedback-foreign-blocks",
                        "feedback-timeouts",
                        "loss-events",
                        "ce-events",
                        "delay-events",
                        "capacity-drops",
                        "gaps",
                        "clock-resets"});
  for (const auto& [name, value] :
       {std::pair("l4s-alpha", 0.25), {"loss-rate", 0.5}, {"cross-traffic", 0.75}}) {
    gdouble number = 0;
    EXPECT_TRUE(gst_structure_get_double(shown.get(), name, &number));
    EXPECT_EQ(number, value) << name;
  }
  EXPECT_EQ(test::Stats(shown.get()).Text("ecn-state"), "bleached");
  EXPECT_EQ(test::Stats(shown.get()).Text("reason"), "capacity-drop");
}

TEST(TxFigures, OfAStreamHaveEachItsOwnName) {
  ShownStream s;
  s.ssrc = 1;
  s.core.target_bitrate = Bps(2);
  s.encoder_bps = 3;
  s.config.needed_bitrate = Bps(4);
  s.config.max_bitrate = Bps(5);
  s.core.sent_bitrate = Bps(6);
  s.core.queued = DataSize::Bytes(7);
  s.core.media_qdelay = 8ns;
  s.own = {9, 13, 17};
  s.core.packets_sent = 10;
  s.core.packets_dropped = 11;
  s.core.packets_lost = 12;
  s.core.packets_ce = 14;
  s.core.bytes_sent = DataSize::Bytes(15);
  s.pad = "sink_7";
  const StructurePtr shown = ShowStream(s);
  ExpectInOrder(shown, {"ssrc", "target-bitrate", "encoder-bitrate", "min-bitrate", "max-bitrate",
                        "sent-bitrate", "queued-bytes", "sender-queue-delay", "packets-queued",
                        "packets-sent", "packets-dropped", "packets-lost", "frames-dropped",
                        "packets-ce", "bytes-sent"});
  EXPECT_EQ(test::Stats(shown.get())["malformed"], 17U);
  EXPECT_EQ(test::Stats(shown.get()).Text("pad"), "sink_7");
}

TEST(TxFigures, TellReasonsAndEcnStatesInWords) {
  using Ecn = scream::EcnState;
  using Why = scream::RateReason;
  for (const auto& [state, word] : {std::pair(Ecn::kOff, "off"),
                                    {Ecn::kTesting, "testing"},
                                    {Ecn::kCapable, "capable"},
                                    {Ecn::kBleached, "bleached"},
                                    {Ecn::kSilent, "silent"}})
    EXPECT_STREQ(scream::ToString(state), word);
  for (const auto& [reason, word] : {std::pair(Why::kStart, "start"),
                                     {Why::kIncrease, "increase"},
                                     {Why::kCe, "ce"},
                                     {Why::kLoss, "loss"},
                                     {Why::kDelay, "delay"},
                                     {Why::kDrop, "capacity-drop"},
                                     {Why::kTimeout, "no-feedback"}})
    EXPECT_STREQ(scream::ToString(reason), word);
}

TxSettings Tuned(const char* tuning) {
  TxSettings settings;
  settings.tuning.reset(gst_structure_from_string(tuning, nullptr), gst_structure_free);
  return settings;
}

/// Returns the value of a tunable member of `p` as a number.
struct TunableValue {
  const scream::Parameters& p;
  double operator()(bool scream::Extensions::*m) const { return p.extensions.*m; }
  double operator()(bool scream::Parameters::*m) const { return p.*m; }
  double operator()(double scream::Parameters::*m) const { return p.*m; }
  double operator()(Duration scream::Parameters::*m) const {
    return static_cast<double>((p.*m).count());
  }
  double operator()(DataSize scream::Parameters::*m) const {
    return static_cast<double>((p.*m).bytes());
  }
  double operator()(DataRate scream::Parameters::*m) const { return (p.*m).bits_per_second(); }
};

TEST(TxSettings, ReachTheController) {
  const scream::Parameters usual = ToParameters({}), defaults;
  EXPECT_EQ(usual.ecn, Ecn::kEct1);
  EXPECT_EQ(usual.max_total_bitrate, defaults.max_total_bitrate);
  EXPECT_EQ(usual.max_queue_delay, defaults.max_queue_delay);
  EXPECT_EQ(usual.feedback_interval, Duration{});
  TxSettings settings;
  settings.max_total_bps = 123'456;
  settings.max_queue_delay = 77ms;
  settings.feedback_interval = 55ms;
  for (const bool pure : {false, true}) {
    settings.pure_draft = pure;
    for (const auto& [mode, ecn] : {std::pair(int{kEcnOff}, Ecn::kNotEct),
                                    {int{kEcnEct0}, Ecn::kEct0},
                                    {int{kEcnEct1}, Ecn::kEct1}}) {
      settings.ecn_mode = mode;
      const scream::Parameters p = ToParameters(settings);
      EXPECT_EQ(p.ecn, ecn);
      EXPECT_EQ(p.max_total_bitrate, DataRate::BitsPerSecond(123'456));
      EXPECT_EQ(p.max_queue_delay, Duration{77ms});
      EXPECT_EQ(p.feedback_interval, Duration{55ms});
    }
  }
}

TEST(Tuning, SetsWhatItNamesAndNothingElse) {
  const scream::Parameters defaults;
  const TunableValue usual{defaults};
  for (const scream::Tunable& t : scream::Tunables()) {
    const double other = std::visit(usual, t.member) == t.max ? t.min : t.max;
    const std::string text = "tuning," + std::string(t.name) + "=" + std::to_string(other);
    const scream::Parameters p = ToParameters(Tuned(text.c_str()));
    for (const scream::Tunable& u : scream::Tunables())
      EXPECT_EQ(std::visit(TunableValue{p}, u.member),
                &u == &t ? other : std::visit(usual, u.member))
          << text << " " << u.name;
  }
}

TEST(Tuning, TakesNamesWithUnderscores) {
  EXPECT_EQ(ToParameters(Tuned("tuning,beta_loss=0.6")).beta_loss, 0.6);
}

TEST(Tuning, TakesNumbersAndSwitchesAsUsersWriteThem) {
  const auto p = ToParameters(Tuned("tuning,beta-loss=0.6,mss=1200,capacity=false"));
  EXPECT_EQ(p.beta_loss, 0.6);
  EXPECT_EQ(p.mss, DataSize::Bytes(1200));
  EXPECT_FALSE(p.extensions.capacity);
}

TEST(Tuning, IsUndoneByThePureDraft) {
  TxSettings settings = Tuned("tuning,beta-loss=0.6");
  settings.pure_draft = true;
  EXPECT_EQ(ToParameters(settings).beta_loss, scream::Parameters().beta_loss);
}

TEST(Tuning, SaysWhatIsWrong) {
  const auto wrong = [](const char* tuning) {
    scream::Parameters p;
    return ReadTuning(Tuned(tuning).tuning.get(), &p);
  };
  EXPECT_EQ(wrong("tuning,beta-loss=0.6"), "");
  EXPECT_NE(wrong("tuning,beta=0.6").find("\"beta\" is not one of qdelay-target-lo, min-ref-wnd,"),
            std::string::npos);
  EXPECT_EQ(wrong("tuning,beta-loss=1.5"), "\"beta-loss\" must be a number from 0.1 to 1");
  EXPECT_EQ(wrong("tuning,beta-loss=much"), "\"beta-loss\" must be a number from 0.1 to 1");
  EXPECT_EQ(wrong("tuning,capacity=2"), "\"capacity\" must be true or false");
  scream::Parameters p;
  const double no_number = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(scream::FindTunable("beta-loss")->Set(no_number, &p));
}

}  // namespace
}  // namespace lidar::gst
