// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/bonding/shared_queues.h"

#include <gtest/gtest.h>

#include "src/link/random.h"
#include "src/sim/simulated_time.h"

namespace lidar::bonding {
namespace {

using namespace std::chrono_literals;

/// Two links whose packets pass through one or two FIFOs of 8 Mbit/s.
class TwoFifos : public testing::Test {
 protected:
  void Send(std::size_t link, std::size_t fifo, DataSize size) {
    queues_.OnSent(now_, link, size);
    Time& free = free_[fifo];
    if (gaps_ && random_.Chance(1.0 / 200)) free = std::max(free, now_) + 300ms;
    free = std::max(free, now_) + size / Mbps(8);
    const auto ticks = static_cast<std::uint32_t>(Seconds(free - kStart + behind_[link]) * 65536);
    queues_.OnArrival(link, {now_, ticks, 0ms});
    if (overtaken_) queues_.OnArrival(link, {now_ - 5ms, ticks, 0ms});
    changes_ += queues_.Shared(0, 1) != shared_ ? 1 : 0;
    shared_ = queues_.Shared(0, 1);
  }
  /// Sends bursts on both links. If `copies` is true, both links get each packet at the same time.
  /// Otherwise the second link gets `share` of the packets a bit later.
  void Run(std::size_t second_fifo, bool copies, double share = 0.4) {
    for (int i = 0; i < 4000; ++i) {
      now_ += i % 20 == 0 ? 40ms : FromSeconds(0.0005 + 0.001 * random_.Uniform());
      const auto size = DataSize::Bytes(random_.Chance(0.5) ? 1200 : 600);
      Send(0, 0, size);
      if (!copies) now_ += 10us;
      if (copies || random_.Chance(share)) Send(1, second_fifo, size);
    }
  }
  SharedQueues queues_;
  bool shared_ = false;
  int changes_ = 0;  // how often `shared_` changed
  Time now_ = kStart;
  std::array<Time, 2> free_{kStart, kStart};
  std::array<Duration, 2> behind_{};  // the delay of each link after its queue
  bool gaps_ = false;                 // The FIFOs stop from time to time.
  // Each packet arrives a second time, as if later packets had overtaken it.
  bool overtaken_ = false;
  link::Random random_{1};
};

TEST_F(TwoFifos, FindsOneQueue) {
  Run(0, false);
  EXPECT_TRUE(queues_.Shared(0, 1));
  EXPECT_TRUE(queues_.Shared(1, 0));
  EXPECT_FALSE(queues_.Shared(0, 2));
  EXPECT_EQ(changes_, 1);
  queues_.Forget(1);
  EXPECT_FALSE(queues_.Shared(0, 1));
}

TEST_F(TwoFifos, LeavesOutPacketsThatWereOvertaken) {
  overtaken_ = true;
  Run(0, false);
  EXPECT_TRUE(queues_.Shared(0, 1));
  EXPECT_EQ(changes_, 1);
}

TEST_F(TwoFifos, FindsOneQueueThatStandsStillNowAndThen) {
  gaps_ = true;
  Run(0, false);
  EXPECT_TRUE(queues_.Shared(0, 1));
}

TEST_F(TwoFifos, KnowsTheEmptyQueueOfTheWindowBeforeWhileOneStands) {
  while (now_ < kStart + 9950ms) {  // The queue stays empty.
    now_ += 50ms;
    for (const std::size_t link : {0U, 1U}) Send(link, 0, DataSize::Bytes(600));
  }
  // A burst fills the queue. The queue then stays full, also when the next window of ten seconds
  // begins.
  while (free_[0] - now_ < 200ms) Send(0, 0, DataSize::Bytes(1200));
  while (now_ < kStart + 14s) {
    now_ += FromSeconds(0.003 + 0.002 * random_.Uniform());
    while (free_[0] - now_ < 198ms)
      Send(random_.Chance(0.5) ? 1 : 0, 0, DataSize::Bytes(random_.Chance(0.5) ? 1200 : 600));
  }
  EXPECT_TRUE(queues_.Shared(0, 1));
}

TEST_F(TwoFifos, KeepsTwoQueuesApartThatCopiesFillAlike) {
  Run(1, true);
  EXPECT_FALSE(queues_.Shared(0, 1));
}

TEST_F(TwoFifos, TakesNoLittleLikenessForOneQueue) {
  for (int round = 0; round < 5; ++round) {
    now_ = std::max(free_[0], free_[1]) + 1s;  // Both queues are empty again.
    const Time end = now_ + 8s;
    // Both queues are 50 ms long. They contain packets of other flows between the packets of the
    // links.
    for (; now_ < end; now_ += FromSeconds(0.003 + 0.002 * random_.Uniform()))
      for (const std::size_t link : {0U, 1U})
        while (free_[link] - now_ < 50ms) {
          if (random_.Chance(0.5)) free_[link] = std::max(free_[link], now_) + 1200us;
          Send(link, link, DataSize::Bytes(random_.Chance(0.5) ? 1200 : 600));
        }
  }
  EXPECT_EQ(changes_, 0);
}

TEST_F(TwoFifos, LeavesAQueueThatIsNoLongerShared) {
  Run(0, false);
  ASSERT_TRUE(queues_.Shared(0, 1));
  Run(1, false);
  EXPECT_FALSE(queues_.Shared(0, 1));
}

TEST_F(TwoFifos, FindsOneQueueThoughThePathBehindItBecomesMuchLongerForOneLink) {
  Run(0, false);
  ASSERT_TRUE(queues_.Shared(0, 1));
  behind_[1] = 2s;
  Run(0, false);
  EXPECT_TRUE(queues_.Shared(0, 1));
}

TEST_F(TwoFifos, TakesNoOldSamplesForNewOnesWhereQueuesAreAlikeForAMoment) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    queues_ = {};
    shared_ = false;
    random_ = link::Random(seed);
    Run(0, false, 0.8);
    ASSERT_TRUE(queues_.Shared(0, 1)) << seed;
    Run(1, false, 0.8);
    EXPECT_FALSE(queues_.Shared(0, 1)) << seed;
  }
  EXPECT_LE(changes_, 40);  // Two changes per seed are needed.
}

}  // namespace
}  // namespace lidar::bonding
