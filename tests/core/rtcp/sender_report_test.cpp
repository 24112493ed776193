// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests the bytes of the sender's report.
#include "src/rtcp/sender_report.h"

#include <gtest/gtest.h>

#include "src/rtcp/ccfb.h"
#include "tests/core/rtcp/bytes.h"

namespace lidar::rtcp {
namespace {

using std::chrono::microseconds;

constexpr std::size_t kAppAt = 8;  // the offset after the empty receiver report

SenderReport Sample() {
  SenderReport r;
  r.ssrc = 0x12345678;
  r.time_ms = 4'000'000'000;
  r.target_bitrate = DataRate::BitsPerSecond(12'345'678);
  r.estimated_capacity = DataRate::BitsPerSecond(20e6);
  r.sent_bitrate = DataRate::BitsPerSecond(11e6);
  r.ref_wnd = DataSize::Bytes(90'000);
  r.bytes_in_flight = DataSize::Bytes(61'234);
  r.queue_delay = microseconds(1234);
  r.rtt = microseconds(43'210);
  r.sender_queue_delay = microseconds(777);
  r.packets_sent = 1'000'001;
  r.packets_lost = 17;
  r.packets_ce = 4321;
  r.packets_dropped = 5;
  return r;
}

TEST(SenderReport, ComesBackAsItWas) {
  const SenderReport sent = Sample();
  const Bytes bytes = BuildSenderReport(sent);
  EXPECT_EQ(bytes.size(), 72U);
  EXPECT_EQ(SplitRtcp(View(bytes)).size(), 2U);
  EXPECT_TRUE(HasSenderReport(View(bytes)));
  const auto r = ParseSenderReport(View(bytes));
  ASSERT_TRUE(r);
  EXPECT_EQ(r->ssrc, sent.ssrc);
  EXPECT_EQ(r->time_ms, sent.time_ms);
  EXPECT_EQ(r->target_bitrate, sent.target_bitrate);
  EXPECT_EQ(r->estimated_capacity, sent.estimated_capacity);
  EXPECT_EQ(r->sent_bitrate, sent.sent_bitrate);
  EXPECT_EQ(r->ref_wnd, sent.ref_wnd);
  EXPECT_EQ(r->bytes_in_flight, sent.bytes_in_flight);
  EXPECT_EQ(r->queue_delay, sent.queue_delay);
  EXPECT_EQ(r->rtt, sent.rtt);
  EXPECT_EQ(r->sender_queue_delay, sent.sender_queue_delay);
  EXPECT_EQ(r->packets_sent, sent.packets_sent);
  EXPECT_EQ(r->packets_lost, sent.packets_lost);
  EXPECT_EQ(r->packets_ce, sent.packets_ce);
  EXPECT_EQ(r->packets_dropped, sent.packets_dropped);
}

TEST(SenderReport, SaturatesWhatIsTooLarge) {
  SenderReport r;
  r.target_bitrate = DataRate::Infinite();
  r.estimated_capacity = DataRate::BitsPerSecond(-1);
  r.ref_wnd = DataSize::Infinite();
  r.queue_delay = Duration::min();
  r.rtt = Duration::max();
  const auto back = ParseSenderReport(View(BuildSenderReport(r)));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->target_bitrate, DataRate::BitsPerSecond(4294967295.0));
  EXPECT_EQ(back->estimated_capacity, DataRate());
  EXPECT_EQ(back->ref_wnd, DataSize::Bytes(4294967295));
  EXPECT_EQ(back->queue_delay, Duration{0});
  EXPECT_EQ(back->rtt, microseconds(4294967295));
}

TEST(SenderReport, IsRecognisedButNotReadInAVersionToCome) {
  Bytes bytes = BuildSenderReport(Sample());
  bytes[kAppAt] = 0x82;
  EXPECT_TRUE(HasSenderReport(View(bytes)));
  EXPECT_FALSE(ParseSenderReport(View(bytes)));
}

TEST(SenderReport, MayBeLongerThanWeKnow) {
  Bytes bytes = BuildSenderReport(Sample());
  bytes.resize(bytes.size() + 8, 0xaa);
  bytes[kAppAt + 3] += 2;
  const auto r = ParseSenderReport(View(bytes));
  ASSERT_TRUE(r);
  EXPECT_EQ(r->packets_dropped, 5U);
}

TEST(SenderReport, RefusesWhatIsNone) {
  const Bytes good = BuildSenderReport(Sample());
  for (std::size_t size = 0; size < good.size(); ++size)
    EXPECT_FALSE(ParseSenderReport({good.data(), size})) << size;
  Bytes shorter(good.begin(), good.end() - 4);
  shorter[kAppAt + 3] -= 1;
  EXPECT_FALSE(ParseSenderReport(View(shorter)));
  for (const auto& [at, value] : {std::pair{kAppAt + 1, 203}, {kAppAt + 8, 'X'}, {kAppAt, 0xa1}}) {
    Bytes other = good;
    other[at] = static_cast<std::uint8_t>(value);
    EXPECT_FALSE(HasSenderReport(View(other))) << at;
    EXPECT_FALSE(ParseSenderReport(View(other))) << at;
  }
}

}  // namespace
}  // namespace lidar::rtcp
