// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests SRTP in screamsink and screamsrc: over loopback, and through a link that can read and forge
// packets.
#include <gtest/gtest.h>

#include <thread>

#include "tests/system/faults/srtp_path.h"

namespace lidar::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST_P(Srtp, CarriesTheStreamAndItsFeedbackHidden) {
  const std::string options = GetParam().options + std::string(" ") + Key(GetParam().key_bytes);
  Path path(options, options);
  path.Play();
  ASSERT_NE(path.receiver.NextCloud(seconds(5)), milliseconds::max());
  std::this_thread::sleep_for(seconds(2));
  EXPECT_GT(path.receiver.clouds(), 80U);
  EXPECT_EQ(path.receiver.foreign(), 0U);
  EXPECT_EQ(path.receiver.accounts().lost, 0U);
  // The packets are encrypted, so the link recognises slices in them only by chance.
  EXPECT_GT(path.link.counts().packets, 100U);
  EXPECT_LT(path.link.counts().slices, 3U);
  Pipeline& sender = path.sender.pipeline();
  EXPECT_GT(sender.Stat("net", "feedback-accepted"), 20U);
  EXPECT_EQ(sender.Stat("net", "packets-lost"), 0U);
  EXPECT_EQ(sender.Stat("net", "srtp-refused"), 0U);
  EXPECT_EQ(path.receiver.pipeline().Stat("net", "srtp-refused"), 0U);
  // The sender sends an encrypted BYE at EOS. The BYE ends the stream of the receiver.
  EXPECT_TRUE(sender.Finish(seconds(5)));
}
INSTANTIATE_TEST_SUITE_P(Ciphers, Srtp,
                         ::testing::Values(Suite{"srtp-cipher=aes-128-icm", 30},
                                           Suite{"srtp-auth=hmac-sha1-32", 30},
                                           Suite{"srtp-cipher=aes-256-icm", 46},
                                           Suite{"srtp-cipher=aes-128-gcm", 28},
                                           Suite{"srtp-cipher=aes-256-gcm", 44}));

TEST(Srtp, TellsTheSenderOfMarks) {
  Path path(Key(30), Key(30));
  path.Play();
  ASSERT_NE(path.receiver.NextCloud(seconds(5)), milliseconds::max());
  EXPECT_EQ(path.sender.pipeline().Stat("net", "packets-ce"), 0U);
  Fault marking;
  marking.mark = 0.2;
  path.link.Set(marking);
  std::this_thread::sleep_for(seconds(2));
  EXPECT_GT(path.sender.pipeline().Stat("net", "packets-ce"), 20U);
  EXPECT_EQ(path.receiver.accounts().lost, 0U);
}

TEST(Srtp, RefusesAnotherKeyWithOneMessage) {
  Path path(Key(30, '5'), Key(30, '6'));
  path.Play();
  std::this_thread::sleep_for(seconds(2));
  EXPECT_EQ(path.receiver.clouds(), 0U);
  EXPECT_GT(path.receiver.pipeline().Stat("net", "srtp-refused"), 50U);
  EXPECT_EQ(path.receiver.pipeline().Messages(GST_MESSAGE_WARNING), 1U);
  EXPECT_EQ(path.receiver.pipeline().Error(), "");
}

TEST(Srtp, RefusesPacketsThatAreNotProtected) {
  Path path("", Key(30));
  path.Play();
  std::this_thread::sleep_for(seconds(2));
  EXPECT_EQ(path.receiver.clouds(), 0U);
  EXPECT_EQ(path.receiver.pipeline().Messages(GST_MESSAGE_WARNING), 1U);
}

TEST(Srtp, RefusesFeedbackThatIsNotAuthenticated) {
  // The receiver has no key, so it cannot read the media. It still sends reports, because the
  // packets look like RTP.
  Path path(Key(30), "");
  path.Play();
  std::this_thread::sleep_for(seconds(2));
  EXPECT_EQ(path.sender.pipeline().Stat("net", "feedback-accepted"), 0U);
  EXPECT_GT(path.sender.pipeline().Stat("net", "srtp-refused"), 0U);
}

TEST(Srtp, RefusesReplayedPacketsAndCountsThem) {
  Path path(Key(30), Key(30));
  Fault twice;
  twice.duplicate = 1;
  path.link.Set(twice);
  path.Play();
  ASSERT_NE(path.receiver.NextCloud(seconds(5)), milliseconds::max());
  std::this_thread::sleep_for(seconds(2));
  EXPECT_GT(path.receiver.pipeline().Stat("net", "srtp-refused"), 50U);
  EXPECT_EQ(path.receiver.accounts().lost, 0U);
  EXPECT_EQ(path.receiver.pipeline().Stat("depay", "packets-duplicate"), 0U);
}

