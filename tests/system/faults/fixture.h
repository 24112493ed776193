// SPDX-License-Identifier: LGPL-2.1-or-later
// A test fixture with two ends and a link with faults between them.
#pragma once
#include <gtest/gtest.h>

#include <cstdio>
#include <optional>
#include <string>
#include <thread>

#include "tests/system/faults/ends.h"
#include "tests/system/faults/fault_link.h"

namespace lidar::test {

using std::chrono::milliseconds;
using std::chrono::seconds;

class Faults : public ::testing::Test {
 protected:
  Faults() : port_(FreePort()), link_(port_) {}

  void StartSender() {
    sender_.emplace(&sent_, link_.port(), options_);
    sender_->pipeline().SetState(GST_STATE_PLAYING);
  }
  void StartReceiver() {
    receiver_.emplace(&sent_, port_, options_);
    receiver_->pipeline().SetState(GST_STATE_PLAYING);
  }
  /// Starts both ends, and waits until clouds arrive.
  void Start() {
    StartReceiver();
    StartSender();
    ASSERT_NE(receiver_->NextCloud(seconds(10)), milliseconds::max());
    std::this_thread::sleep_for(milliseconds(500));
  }
  void Suffer(const Fault& fault, milliseconds length) {
    link_.Set(fault);
    std::this_thread::sleep_for(length);
    link_.Set({});
  }
  /// Expects a cloud within `limit`, and prints the time until it arrived.
  void ExpectRecovery(const char* what, milliseconds limit) {
    const auto time = receiver_->NextCloud(limit);
    EXPECT_LE(time, limit) << what;
    std::printf("recovery: %-44s %5lld ms\n", what, static_cast<long long>(time.count()));
  }
  /// Ends the sender with EOS, and compares the counts of both ends. The receiver must have got
  /// exactly the slices that passed the link. Together with the missing slices these are all slices
  /// that the payloader sent.
  ///
  /// The sender may leave out slices. A slice lists those of the 64 slices before it that were left
  /// out. If more slices may have been left out while no packet passed, the receiver counts them as
  /// lost. `sends_all` must be false in this case.
  void ExpectBooksAgree(bool sends_all = true) {
    std::this_thread::sleep_for(milliseconds(500));
    EXPECT_TRUE(sender_->pipeline().Finish(seconds(10)));
    std::this_thread::sleep_for(milliseconds(300));
    const std::uint64_t sent = sender_->slices_sent();
    receiver_->pipeline().SetState(GST_STATE_PAUSED);
    const Accounts a = receiver_->accounts();
    const LinkCounts link = link_.counts();
    EXPECT_EQ(a.received + a.mismatch, link.slices_whole);
    if (sends_all) {
      EXPECT_EQ(a.slices(), sent);
      EXPECT_EQ(a.lost + a.damaged, sent - link.slices_whole);
    } else {
      EXPECT_GE(a.slices(), sent);
      EXPECT_LE(a.slices() + a.skipped, sender_->slices_captured());
    }
    EXPECT_EQ(receiver_->foreign(), 0U);
    EXPECT_EQ(receiver_->clouds(), a.received);
    EXPECT_EQ(sender_->pipeline().Error() + receiver_->pipeline().Error(), "");
  }

  std::string options_;  // properties of screamsink and screamsrc
  std::uint16_t port_;
  SentSlices sent_;
  FaultLink link_;
  std::optional<ReceivingEnd> receiver_;
  std::optional<SendingEnd> sender_;
};

}  // namespace lidar::test
