// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/apps/worker/lease_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <memory>
#include <random>

#include "tests/core/tools/scan_progress.h"

namespace lidar::worker {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

Time At(int ms) { return Time{} + milliseconds(ms); }

/// A lease table and a store that answers at once.
class Lease : public ::testing::Test {
 protected:
  void Answer(const std::vector<LeaseTable::Write>& writes, Time now) {
    for (const auto& write : writes) {
      written_ = write;
      ++revision_;
      table_.OnStored(write.ticket, revision_, now);
    }
  }
  bool Has(const std::string& robot, Time now) const { return table_.HeldAt(now).count(robot) > 0; }
  /// Lets `ms` milliseconds pass, one after the other. Returns the time at the end.
  Time Pass(Time now, int ms) {
    for (; ms > 0; --ms) {
      now += milliseconds(1);
      Answer(table_.Poll(now), now);
    }
    return now;
  }

  LeaseTable table_{{"me", seconds(1), 4}};
  std::uint64_t revision_ = 0;
  LeaseTable::Write written_{};
};

TEST_F(Lease, OfARobotThatNobodyHasIsTakenAndRenewed) {
  table_.SetRobots({"r"}, At(0));
  Time now = Pass(At(0), 400);
  ASSERT_TRUE(Has("r", now));
  table_.SetProgress("r", Scan(7));
  now = Pass(now, 5000);
  EXPECT_TRUE(Has("r", now));
  EXPECT_EQ(written_.replaces + 1, revision_);
  EXPECT_EQ(ParseLeaseRecord(written_.text)->progress->scan, 7U);
  EXPECT_LT(revision_, 25U);
}

TEST_F(Lease, IsOverWhereRenewalsHaveNoAnswer) {
  table_.SetRobots({"r"}, At(0));
  const Time now = Pass(At(0), 400);
  ASSERT_TRUE(Has("r", now));
  for (int ms = 1; ms < 1100; ++ms) table_.Poll(now + milliseconds(ms));
  EXPECT_FALSE(Has("r", now + milliseconds(1100)));
  EXPECT_FALSE(Has("r", now + seconds(9))) << "though nobody looked meanwhile";
}

TEST_F(Lease, CountsFromWhenItWasAskedFor) {
  table_.SetRobots({"r"}, At(0));
  std::vector<LeaseTable::Write> writes;
  int ms = 0;
  while (writes.empty() && ms < 1'000) writes = table_.Poll(At(++ms));
  Answer(writes, At(ms + 400));
  EXPECT_TRUE(Has("r", At(ms + 999)));
  EXPECT_FALSE(Has("r", At(ms + 1'001))) << "others take it then";
}

TEST_F(Lease, OfADeadWorkerIsTakenWithItsProgressOnceItIsOver) {
  table_.SetRobots({"r"}, At(0));
  table_.OnEntry("r", 5, LeaseRecord{"other", seconds(1), Scan(3)}, At(0));
  table_.OnEntry("r", 6, LeaseRecord{"other", seconds(1), Scan(4)}, At(900));
  revision_ = 6;
  Time now = Pass(At(900), 1000);
  EXPECT_FALSE(Has("r", now));
  now = Pass(now, 100);
  ASSERT_TRUE(Has("r", now));
  EXPECT_EQ(written_.replaces, 6U);
  EXPECT_EQ(table_.HeldAt(now).at("r").progress->scan, 4U);
  EXPECT_EQ(table_.HeldAt(now).at("r").last_worker, "other");
}

TEST_F(Lease, ThatIsHandedOverIsTakenAtOnce) {
  table_.SetRobots({"r"}, At(0));
  table_.OnEntry("r", 5, LeaseRecord{"other", seconds(1), Scan(3)}, At(500));
  table_.OnEntry("r", 6, LeaseRecord{"", seconds(1), Scan(4)}, At(600));
  revision_ = 6;
  EXPECT_TRUE(Has("r", Pass(At(600), 2)));
}

TEST_F(Lease, IsHandedOverWithWhatIsKnown) {
  table_.SetRobots({"a", "b"}, At(0));
  const Time now = Pass(At(0), 900);
  table_.SetProgress("a", Scan(9));
  const auto writes = table_.HandOver(now);
  ASSERT_EQ(writes.size(), 2U);
  EXPECT_EQ(ParseLeaseRecord(writes[0].text)->worker, "");
  EXPECT_EQ(ParseLeaseRecord(writes[0].text)->progress->scan, 9U);
  EXPECT_EQ(table_.unanswered(), 2U);
  Answer(writes, now);
  EXPECT_EQ(table_.unanswered(), 0U);
  EXPECT_TRUE(table_.HeldAt(Pass(now, 2000)).empty());
}

TEST_F(Lease, OfARobotWithMadeUpSensorsLeavesPlacesToOthers) {
  std::set<std::string> robots;
  for (int i = 0; i < 40; ++i) robots.insert("r7.s" + std::to_string(i));
  table_.SetRobots(robots, At(0));
  Time now = Pass(At(0), 3'000);
  EXPECT_EQ(table_.HeldAt(now).size(), 4U);
  robots.insert({"r8.front", "r9.front"});
  table_.SetRobots(robots, now);
  now = Pass(now, 3'000);
  EXPECT_TRUE(Has("r8.front", now));
  EXPECT_TRUE(Has("r9.front", now));
  const auto before = table_.HeldAt(now);
  EXPECT_EQ(before.size(), 4U);
  now = Pass(now, 10'000);
  for (const auto& [name, held] : table_.HeldAt(now)) EXPECT_EQ(before.count(name), 1U) << name;
}

TEST_F(Lease, OfOneOfTwoSensorsEndsWhereARobotHasNoPlace) {
  table_.SetRobots({"a.1", "a.2", "b.1", "b.2"}, At(0));
  Time now = Pass(At(0), 3'000);
  EXPECT_EQ(table_.HeldAt(now).size(), 4U);
  table_.SetRobots({"a.1", "a.2", "b.1", "b.2", "c.1"}, now);
  now = Pass(now, 3'000);
  EXPECT_TRUE(Has("c.1", now));
  EXPECT_EQ(table_.HeldAt(now).size(), 4U);
}

TEST_F(Lease, StaysWhereRobotsCannotAllHaveAsManyPlaces) {
  table_.SetRobots({"a.1", "a.2", "a.3", "b.1", "b.2", "b.3", "c.1", "c.2", "c.3"}, At(0));
  Time now = Pass(At(0), 3'000);
  const auto before = table_.HeldAt(now);
  EXPECT_EQ(before.size(), 4U);
  now = Pass(now, 5'000);
  for (const auto& [name, held] : table_.HeldAt(now)) EXPECT_EQ(before.count(name), 1U) << name;
}

TEST_F(Lease, OfASensorWithoutProgressEndsWhereAnotherWaits) {
  table_.SetRobots({"a", "b", "c", "d"}, At(0));
  Time now = Pass(At(0), 3'000);
  const auto work = [&](int ms) {
    for (std::uint64_t scan = 1; ms > 0; ms -= 100) {
      for (const char* live : {"a", "b", "c"}) table_.SetProgress(live, Scan(++scan));
      now = Pass(now, 100);
    }
  };
  work(60'000);
  EXPECT_TRUE(Has("d", now)) << "nobody waits";
  table_.SetRobots({"a", "b", "c", "d", "e"}, now);
  work(5'000);
  for (const char* robot : {"a", "b", "c", "e"}) EXPECT_TRUE(Has(robot, now)) << robot;
}

TEST_F(Lease, OfASensorWithoutProgressEndsThoughAnotherRobotHasMorePlaces) {
  table_.SetRobots({"a.1", "a.2", "b.1", "c.1"}, At(0));
  Time now = Pass(At(0), 3'000);
  const auto work = [&](int ms) {
    for (std::uint64_t scan = 1; ms > 0 && !Has("b.2", now); ms -= 100) {
      for (const char* live : {"a.1", "a.2", "b.1"}) table_.SetProgress(live, Scan(++scan));
      now = Pass(now, 100);
    }
  };
  work(60'000);
  table_.SetRobots({"a.1", "a.2", "b.1", "b.2", "c.1"}, now);
  work(5'000);
  EXPECT_FALSE(Has("c.1", now));
  for (const char* sensor : {"a.1", "a.2", "b.1", "b.2"}) EXPECT_TRUE(Has(sensor, now)) << sensor;
}

TEST_F(Lease, IsLostToWhoeverWritesInItsPlace) {
  table_.SetRobots({"r"}, At(0));
  const Time now = Pass(At(0), 400);
  ASSERT_TRUE(Has("r", now));
  table_.OnEntry("r", revision_ + 1, LeaseRecord{"other", seconds(1), std::nullopt}, now);
  EXPECT_FALSE(Has("r", now));
}

TEST_F(Lease, KeepsANewerPoseThanThatOfItsOwnEntry) {
  table_.SetRobots({"r"}, At(0));
  Time now = Pass(At(0), 400);
  table_.SetProgress("r", Scan(5));
  std::vector<LeaseTable::Write> writes;
  for (int ms = 0; writes.empty() && ms < 1'000; ++ms) writes = table_.Poll(now += milliseconds(1));
  ASSERT_EQ(writes.size(), 1U);
  table_.SetProgress("r", Scan(6));
  // The store sends the new entry to its watchers before it answers the write.
  table_.OnEntry("r", revision_ + 1, ParseLeaseRecord(writes[0].text), now);
  EXPECT_EQ(table_.HeldAt(now).at("r").progress->scan, 6U);
  Answer(writes, now);
  EXPECT_EQ(table_.HeldAt(now).at("r").progress->scan, 6U);
  EXPECT_EQ(ParseLeaseRecord(table_.HandOver(now).at(0).text)->progress->scan, 6U);
}

TEST_F(Lease, OfWhichTheRecordIsDamagedIsTakenWithoutAPose) {
  table_.SetRobots({"r"}, At(0));
  table_.OnEntry("r", 5, std::nullopt, At(0));
  revision_ = 5;
  EXPECT_FALSE(Has("r", Pass(At(0), 900)));
  const Time now = Pass(At(900), 500);
  ASSERT_TRUE(Has("r", now));
  EXPECT_FALSE(table_.HeldAt(now).at("r").progress);
}

TEST_F(Lease, BeginsAnewInABucketThatWasDeleted) {
  table_.SetRobots({"r"}, At(0));
  Time now = Pass(At(0), 400);
  for (int tries = 0; tries < 6; ++tries) {
    for (const auto& write : table_.Poll(now)) {
      if (write.replaces > 0)
        table_.OnRefused(write.ticket, 0, now);
      else
        table_.OnStored(write.ticket, revision_ = 1, now);
    }
    now += milliseconds(300);
  }
  EXPECT_TRUE(Has("r", now));
}

class LeaseOfAnother : public Lease, public ::testing::WithParamInterface<int> {};
INSTANTIATE_TEST_SUITE_P(OfMilliseconds, LeaseOfAnother, ::testing::Values(200, 1000, 3000));
TEST_P(LeaseOfAnother, InABucketThatWasDeletedIsTakenOnceItIsOver) {
  table_.SetRobots({"r"}, At(0));
  table_.OnEntry("r", 5, LeaseRecord{"other", milliseconds(GetParam()), Scan(3)}, At(0));
  const auto writes = table_.Poll(At(3200));
  ASSERT_EQ(writes.size(), 1U);
  // The other worker may have renewed its lease just before, without being noticed here.
  table_.OnRefused(writes[0].ticket, 0, At(3210));
  const int longest_ms = std::max(GetParam(), 1000);
  Time now = Pass(At(3210), longest_ms);
  EXPECT_FALSE(Has("r", now));
  now = Pass(now, longest_ms / 10);
  ASSERT_TRUE(Has("r", now));
  EXPECT_EQ(table_.HeldAt(now).at("r").progress->scan, 3U);
}

TEST_F(Lease, OfAnotherIsRememberedThoughTheRobotIsAwayForAMoment) {
  table_.SetRobots({"r"}, At(0));
  table_.OnEntry("r", 5, LeaseRecord{"other", seconds(1), Scan(3)}, At(0));
  revision_ = 5;
  table_.SetRobots({}, At(10));
  table_.SetRobots({"r"}, At(20));
  EXPECT_FALSE(Has("r", Pass(At(20), 950)));
  const Time now = Pass(At(970), 130);
  ASSERT_TRUE(Has("r", now));
  EXPECT_EQ(written_.replaces, 5U);
  EXPECT_EQ(table_.HeldAt(now).at("r").progress->scan, 3U);
}

TEST_F(Lease, GoesOnFromAStoreThatForgotItsNewestEntries) {
  table_.SetRobots({"r"}, At(0));
  table_.OnEntry("r", 90, LeaseRecord{"other", seconds(1), Scan(9)}, At(0));
  const Time now = At(1100);
  const auto writes = table_.Poll(now);
  ASSERT_EQ(writes.size(), 1U);
  EXPECT_FALSE(table_.MissesEntries(now));
  table_.OnRefused(writes[0].ticket, 70, now);
  EXPECT_TRUE(table_.MissesEntries(now + milliseconds(600)));
  table_.OnEntry("r", 70, LeaseRecord{"other", seconds(1), Scan(7)}, now + milliseconds(650));
  EXPECT_FALSE(table_.MissesEntries(now + seconds(2)));
  revision_ = 90;
  const Time later = Pass(now + milliseconds(650), 1200);
  ASSERT_TRUE(Has("r", later));
  EXPECT_EQ(written_.replaces, 70U);
  EXPECT_EQ(table_.HeldAt(later).at("r").progress->scan, 7U);
}

TEST_F(Lease, MissesAnEntryFromTheFirstRefusalOnAndSaysSoTwiceInTheTimeOfALease) {
  table_.SetRobots({"r"}, At(0));
  table_.OnEntry("r", 90, LeaseRecord{"other", seconds(1), Scan(9)}, At(0));
  const auto refuse = [&](int ms) {
    const auto writes = table_.Poll(At(ms));
    ASSERT_EQ(writes.size(), 1U) << ms;
    table_.OnRefused(writes[0].ticket, 91, At(ms));
  };
  refuse(2'000);
  refuse(2'300);
  for (const int ms : {2'499, 2'500, 2'501, 2'999, 3'000, 3'001, 3'499, 3'500})
    EXPECT_EQ(table_.MissesEntries(At(ms)), ms % 500 == 0) << ms;
}

TEST_F(Lease, OfARobotThatFailsHereIsLeftToOthers) {
  table_.SetRobots({"r"}, At(0));
  Time now = Pass(At(0), 400);
  table_.Poll(now + milliseconds(300));  // The answer to this write comes too late.
  table_.LeaveToOthers("r", seconds(5), now);
  table_.OnStored(2, 99, now);
  EXPECT_FALSE(Has("r", Pass(now, 4900)));
  EXPECT_TRUE(Has("r", Pass(now + milliseconds(4900), 200)));
}

TEST_F(Lease, OfARobotThatHangsHereGoesToAnotherWorkerThoughItHesitates) {
  table_.SetRobots({"r"}, At(0));
  Time now = Pass(At(0), 400);
  ASSERT_TRUE(Has("r", now));
  LeaseTable other({"other", seconds(1), 4});
  other.SetRobots({"a", "b", "c"}, At(0));
  for (std::uint64_t ms = 0; ms < 1'000; ++ms)  // holds all but one of the robots that it can
    for (const auto& write : other.Poll(now + milliseconds(ms)))
      other.OnStored(write.ticket, 1'000 + ms, now + milliseconds(ms));
  now = Pass(now, 1'000);
  other.SetRobots({"a", "b", "c", "r"}, now);
  table_.LeaveToOthers("r", Duration{}, now);
  // The other worker gets our last write late.
  now += milliseconds(100);
  other.OnEntry("r", revision_, ParseLeaseRecord(written_.text), now);
  std::string next;
  for (; next.empty() && now < At(9'000); now += milliseconds(1)) {
    for (const auto& write : other.Poll(now)) {
      if (write.robot == "r") next = "other";
      other.OnStored(write.ticket, write.replaces + 1'000, now);
    }
    if (!table_.Poll(now).empty() && next.empty()) next = "me";
  }
  EXPECT_EQ(next, "other");
}

TEST_F(Lease, OfARobotThatIsGoneEnds) {
  table_.SetRobots({"a", "b"}, At(0));
  const Time now = Pass(At(0), 900);
  table_.SetRobots({"b"}, now);
  EXPECT_FALSE(Has("a", now));
  EXPECT_TRUE(Has("b", Pass(now, 3000)));
}

TEST_F(Lease, IsNotTakenBeyondTheLimit) {
  table_.SetRobots({"a", "b", "c", "d", "e", "f"}, At(0));
  EXPECT_EQ(table_.HeldAt(Pass(At(0), 5000)).size(), 4U);
}

/// A store and several workers. Messages of the workers are late or lost, their clocks differ, and
/// workers sleep or die.
class Fleet {
 public:
  Fleet(unsigned seed, std::size_t workers, bool rough) : random_(seed), rough_(rough) {
    for (int i = 0; i < 6; ++i) robots_.insert("r" + std::to_string(i));
    for (std::size_t i = 0; i < workers; ++i) Join();
  }

  void Join() {
    const std::string name = "w" + std::to_string(workers_.size());
    auto worker = std::make_unique<Node>(LeaseSettings{name, seconds(1), 6});
    worker->offset = milliseconds(Pick(0, 1'000'000));
    worker->rate = 1 + 0.001 * Pick(-10, 10);
    for (const auto& [robot, entry] : store_) Announce(worker.get(), robot, entry);
    workers_.push_back(std::move(worker));
  }
  void Kill(std::size_t i) { workers_[i]->dead = true; }
  void SetRough(bool rough) { rough_ = rough; }

  void Run(int ms) {
    for (const int end = now_ms_ + ms; now_ms_ < end; now_ms_ += kStepMs) {
      for (auto& worker : workers_) Step(worker.get());
      for (const std::string& robot : robots_) ASSERT_LE(Owners(robot), 1) << robot << now_ms_;
    }
  }
  int Owners(const std::string& robot) const {
    return static_cast<int>(std::count_if(workers_.begin(), workers_.end(), [&](const auto& w) {
      return !w->dead && w->table.HeldAt(w->Local(now_ms_)).count(robot) > 0;
    }));
  }
  bool AllHaveAnOwner() const {
    return std::all_of(robots_.begin(), robots_.end(),
                       [&](const std::string& robot) { return Owners(robot) == 1; });
  }
  std::size_t Owned(std::size_t i) const {
    return workers_[i]->table.HeldAt(workers_[i]->Local(now_ms_)).size();
  }

 private:
  static constexpr int kStepMs = 5;
  struct Entry {
    std::uint64_t revision = 0;
    std::string text;
  };
  struct Node {
    explicit Node(const LeaseSettings& settings) : table(settings) {}
    Time Local(int ms) const { return Time{} + offset + FromSeconds(rate * ms / 1000); }

    LeaseTable table;
    Duration offset{};
    double rate = 1;
    bool dead = false;
    int asleep_until = 0;
    bool knows_robots = false;
    // The entries are in order, as a consumer receives them.
    std::deque<std::pair<int, std::function<void()>>> entries;
    std::multimap<int, std::function<void()>> answers;
  };

  int Pick(int least, int most) { return std::uniform_int_distribution<int>(least, most)(random_); }
  int Delay() { return rough_ && Pick(0, 99) < 5 ? Pick(100, 1500) : Pick(1, 20); }
  bool Lost() { return rough_ && Pick(0, 99) < 3; }

  void Announce(Node* to, const std::string& robot, const Entry& entry) {
    const int last = to->entries.empty() ? 0 : to->entries.back().first;
    to->entries.emplace_back(std::max(last, now_ms_ + Delay()), [=] {
      to->table.OnEntry(robot, entry.revision, ParseLeaseRecord(entry.text), to->Local(now_ms_));
    });
  }
  void Store(Node* from, const LeaseTable::Write& write) {
    Entry& entry = store_[write.robot];
    const bool good = entry.revision == write.replaces;
    const std::uint64_t newest = entry.revision;
    if (good) {
      const auto before = ParseLeaseRecord(entry.text);
      const auto after = ParseLeaseRecord(write.text);
      ASSERT_TRUE(before && after);
      if (before->progress) {
        ASSERT_TRUE(after->progress) << "a pose was forgotten";
        ASSERT_GE(after->progress->scan, before->progress->scan);
      }
      entry = {++revision_, write.text};
      for (auto& worker : workers_) Announce(worker.get(), write.robot, entry);
    }
    if (Lost()) return;
    from->answers.emplace(now_ms_ + Delay(), [=, revision = revision_, ticket = write.ticket] {
      if (good)
        from->table.OnStored(ticket, revision, from->Local(now_ms_));
      else
        from->table.OnRefused(ticket, newest, from->Local(now_ms_));
    });
  }
  void Step(Node* w) {
    for (; !on_their_way_.empty() && on_their_way_.begin()->first <= now_ms_;
         on_their_way_.erase(on_their_way_.begin()))
      on_their_way_.begin()->second();
    if (w->dead || now_ms_ < w->asleep_until) return;
    if (rough_ && Pick(0, 9'999) < 15) w->asleep_until = now_ms_ + Pick(100, 3000);
    const Time now = w->Local(now_ms_);
    if (!std::exchange(w->knows_robots, true)) w->table.SetRobots(robots_, now);
    for (; !w->entries.empty() && w->entries.front().first <= now_ms_; w->entries.pop_front())
      w->entries.front().second();
    for (; !w->answers.empty() && w->answers.begin()->first <= now_ms_;
         w->answers.erase(w->answers.begin()))
      w->answers.begin()->second();
    for (const auto& [robot, held] : w->table.HeldAt(now))
      w->table.SetProgress(robot, Scan((held.progress ? held.progress->scan : 0) + 1));
    for (const auto& write : w->table.Poll(now))
      if (!Lost()) on_their_way_.emplace(now_ms_ + Delay(), [=] { Store(w, write); });
  }

  std::mt19937 random_;
  bool rough_;
  int now_ms_ = 0;
  std::set<std::string> robots_;
  std::vector<std::unique_ptr<Node>> workers_;
  std::map<std::string, Entry> store_;
  std::uint64_t revision_ = 0;
  std::multimap<int, std::function<void()>> on_their_way_;
};

class LeaseFleet : public ::testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, LeaseFleet, ::testing::Range(1U, 7U));

TEST_P(LeaseFleet, NoRobotHasTwoWorkersWhateverHappens) {
  Fleet fleet(GetParam(), 3, true);
  fleet.Run(6'000);
  fleet.Kill(0);
  fleet.Run(6'000);
  fleet.Join();
  fleet.Run(6'000);
  fleet.SetRough(false);
  fleet.Run(6'000);
  EXPECT_TRUE(fleet.AllHaveAnOwner());
}

TEST_P(LeaseFleet, RobotsAreSharedRoughly) {
  Fleet fleet(GetParam(), 3, false);
  fleet.Run(3'000);
  EXPECT_TRUE(fleet.AllHaveAnOwner());
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LE(fleet.Owned(i), 4U);
}

TEST_P(LeaseFleet, OtherWorkersHaveTheRobotsOfADeadOneInASecondAndAHalf) {
  Fleet fleet(GetParam(), 3, false);
  fleet.Run(4'000);
  fleet.Kill(1);
  fleet.Run(1'500);
  EXPECT_TRUE(fleet.AllHaveAnOwner());
}

}  // namespace
}  // namespace lidar::worker
