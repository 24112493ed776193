// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests that the books of a fleet list losses by their cause, and that they also list the losses
// that no part counted.
#include "tests/elements/nats/fleet_books.h"

#include <gtest/gtest.h>

namespace lidar::test {
namespace {

constexpr double kReportAge = 1;

/// A robot sends one slice per second for a minute. Its edge is killed at 30.5 s, and the next edge
/// receives from 35 s on.
class FleetBooks : public ::testing::Test {
 protected:
  FleetBooks() {
    lives_ = {{0, 30.5}, {33, std::nullopt}};
    for (std::uint32_t i = 0; i < 60; ++i) sent_.push_back({i, 0, i + 0.1, i});
    Store(1, 0, 30);
    Store(2, 35, 60);
    sessions_ = {{0, 0, 30, 30, 0, 0, 0, 30}, {1, 35, 70, 25, 0, 0, 0, 25}};
  }
  void Store(std::uint64_t run, std::uint32_t from, std::uint32_t to) {
    for (std::uint32_t i = from; i < to; ++i) stored_.push_back({i, 0, i + 0.2, i, run, i - from});
  }
  /// Loses a slice before it reaches natssink. Therefore all later slices of the run get a lower
  /// number.
  void LoseOnPath(std::size_t at) {
    for (std::size_t i = at + 1; i < stored_.size(); ++i)
      if (stored_[i].run == stored_[at].run) --stored_[i].number;
    stored_.erase(stored_.begin() + static_cast<std::ptrdiff_t>(at));
  }
  void LoseInSink(std::size_t at) {
    stored_.erase(stored_.begin() + static_cast<std::ptrdiff_t>(at));
  }
  RobotBooks Make() const { return MakeBooks(sent_, stored_, sessions_, lives_, kReportAge); }

  std::vector<SentSlice> sent_;
  std::vector<StoredSlice> stored_;
  std::vector<SessionReport> sessions_;
  std::vector<EdgeLife> lives_;
};

TEST_F(FleetBooks, TellWhatWasSentWhileTheEdgeWasAway) {
  const RobotBooks books = Make();
  EXPECT_EQ(books.sent, 60U);
  EXPECT_EQ(books.stored, 55U);
  EXPECT_EQ(books.missing.at_kill, 1U);
  EXPECT_EQ(books.missing.away, 4U);
  EXPECT_EQ(books.missing.all(), 5U);
  EXPECT_TRUE(books.Balanced());
}

TEST_F(FleetBooks, TellThePathFromTheSink) {
  LoseOnPath(40);
  LoseInSink(45);
  sessions_[1].lost = 1;
  sessions_[1].dropped = 1;
  sessions_[1].acknowledged = 23;
  const RobotBooks books = Make();
  EXPECT_EQ(books.missing.on_path, 1U);
  EXPECT_EQ(books.missing.by_sink, 1U);
  EXPECT_EQ(books.missing.all(), 7U);
  EXPECT_TRUE(books.Balanced());
}

TEST_F(FleetBooks, NoticeWhatThePathLostAndNobodyCounted) {
  LoseOnPath(40);
  sessions_[1].acknowledged = 24;
  EXPECT_EQ(Make().missing.not_counted, 1U);
  EXPECT_FALSE(Make().Balanced());
}

TEST_F(FleetBooks, NoticeWhatTheSinkLostAndNobodyCounted) {
  LoseInSink(40);
  sessions_[1].acknowledged = 24;
  sessions_[1].lost = 1;  // rtplidardepay counts a loss, but natssink does not
  EXPECT_EQ(Make().missing.not_counted, 1U);
}

TEST_F(FleetBooks, NoticeWhatWasAcknowledgedAndIsGone) {
  LoseInSink(10);
  sessions_[0].dropped = 1;
  EXPECT_EQ(Make().acknowledged_and_gone, 1U);
}

TEST_F(FleetBooks, NoticeAnEndThatNobodyTellsOf) {
  stored_.pop_back();
  sessions_[1].acknowledged = 24;
  EXPECT_EQ(Make().missing.not_counted, 1U);
}

TEST_F(FleetBooks, NoticeWhatWaitedForLongerThanTheEdgeSaid) {
  stored_.erase(stored_.begin() + 20, stored_.begin() + 30);
  sessions_[0].acknowledged = 20;
  sessions_[0].waiting = 8;
  // Eleven slices are missing. Nine of them were sent early enough to be in the last report, but
  // the report counts only eight.
  const RobotBooks books = Make();
  EXPECT_EQ(books.missing.not_counted, 1U);
  EXPECT_EQ(books.missing.at_kill, 10U);
}

TEST_F(FleetBooks, NoticeBytesThatNobodySent) {
  stored_[3].hash = 77;
  EXPECT_EQ(Make().strange, 1U);
}

}  // namespace
}  // namespace lidar::test
