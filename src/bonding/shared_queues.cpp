// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/bonding/shared_queues.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lidar::bonding {
namespace {

using namespace std::chrono_literals;

/// The number of packets that a regression remembers, and the least number that it needs.
constexpr double kMemory = 512;
constexpr double kFewest = 20;
/// A regression has no result if at most this fraction of the sum of squares of a term is
/// independent of the earlier terms.
constexpr double kNothing = 1e-6;
/// The least variance of the residuals [ms^2]. It is above 0 because arrival times are rounded to
/// 1/1024 s.
constexpr double kLeastVariance = 0.01;
/// Two links are found to share a queue when the combined significance of both directions exceeds
/// kFound. They no longer share it when the significance falls below kStillFound.
constexpr double kFound = 4;
constexpr double kStillFound = 1;
/// The queue did not run empty between two packets if its delay exceeded the time between them by
/// more than this.
constexpr double kMarginMs = 1;
/// Packets of two links that are sent within kTogether meet the same queue if the links share a
/// FIFO. The queues that the two links measure then differ by less than kAlike of the longer queue,
/// on average over kQueues packets. Links that already share a queue no longer share it if the
/// difference exceeds kStillAlike.
constexpr Duration kTogether = 10ms;
constexpr double kAlike = 0.35;
constexpr double kStillAlike = 0.5;
constexpr double kQueues = 16;
/// If two queues differ, the paths may have separated. Each packet that shows a difference
/// therefore takes this fraction of the weight of earlier samples. New samples may not replace
/// them, because an empty queue gives no samples.
constexpr double kFade = 1.0 / 32;
/// A longer time between arrivals is a gap of the link.
constexpr double kPauseMs = 60;
/// A larger change of a delay is due to another clock or path.
constexpr double kJumpMs = 1000;
/// The shortest delay in the current and the previous window counts as the delay of an empty queue.
constexpr Duration kBaseWindow = 10s;
constexpr std::size_t kMaxSent = 8192;

}  // namespace

void SharedQueues::Regression::Fade(double share) {
  count_ *= share;
  for (std::size_t i = 0; i < kTerms; ++i) {
    for (double& product : xx_[i]) product *= share;
    xy_[i] *= share;
  }
  yy_ *= share;
}

void SharedQueues::Regression::Add(const Terms& x, double y) {
  Fade(1 - 1 / kMemory);
  count_ += 1;
  for (std::size_t i = 0; i < kTerms; ++i) {
    for (std::size_t k = 0; k < kTerms; ++k) xx_[i][k] += x[i] * x[k];
    xy_[i] += x[i] * y;
  }
  yy_ += y * y;
}

/// Gaussian elimination leaves in the last row the part of the last term that the other terms do
/// not explain.
double SharedQueues::Regression::Significance() const {
  if (count_ < kFewest) return 0;
  auto xx = xx_;
  Terms xy = xy_;
  double rest = yy_;
  for (std::size_t i = 0; i < kTerms; ++i) {
    if (xx[i][i] <= kNothing * xx_[i][i]) return 0;
    rest -= xy[i] * xy[i] / xx[i][i];
    for (std::size_t row = i + 1; row < kTerms; ++row) {
      const double factor = xx[row][i] / xx[i][i];
      for (std::size_t k = i; k < kTerms; ++k) xx[row][k] -= factor * xx[i][k];
      xy[row] -= factor * xy[i];
    }
  }
  const double variance = std::max(rest / (count_ - static_cast<double>(kTerms)), kLeastVariance);
  return xy.back() / std::sqrt(xx.back().back() * variance);
}

double SharedQueues::Link::SentUntil(Time t) const {
  const auto next = std::upper_bound(sent.begin(), sent.end(), t,
                                     [](Time at, const Sent& packet) { return at < packet.at; });
  return next == sent.end() ? sent_kb : next->before_kb;
}

