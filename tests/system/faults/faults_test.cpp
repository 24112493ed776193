// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests faults of the link and of both ends, and what a user sees of them.
#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>
#include <thread>

#include "tests/system/faults/fixture.h"

namespace lidar::test {
namespace {

TEST_F(Faults, NoneLosesNothing) {
  Start();
  std::this_thread::sleep_for(seconds(2));
  ExpectBooksAgree();
  EXPECT_EQ(receiver_->accounts().lost, 0U);
}

class LinkDown : public Faults, public ::testing::WithParamInterface<int> {};
TEST_P(LinkDown, CostsWhatItTookAndNoMore) {
  Start();
  Fault fault;
  fault.down = true;
  Suffer(fault, seconds(GetParam()));
  ExpectRecovery(("link down " + std::to_string(GetParam()) + " s").c_str(), seconds(3));
  ExpectBooksAgree();
}
INSTANTIATE_TEST_SUITE_P(Seconds, LinkDown, ::testing::Values(1, 10, 60));

class Loss : public Faults, public ::testing::WithParamInterface<int> {};
TEST_P(Loss, IsBookedSliceBySlice) {
  Start();
  Fault fault;
  fault.loss = GetParam() / 100.0;
  Suffer(fault, seconds(6));
  ExpectRecovery(("loss of " + std::to_string(GetParam()) + " %").c_str(), seconds(2));
  ExpectBooksAgree();
}
INSTANTIATE_TEST_SUITE_P(Percent, Loss, ::testing::Values(5, 20, 50));

TEST_F(Faults, ReorderingByTwentyPacketsLosesNothing) {
  Start();
  g_object_set(receiver_->pipeline().Child("depay").get(), "max-reorder-time", guint64{GST_SECOND},
               nullptr);
  Fault fault;
  fault.reorder_by = 20;
  Suffer(fault, seconds(5));
  ExpectRecovery("reordering by 20 packets", seconds(1));
  ExpectBooksAgree();
}

TEST_F(Faults, DuplicationShowsNothingTwice) {
  Start();
  Fault fault;
  fault.duplicate = 1;
  Suffer(fault, seconds(5));
  ExpectRecovery("every packet twice", seconds(1));
  ExpectBooksAgree();
  EXPECT_EQ(receiver_->accounts().lost, 0U);
}

TEST_F(Faults, ADroppedMtuIsLossUntilItIsBack) {
  Start();
  Fault fault;
  fault.mtu = 800;
  Suffer(fault, seconds(3));
  ExpectRecovery("datagrams past 800 bytes dropped for 3 s", seconds(2));
  ExpectBooksAgree();
}

TEST_F(Faults, DamageIsNeverShown) {
  Start();
  Fault fault;
  fault.damage = 0.1;
  Suffer(fault, seconds(5));
  ExpectRecovery("a wrong bit in 10 % of the packets", seconds(1));
  ExpectBooksAgree();
  EXPECT_GT(receiver_->accounts().damaged, 0U);
}

TEST_F(Faults, ADeadFeedbackPathSlowsTheSenderDownAndNothingElse) {
  Start();
  Fault fault;
  fault.feedback_loss = 1;
  Suffer(fault, seconds(5));
  ExpectRecovery("no feedback for 5 s", seconds(2));
  EXPECT_GT(sender_->pipeline().Stat("net", "feedback-timeouts"), 0U);
  ExpectBooksAgree();
}

TEST_F(Faults, ARestartedSenderIsFollowed) {
  Start();
  sender_.reset();
  StartSender();
  ExpectRecovery("sender killed and restarted", seconds(3));
  std::this_thread::sleep_for(seconds(1));
  EXPECT_TRUE(sender_->pipeline().Finish(seconds(10)));
  std::this_thread::sleep_for(milliseconds(300));
  const Accounts a = receiver_->accounts();
  EXPECT_EQ(a.restarts, 1U);
  EXPECT_EQ(a.received + a.mismatch, link_.counts().slices_whole);
  EXPECT_EQ(receiver_->clouds(), a.received);
  EXPECT_EQ(receiver_->foreign(), 0U);
  EXPECT_EQ(receiver_->pipeline().Error(), "");
}

TEST_F(Faults, ARestartedReceiverJoinsAgain) {
  Start();
  receiver_.reset();
  std::this_thread::sleep_for(milliseconds(500));
  StartReceiver();
  ExpectRecovery("receiver killed and restarted", seconds(3));
  EXPECT_EQ(sender_->pipeline().Error(), "");
}

TEST_F(Faults, BothMayRestart) {
  Start();
  sender_.reset();
  receiver_.reset();
  StartReceiver();
  StartSender();
  ExpectRecovery("both killed and restarted", seconds(3));
  EXPECT_EQ(receiver_->foreign(), 0U);
}

TEST_F(Faults, AnotherAddressOfTheSenderIsFollowed) {
  Start();
  link_.Rebind();
  ExpectRecovery("the sender's address changes (NAT)", seconds(3));
  const auto before = sender_->pipeline().Stat("net", "feedback-accepted");
  std::this_thread::sleep_for(seconds(1));
  EXPECT_GT(sender_->pipeline().Stat("net", "feedback-accepted"), before);
  EXPECT_TRUE(sender_->pipeline().Finish(seconds(10)));
  std::this_thread::sleep_for(milliseconds(300));
  // The receiver drops packets from the new address until it trusts the address. The slices in
  // these packets count as missing once.
  EXPECT_EQ(receiver_->accounts().slices(), sender_->slices_sent());
  EXPECT_EQ(receiver_->clouds(), receiver_->accounts().received);
  EXPECT_EQ(receiver_->foreign(), 0U);
}

TEST_F(Faults, AReceiverThatMovesIsReachedAtItsNewAddress) {
  StartReceiver();
  // The sender sends directly to the receiver, without a link between them.
  sender_.emplace(&sent_, port_);
  sender_->pipeline().SetState(GST_STATE_PLAYING);
  ASSERT_NE(receiver_->NextCloud(seconds(10)), milliseconds::max());
  receiver_.reset();
  port_ = FreePort();
  StartReceiver();
  sender_->pipeline().SetState(GST_STATE_NULL);
  g_object_set(sender_->pipeline().Child("net").get(), "port", guint{port_}, nullptr);
  sender_->pipeline().SetState(GST_STATE_PLAYING);
  ExpectRecovery("receiver moves, sender is told", seconds(3));
  std::this_thread::sleep_for(milliseconds(500));
  EXPECT_EQ(receiver_->foreign(), 0U);
  EXPECT_EQ(receiver_->accounts().lost, 0U);
  EXPECT_EQ(sender_->pipeline().Error() + receiver_->pipeline().Error(), "");
}

TEST_F(Faults, AReceiverBehindANewRouteNeedsNothingFromTheSender) {
  Start();
  receiver_.reset();
  port_ = FreePort();
  StartReceiver();
  link_.MoveReceiver(port_);
  ExpectRecovery("receiver moves, the network follows", seconds(3));
  const auto before = sender_->pipeline().Stat("net", "feedback-accepted");
  std::this_thread::sleep_for(seconds(1));
  EXPECT_GT(sender_->pipeline().Stat("net", "feedback-accepted"), before);
  EXPECT_EQ(receiver_->foreign(), 0U);
}

TEST_F(Faults, ASecondPairInTheSameProcessDisturbsNothing) {
  Start();
  const std::uint16_t port = FreePort();
  FaultLink link(port, 2);
  SentSlices sent;
  ReceivingEnd receiver(&sent, port);
  SendingEnd sender(&sent, link.port());
  receiver.pipeline().SetState(GST_STATE_PLAYING);
  sender.pipeline().SetState(GST_STATE_PLAYING);
  EXPECT_NE(receiver.NextCloud(seconds(5)), milliseconds::max());
  std::this_thread::sleep_for(seconds(1));
  EXPECT_EQ(receiver.foreign(), 0U);
  sender.pipeline().SetState(GST_STATE_NULL);
  receiver.pipeline().SetState(GST_STATE_NULL);
  ExpectBooksAgree();
}

TEST_F(Faults, AStarvedSenderRecovers) {
  Start();
  std::vector<pid_t> hogs;
  const long cores = sysconf(_SC_NPROCESSORS_ONLN);
  for (long i = 0; i < 4 * cores; ++i) {
    const pid_t child = fork();
    if (child == 0)
      for (volatile unsigned n = 0;; n = n + 1) continue;
    hogs.push_back(child);
  }
  std::this_thread::sleep_for(seconds(5));
  for (const pid_t hog : hogs) {
    kill(hog, SIGKILL);
    waitpid(hog, nullptr, 0);
  }
  ExpectRecovery("CPU starved to a fifth for 5 s", seconds(3));
  ExpectBooksAgree(false);
}

/// Changes the pipeline from NULL to PLAYING and back a thousand times. Expects that this does not
/// increase the allocated memory.
void ExpectCyclesToLeaveNothing(Pipeline& pipeline) {
  std::uint64_t base = 0;
  for (int i = 0; i < 1'000; ++i) {
    pipeline.SetState(GST_STATE_PLAYING);
    pipeline.SetState(GST_STATE_NULL);
    if (i == 100) base = AllocatedBytes();
  }
  EXPECT_LT(AllocatedBytes(), base + (20U << 20));
  pipeline.SetState(GST_STATE_PLAYING);
}

TEST_F(Faults, AThousandCyclesOfTheSenderLeaveNothingBehind) {
  StartReceiver();
  sender_.emplace(&sent_, link_.port());
  ExpectCyclesToLeaveNothing(sender_->pipeline());
  ExpectRecovery("1000 state cycles of the sender", seconds(5));
}

TEST_F(Faults, AThousandCyclesOfTheReceiverLeaveNothingBehind) {
  Start();
  ExpectCyclesToLeaveNothing(receiver_->pipeline());
  ExpectRecovery("1000 state cycles of the receiver", seconds(5));
  EXPECT_EQ(receiver_->foreign(), 0U);
  EXPECT_EQ(sender_->pipeline().Error() + receiver_->pipeline().Error(), "");
}

TEST(FaultsOfFiles, AFullDiskIsAnErrorThatSaysSo) {
  Pipeline pipeline(
      "lidartestsrc num-buffers=80 model=os0-32 mode=512x10 ! dracoenc ! filesink "
      "location=/dev/full");
  pipeline.SetState(GST_STATE_PLAYING);
  std::string error;
  for (int i = 0; i < 100 && error.empty(); ++i) {
    std::this_thread::sleep_for(milliseconds(50));
    error = pipeline.Error();
  }
  EXPECT_NE(error.find("No space left"), std::string::npos) << error;
}

}  // namespace
}  // namespace lidar::test
