// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/elements/nats/fleet_books.h"

#include <algorithm>
#include <cstdio>
#include <map>

namespace lidar::test {
namespace {

/// The slices that one natssink stored between its start and its stop. This is one session of the
/// edge.
struct Run {
  std::size_t life = 0;
  std::optional<SessionReport> report;
  std::uint64_t messages = 0;
  Missing missing;  // of this run, by the gaps in the slices' numbers
};

class Bookkeeper {
 public:
  Bookkeeper(const std::vector<SentSlice>& sent, const std::vector<StoredSlice>& stored,
             const std::vector<SessionReport>& sessions, const std::vector<EdgeLife>& lives,
             double report_age)
      : sent_(sent), lives_(lives), report_age_(report_age) {
    for (const StoredSlice& slice : stored) {
      ++runs_[slice.run].messages;
      if (runs_[slice.run].messages == 1) {
        order_.push_back(slice.run);
        runs_[slice.run].life = LifeAt(slice.at);
      }
      if (!stored_.emplace(slice.place(), slice).second) ++books_.twice;
    }
    for (const SessionReport& session : sessions) {
      books_.received += session.received;
      books_.acknowledged += session.acknowledged;
    }
    MatchReports(sessions);
    CheckAcknowledged(sessions);
  }

  RobotBooks Make() {
    CheckStored();
    FindGaps();
    for (auto& [id, run] : runs_) Settle(&run);
    books_.sent = sent_.size();
    return books_;
  }

 private:
  std::size_t LifeAt(double time) const {
    std::size_t life = 0;
    while (life + 1 < lives_.size() && lives_[life + 1].up <= time) ++life;
    return life;
  }

  /// Assigns reports to runs. A life is the time from a start of the edge to its end. In each life,
  /// the n-th run gets the report of the n-th session that received something.
  void MatchReports(const std::vector<SessionReport>& sessions) {
    std::map<std::size_t, std::vector<SessionReport>> of_life;
    for (const SessionReport& session : sessions)
      if (session.received > 0) of_life[session.life].push_back(session);
    std::map<std::size_t, std::size_t> used;
    for (const std::uint64_t id : order_) {
      const auto& list = of_life[runs_[id].life];
      const std::size_t next = used[runs_[id].life]++;
      if (next < list.size()) runs_[id].report = list[next];
    }
  }

  /// Counts, for each life of the edge, how many slices were acknowledged but are not in the
  /// stream.
  void CheckAcknowledged(const std::vector<SessionReport>& sessions) {
    std::vector<std::uint64_t> gone(lives_.size());
    for (const SessionReport& session : sessions) gone[session.life] += session.acknowledged;
    for (const auto& [id, run] : runs_) gone[run.life] -= std::min(gone[run.life], run.messages);
    for (const std::uint64_t count : gone) books_.acknowledged_and_gone += count;
  }

  void CheckStored() {
    std::map<std::tuple<std::uint32_t, std::uint32_t>, std::size_t> hashes;
    for (const SentSlice& slice : sent_) hashes[slice.place()] = slice.hash;
    for (const auto& [place, slice] : stored_) {
      const auto found = hashes.find(place);
      if (found != hashes.end() && found->second == slice.hash)
        ++books_.stored;
      else
        ++books_.strange;
    }
  }

  void FindGaps() {
    const StoredSlice* before = nullptr;
    std::vector<const SentSlice*> gap;
    for (const SentSlice& slice : sent_) {
      const auto found = stored_.find(slice.place());
      if (found == stored_.end()) {
        gap.push_back(&slice);
        continue;
      }
      if (!gap.empty()) BookGap(before, gap, &found->second);
      before = &found->second;
      gap.clear();
    }
    if (!gap.empty()) BookGap(before, gap, nullptr);
  }

  /// Finds which part lost the slices of `gap`. `after` is null if the gap is at the end of the
  /// stream.
  void BookGap(const StoredSlice* before, const std::vector<const SentSlice*>& gap,
               const StoredSlice* after) {
    Missing missing;
    if (after == nullptr)
      missing.not_counted = gap.size();  // no later slice shows who lost them
    else if (before != nullptr && before->run == after->run)
      BookWithin(*before, gap, *after, &missing);
    else
      BookBetween(before, gap, *after, &missing);
    books_.missing += missing;
    Tell(gap, missing);
  }

  /// Finds which part lost the slices of a gap within one session.
  void BookWithin(const StoredSlice& before, const std::vector<const SentSlice*>& gap,
                  const StoredSlice& after, Missing* missing) {
    Run& run = runs_[after.run];
    const double told_until = ToldUntil(run);
    for (const SentSlice* slice : gap)
      if (slice->at > told_until) ++missing->at_kill;
    const std::uint64_t left = gap.size() - missing->at_kill;
    const std::uint64_t pushed =
        after.number > before.number ? after.number - before.number - 1 : 0;
    missing->by_sink = std::min(left, pushed);
    missing->on_path = left - missing->by_sink;
    run.missing += *missing;
  }

