// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/link/capacity.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace lidar::link {
namespace {

constexpr double kMaxTraceSeconds = 1e7;
constexpr double kBitsPerMegabit = 1e6;

std::string_view NextWord(std::string_view* line) {
  const auto first = line->find_first_not_of(" \t\r,");
  if (first == std::string_view::npos) return {};
  line->remove_prefix(first);
  const auto length = std::min(line->find_first_of(" \t\r,"), line->size());
  const auto word = line->substr(0, length);
  line->remove_prefix(length);
  return word;
}

std::optional<double> Number(std::string_view word) {
  double value = 0;
  const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (word.empty() || status != std::errc{} || end != word.data() + word.size()) return {};
  return value;
}

struct TraceLine {
  Duration at;
  DataRate rate;
};

/// Parses a line of a trace. Returns nothing for a line without content, and leaves `error` empty.
/// If the line is wrong, sets `error` and returns nothing.
std::optional<TraceLine> ParseLine(std::string_view line, std::string* error) {
  line = line.substr(0, line.find('#'));
  const auto first = NextWord(&line);
  if (first.empty()) return {};
  const auto time = Number(first);
  const auto mbps = Number(NextWord(&line));
  if (!time || !mbps || !NextWord(&line).empty()) {
    *error = "expected two numbers, \"time_s rate_mbps\"";
  } else if (!(*time >= 0 && *time <= kMaxTraceSeconds)) {
    *error = "time out of range";
  } else if (!(*mbps >= 0 && *mbps <= Capacity::kMaxMbps)) {
    *error = "rate out of range";
  } else {
    return TraceLine{FromSeconds(*time), DataRate::BitsPerSecond(*mbps * kBitsPerMegabit)};
  }
  return {};
}

}  // namespace

Capacity Capacity::Constant(DataRate rate) {
  Capacity c;
  c.changes_ = {{Duration{0}, rate}};
  return c;
}

Capacity Capacity::Steps(const std::vector<DataRate>& rates, Duration each, bool repeat) {
  Capacity c;
  for (const DataRate rate : rates)
    c.changes_.push_back({each * static_cast<std::int64_t>(c.changes_.size()), rate});
  if (c.changes_.empty()) c.changes_.push_back({Duration{0}, DataRate{}});
  if (repeat) c.RepeatEvery(each * static_cast<std::int64_t>(c.changes_.size()));
  return c;
}

std::optional<Capacity> Capacity::ParseTrace(std::string_view text, bool repeat,
                                             std::string* error) {
  Capacity c;
  std::string problem;
  for (std::size_t number = 1; !text.empty() && problem.empty(); ++number) {
    const auto length = std::min(text.find('\n'), text.size());
    const auto line = ParseLine(text.substr(0, length), &problem);
    text.remove_prefix(std::min(length + 1, text.size()));
    if (line && !c.changes_.empty() && line->at <= c.changes_.back().at) {
      problem = "times must rise";
    } else if (line && c.changes_.size() == kMaxChanges) {
      problem = "too many lines";
    } else if (line) {
      c.changes_.push_back({line->at, line->rate});
    }
    if (!problem.empty()) problem.insert(0, "line " + std::to_string(number) + ": ");
  }
  if (problem.empty() && c.changes_.empty()) problem = "no line with a rate";
  if (!problem.empty()) {
    if (error != nullptr) *error = problem;
    return {};
  }
  const std::size_t n = c.changes_.size();
  c.changes_.front().at = Duration{0};
  if (repeat && n > 1) {
    const Duration last = c.changes_[n - 1].at;
    c.RepeatEvery(last + (last - c.changes_[n - 2].at));
  }
  return c;
}

Capacity Capacity::StartingAt(Duration start) const {
  Capacity c;
  const Duration into = period_ > Duration{0} ? start % period_ : start;
  c.changes_.push_back({Duration{0}, ScheduledAt(into).rate});
  for (const Change& change : changes_)
    if (change.at > into) c.changes_.push_back({change.at - into, change.rate});
  if (period_ > Duration{0}) {
    for (const Change& change : changes_)
      if (change.at < into) c.changes_.push_back({change.at + period_ - into, change.rate});
    c.RepeatEvery(period_);
  }
  for (const Outage& outage : outages_)
    c.AddOutage(std::max(outage.from - start, Duration{0}), outage.until - start);
  return c;
}

Capacity& Capacity::AddOutage(Duration from, Duration until) {
  if (from < until) outages_.push_back({from, until});
  last_outage_ = std::max(last_outage_, until);
  return *this;
}

Capacity::Segment Capacity::ScheduledAt(Duration t) const {
  const Duration base = period_ > Duration{0} ? t - t % period_ : Duration{0};
  const auto next = std::upper_bound(changes_.begin(), changes_.end(), t - base,
                                     [](Duration a, const Change& b) { return a < b.at; });
  const DataRate rate = std::prev(next)->rate;
  if (next != changes_.end()) return {rate, base + next->at};
  return {rate, period_ > Duration{0} ? base + period_ : Duration::max()};
}

Capacity::Segment Capacity::SegmentAt(Duration t) const {
  t = std::max(t, Duration{0});
  Segment segment = ScheduledAt(t);
  for (const Outage& outage : outages_) {
    if (t >= outage.until) continue;
    if (t < outage.from) {
      segment.end = std::min(segment.end, outage.from);
    } else {
      segment = {DataRate{}, outage.until};
    }
  }
  return segment;
}

DataRate Capacity::RateAt(Duration t) const { return SegmentAt(t).rate; }

Duration Capacity::NextChange(Duration t) const { return SegmentAt(t).end; }

void Capacity::RepeatEvery(Duration period) {
  period_ = period;
  double bits = 0;
  for (std::size_t i = 0; i < changes_.size(); ++i) {
    const Duration end = i + 1 < changes_.size() ? changes_[i + 1].at : period;
    bits += changes_[i].rate.bits_per_second() * Seconds(end - changes_[i].at);
  }
  bits_per_period_ = bits;
}

Duration Capacity::Finish(Duration start, DataSize size) const {
  double bits = size.bits();
  Duration t = start;
  const bool never = period_ > Duration{0} && !(bits_per_period_ > 0);
  while (true) {
    if (bits > bits_per_period_ && bits_per_period_ > 0 && t >= last_outage_) {
      // Skips whole periods at once, because a tiny rate with a tiny period would otherwise take
      // for ever.
      const double periods = std::floor(bits / bits_per_period_);
      if (periods * Seconds(period_) > 9e9) return Duration::max();
      t += period_ * static_cast<std::int64_t>(periods);
      bits -= periods * bits_per_period_;
    }
    const Segment segment = SegmentAt(t);
    const double bps = segment.rate.bits_per_second();
    if (bps > 0) {
      const double needed = bits / bps;
      if (segment.end == Duration::max() || needed <= Seconds(segment.end - t))
        return needed < 9e9 ? t + FromSeconds(needed) : Duration::max();
      bits -= bps * Seconds(segment.end - t);
    } else if (segment.end == Duration::max() || never) {
      return Duration::max();
    }
    t = segment.end;
  }
}

DataSize Capacity::Between(Duration from, Duration until) const {
  double bits = 0;
  for (Duration t = from; t < until;) {
    const Segment segment = SegmentAt(t);
    const Duration end = std::min(segment.end, until);
    bits += segment.rate.bits_per_second() * Seconds(end - t);
    t = end;
  }
  return DataSize::Bytes(static_cast<std::int64_t>(bits / 8));
}

}  // namespace lidar::link