void SharedQueues::Link::Measure(Time sent_at, double longer_ms) {
  delay_ms += longer_ms;
  if (sent_at - base_since > kBaseWindow || std::abs(longer_ms) > kJumpMs) {
    base_since = sent_at;
    old_base_ms = std::abs(longer_ms) > kJumpMs ? delay_ms : base_ms;
    base_ms = delay_ms;
  }
  base_ms = std::min(base_ms, delay_ms);
  queue_ms = delay_ms - std::min(base_ms, old_base_ms);
}

void SharedQueues::OnSent(Time now, std::size_t link, DataSize size) {
  Link& l = links_[link];
  l.sent.push_back({now, l.sent_kb});
  l.sent_kb += static_cast<double>(size.bytes()) / 1000;
  if (l.sent.size() > kMaxSent) l.sent.pop_front();
}

void SharedQueues::OnArrival(std::size_t link, const Arrival& arrival) {
  Link& l = links_[link];
  if (l.last && arrival.sent <= l.last->sent) return;
  const auto last = std::exchange(l.last, arrival);
  if (!last) return;
  const double sent_ms = Milliseconds(arrival.sent - last->sent);
  const auto ticks = static_cast<std::int32_t>(arrival.report_timestamp - last->report_timestamp);
  const double arrived_ms = ticks / 65.536 - Milliseconds(arrival.age - last->age);
  // A packet counts if earlier packets met a queue. Its own arrival must not decide, because a
  // selection by arrival times would distort the regression.
  const bool busy = l.queue_ms > sent_ms + kMarginMs;
  l.Measure(arrival.sent, arrived_ms - sent_ms);
  for (std::size_t other = 0; other < kMaxLinks; ++other)
    if (other != link) Compare(link, other);
  if (!busy || arrived_ms > kPauseMs) return;
  // A longer spacing has less weight, because it contains more packets of other flows.
  const double weight = 1 / std::sqrt(1 + sent_ms);
  const double own_kb = l.SentUntil(arrival.sent) - l.SentUntil(last->sent);
  for (std::size_t other = 0; other < kMaxLinks; ++other) {
    if (other == link || links_[other].sent.empty()) continue;
    const double other_kb =
        links_[other].SentUntil(arrival.sent) - links_[other].SentUntil(last->sent);
    pairs_[link][other].spacing.Add({weight, weight * sent_ms, weight * own_kb, weight * other_kb},
                                    weight * arrived_ms);
    Decide(link, other);
  }
}

void SharedQueues::Compare(std::size_t a, std::size_t b) {
  const Link& x = links_[a];
  const Link& y = links_[b];
  if (!y.last || x.last->sent - y.last->sent > kTogether || y.last->sent - x.last->sent > kTogether)
    return;
  Pair& pair = pairs_[std::min(a, b)][std::max(a, b)];
  pair.apart_ms += (std::abs(x.queue_ms - y.queue_ms) - pair.apart_ms) / kQueues;
  pair.longer_ms += (std::max(x.queue_ms, y.queue_ms) - pair.longer_ms) / kQueues;
  if (pair.apart_ms <= kStillAlike * pair.longer_ms) return;
  for (Pair* way : {&pairs_[a][b], &pairs_[b][a]}) way->spacing.Fade(1 - kFade);
}

void SharedQueues::Decide(std::size_t a, std::size_t b) {
  Pair& there = pairs_[a][b];
  Pair& back = pairs_[b][a];
  const double both = (there.spacing.Significance() + back.spacing.Significance()) / std::sqrt(2.0);
  const Pair& pair = pairs_[std::min(a, b)][std::max(a, b)];
  const bool shared = there.shared;
  there.shared = back.shared = both > (shared ? kStillFound : kFound) &&
                               pair.apart_ms < (shared ? kStillAlike : kAlike) * pair.longer_ms;
}

void SharedQueues::Forget(std::size_t link) {
  links_[link] = {};
  for (std::size_t other = 0; other < kMaxLinks; ++other)
    pairs_[link][other] = pairs_[other][link] = {};
}

}  // namespace lidar::bonding