  /// Finds which part lost the slices of a gap that ends with the first slice of a session.
  /// `before` is null if that is the first session of all.
  void BookBetween(const StoredSlice* before, const std::vector<const SentSlice*>& gap,
                   const StoredSlice& after, Missing* missing) {
    Run& run = runs_[after.run];
    const Run* last = before != nullptr ? &runs_[before->run] : nullptr;
    const double receiving =
        run.report ? run.report->receiving_from : std::numeric_limits<double>::infinity();
    const bool killed = last == nullptr || lives_[last->life].killed.has_value();
    const double end = last == nullptr ? 0 : lives_[last->life].killed.value_or(0);
    std::uint64_t old = 0;  // sent early enough to be in the last report before the kill
    for (const SentSlice* slice : gap) {
      if (killed && slice->at <= end) {
        ++missing->at_kill;
        if (slice->at <= ToldUntil(*last)) ++old;
      } else if (killed && slice->at <= receiving) {
        ++missing->away;
      }
    }
    const std::uint64_t told =
        last != nullptr && last->report ? last->report->waiting + last->report->lost : 0;
    const std::uint64_t nobody = old - std::min(old, told);
    missing->at_kill -= nobody;
    missing->not_counted = nobody;
    const std::uint64_t left = gap.size() - missing->all();
    Missing head;
    head.by_sink = std::min(left, after.number);
    head.on_path = left - head.by_sink;
    run.missing += head;
    *missing += head;
  }

  /// Returns the time until which the report of `run` covers all slices. Slices that were sent
  /// later may be lost without a report.
  double ToldUntil(const Run& run) const {
    if (!lives_[run.life].killed) return std::numeric_limits<double>::infinity();
    return run.report ? run.report->at - report_age_ : 0;
  }

  /// Counts a missing slice as not counted if the edge's own counts do not include it.
  void Settle(Run* run) {
    const SessionReport report = run->report.value_or(SessionReport());
    const bool killed = lives_[run->life].killed.has_value();
    const std::uint64_t sink = report.dropped + (killed ? report.waiting : 0);
    const std::uint64_t sink_more = run->missing.by_sink - std::min(run->missing.by_sink, sink);
    const std::uint64_t path_more =
        run->missing.on_path - std::min(run->missing.on_path, report.lost);
    books_.missing.by_sink -= sink_more;
    books_.missing.on_path -= path_more;
    books_.missing.not_counted += sink_more + path_more;
  }

  void Tell(const std::vector<const SentSlice*>& gap, const Missing& m) {
    char line[200];
    std::snprintf(
        line, sizeof line,
        "%zu slices, scan %u.%u to %u.%u: path %llu, natssink %llu, with the edge %llu, "
        "edge away %llu, nobody %llu",
        gap.size(), gap.front()->scan, gap.front()->index, gap.back()->scan, gap.back()->index,
        static_cast<unsigned long long>(m.on_path), static_cast<unsigned long long>(m.by_sink),
        static_cast<unsigned long long>(m.at_kill), static_cast<unsigned long long>(m.away),
        static_cast<unsigned long long>(m.not_counted));
    books_.gaps.emplace_back(line);
  }

  const std::vector<SentSlice>& sent_;
  const std::vector<EdgeLife>& lives_;
  const double report_age_;
  std::map<std::tuple<std::uint32_t, std::uint32_t>, StoredSlice> stored_;
  std::map<std::uint64_t, Run> runs_;
  // The runs, in the order in which their first slices were stored.
  std::vector<std::uint64_t> order_;
  RobotBooks books_;
};

}  // namespace

Missing& Missing::operator+=(const Missing& o) {
  on_path += o.on_path;
  by_sink += o.by_sink;
  at_kill += o.at_kill;
  away += o.away;
  not_counted += o.not_counted;
  return *this;
}

RobotBooks& RobotBooks::operator+=(const RobotBooks& o) {
  sent += o.sent;
  received += o.received;
  acknowledged += o.acknowledged;
  stored += o.stored;
  twice += o.twice;
  strange += o.strange;
  acknowledged_and_gone += o.acknowledged_and_gone;
  missing += o.missing;
  return *this;
}

RobotBooks MakeBooks(const std::vector<SentSlice>& sent, const std::vector<StoredSlice>& stored,
                     const std::vector<SessionReport>& sessions, const std::vector<EdgeLife>& lives,
                     double report_age) {
  return Bookkeeper(sent, stored, sessions, lives, report_age).Make();
}

std::string TitleOfBooks() {
  return "robot     sent received   acked  stored |    path natssink edge-had edge-away nobody | "
         "twice strange acked-and-gone";
}

std::string LineOfBooks(const std::string& robot, const RobotBooks& b) {
  const auto n = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
  char line[300];
  std::snprintf(line, sizeof line,
                "%-6s %7llu  %7llu %7llu %7llu | %7llu  %7llu  %7llu   %7llu %6llu | %5llu %7llu "
                "%14llu",
                robot.c_str(), n(b.sent), n(b.received), n(b.acknowledged), n(b.stored),
                n(b.missing.on_path), n(b.missing.by_sink), n(b.missing.at_kill), n(b.missing.away),
                n(b.missing.not_counted), n(b.twice), n(b.strange), n(b.acknowledged_and_gone));
  return line;
}

}  // namespace lidar::test
