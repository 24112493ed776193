// SPDX-License-Identifier: LGPL-2.1-or-later
// Compares the writes and the held leases of a lease table in a scripted run with a golden file.
#include <chrono>
#include <optional>
#include <set>
#include <string>

#include "src/tools/apps/worker/lease_table.h"
#include "tests/core/tools/scan_progress.h"
#include "tests/support/golden_lines.h"

namespace lidar::worker {
namespace {

/// A lease table for up to two robots, a store that answers at once or not at all, and a clock.
class LeaseScript {
 public:
  Time now() const { return now_; }
  LeaseTable* table() { return &table_; }
  void Say(const std::string& what) { lines_.push_back("- " + what); }
  void SetAnswering(bool on) { answering_ = on; }
  void Robots(const std::set<std::string>& robots) {
    std::string all;
    for (const std::string& robot : robots) all += " " + robot;
    Say("robots" + all);
    table_.SetRobots(robots, now_);
  }
  void Entry(const std::string& robot, const std::optional<LeaseRecord>& record) {
    Say("entry of " + robot + (record ? " by " + record->worker : ", damaged"));
    table_.OnEntry(robot, ++revision_, record, now_);
  }
  /// Makes the store refuse the next write. The answer names `newest` as the newest revision, if it
  /// has a value.
  void RefuseOnce(std::optional<std::uint64_t> newest) {
    refuses_ = true;
    newest_ = newest;
  }
  void Pass(int ms) {
    for (; ms > 0; ms -= kStep) {
      now_ += std::chrono::milliseconds(kStep);
      Take(table_.Poll(now_));
      NoteHeld();
      if (table_.MissesEntries(now_)) Note("misses entries");
    }
  }
  void HandOver() {
    Say("hand over");
    Take(table_.HandOver(now_));
    NoteHeld();
  }
  const test::Lines& lines() const { return lines_; }

 private:
  static constexpr int kStep = 5;
  static long long Ms(Time time) {
    return std::chrono::duration_cast<std::chrono::milliseconds>(time.time_since_epoch()).count();
  }
  void Note(const std::string& what) { lines_.push_back(test::Line(Ms(now_), ": ", what)); }
  void Take(const std::vector<LeaseTable::Write>& writes) {
    for (const LeaseTable::Write& write : writes) {
      Note(test::Line("writes ", write.robot, " for ", write.replaces, " as ", write.text));
      if (!answering_) continue;
      if (std::exchange(refuses_, false))
        table_.OnRefused(write.ticket, newest_, now_);
      else
        table_.OnStored(write.ticket, ++revision_, now_);
    }
  }
  /// Notes the held leases if they changed. Renewed leases are no change.
  void NoteHeld() {
    std::string held;
    for (const auto& [name, lease] : table_.HeldAt(now_))
      held += test::Line(" ", name, " after '", lease.last_worker, "' from ",
                         lease.progress ? lease.progress->scan : 0);
    if (std::exchange(held_, held) != held)
      Note("holds" + held + ", unanswered " + std::to_string(table_.unanswered()));
  }

  LeaseTable table_{{"me", std::chrono::seconds(1), 2}};
  Time now_{};
  std::uint64_t revision_ = 0;
  bool answering_ = true;
  bool refuses_ = false;
  std::optional<std::uint64_t> newest_;
  std::string held_;
  test::Lines lines_;
};

TEST(LeaseCourse, IsAsItWas) {
  using std::chrono::milliseconds;
  LeaseScript s;
  s.Robots({"a"});
  s.Pass(600);
  s.Say("progress");
  s.table()->SetProgress("a", Scan(3));
  s.Pass(300);
  s.Say("a store without answers");
  s.SetAnswering(false);
  s.Pass(1'600);
  s.Say("which answers again");
  s.SetAnswering(true);
  s.Pass(700);
  s.Robots({"a", "b"});
  s.Entry("b", LeaseRecord{"", milliseconds(1'000), Scan(5)});
  s.Pass(400);
  s.Robots({"a", "b", "c"});
  s.Entry("c", std::nullopt);
  s.Pass(1'300);
  s.Say("b is dropped");
  s.table()->Drop("b", milliseconds(5'000), s.now());
  s.Pass(600);
  s.Say("a refusal");
  s.RefuseOnce(90);
  s.Pass(1'300);
  s.Say("a new bucket");
  s.RefuseOnce(0);
  s.Pass(1'300);
  s.Entry("c", LeaseRecord{"other", milliseconds(500), Scan(6)});
  s.Pass(900);
  s.Say("a is left to others");
  s.table()->LeaveToOthers("a", {}, s.now());
  s.Pass(2'500);
  s.Robots({"c"});
  s.Pass(100);
  s.HandOver();
  s.Pass(500);
  test::ExpectGoldenLines(s.lines(), std::string(GOLDEN_FOLDER) + "/leases.txt");
}

}  // namespace
}  // namespace lidar::worker