TEST(Srtp, IsJoinedAmongAFloodOfStrangers) {
  Path path(Key(30), Key(30));
  Fault flood;
  flood.garbage_ratio = 100;
  flood.valid_garbage = true;
  path.link.Set(flood);
  path.Play();
  EXPECT_LT(path.receiver.NextCloud(seconds(8)), seconds(3));
  std::this_thread::sleep_for(seconds(1));
  const auto clouds = path.receiver.clouds();
  std::this_thread::sleep_for(seconds(1));
  // The sender sends 80 slices during this second.
  EXPECT_GT(path.receiver.clouds(), clouds + 30);
  EXPECT_EQ(path.receiver.pipeline().Messages(GST_MESSAGE_WARNING), 1U);
}

/// Waits until at least `packets` packets have passed the link.
void WaitForPackets(const Path& path, std::uint64_t packets) {
  for (int i = 0; i < 3'000; ++i) {
    if (path.link.counts().packets >= packets) return;
    std::this_thread::sleep_for(milliseconds(10));
  }
  ADD_FAILURE() << "fewer than " << packets << " packets were sent within 30 s";
}

TEST(Srtp, IsJoinedAfterTheSequenceNumbersWrapped) {
  Path path(Key(30) + " sender-report-interval=100000000", Key(30));
  g_object_set(path.sender.pipeline().Child("pay").get(), "seqnum-offset", 65'526, nullptr);
  path.sender.pipeline().SetState(GST_STATE_PLAYING);
  // The sequence numbers wrap after ten packets. The receiver starts after 65 packets. By then the
  // sender has used up its first window of 57 packets, and there is no feedback yet that would let
  // it send many more.
  WaitForPackets(path, 65);
  path.receiver.pipeline().SetState(GST_STATE_PLAYING);
  EXPECT_NE(path.receiver.NextCloud(seconds(20)), milliseconds::max());
  // No packet is refused, because the receiver tries other values of the rollover counter than 0
  // for the first packet.
  EXPECT_EQ(path.receiver.pipeline().Stat("net", "srtp-refused"), 0U);
}

TEST(Srtp, RollsOverWithoutALoss) {
  Path path(Key(30), Key(30));
  g_object_set(path.sender.pipeline().Child("pay").get(), "seqnum-offset", 65'450, nullptr);
  path.Play();
  ASSERT_NE(path.receiver.NextCloud(seconds(5)), milliseconds::max());
  std::this_thread::sleep_for(seconds(3));
  ExpectNothingLost(&path);
}

TEST(Srtp, IsNotDelayedByForgedPacketsBeforeTheFirst) {
  Path path(Key(30), Key(30));
  Fault forged;
  forged.damage = 1;
  path.link.Set(forged);
  path.Play();
  WaitForRefused(path, 200);
  path.link.Set({});
  EXPECT_LT(path.receiver.NextCloud(seconds(8)), seconds(1));
}

TEST(Srtp, ForgetsNothingForForgedPackets) {
  Path path(Key(30), Key(30));
  g_object_set(path.sender.pipeline().Child("pay").get(), "seqnum-offset", 65'450, nullptr);
  path.Play();
  ASSERT_NE(path.receiver.NextCloud(seconds(5)), milliseconds::max());
  std::this_thread::sleep_for(seconds(1));
  Fault forged;
  forged.damage = 1;
  path.link.Set(forged);
  WaitForRefused(path, 100);
  std::this_thread::sleep_for(seconds(2));
  path.link.Set({});
  EXPECT_LT(path.receiver.NextCloud(seconds(8)), seconds(1));
  // The forged packets have not changed the replay window, so the receiver still refuses duplicates
  // of packets that it received.
  const auto before = path.receiver.pipeline().Stat("net", "srtp-refused");
  Fault twice;
  twice.duplicate = 1;
  path.link.Set(twice);
  WaitForRefused(path, before + 50);
  EXPECT_EQ(path.receiver.pipeline().Stat("depay", "packets-duplicate"), 0U);
}

TEST(Srtp, WorksAgainAfterReadyAndNull) {
  Path path(Key(30), Key(30));
  for (const GstState rest : {GST_STATE_READY, GST_STATE_NULL}) {
    path.Play();
    EXPECT_NE(path.receiver.NextCloud(seconds(5)), milliseconds::max());
    std::this_thread::sleep_for(milliseconds(300));
    path.sender.pipeline().SetState(rest);
    path.receiver.pipeline().SetState(rest);
  }
  path.Play();
  EXPECT_NE(path.receiver.NextCloud(seconds(5)), milliseconds::max());
}

}  // namespace
}  // namespace lidar::test
