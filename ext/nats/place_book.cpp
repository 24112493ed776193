// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/nats/place_book.h"

#include <algorithm>
#include <iterator>

namespace lidar::nats {
namespace {

constexpr std::size_t kMaxRuns = 8;
constexpr std::size_t kMaxSpans = 256;  // per run
/// The largest jump in the numbers that counts as missing messages. A stream needs days to send so
/// many messages, so a larger jump means a damaged number.
constexpr std::uint64_t kMaxMissing = 100'000'000;

}  // namespace

PlaceBook::Spans& PlaceBook::SpansOf(std::uint64_t run) {
  const auto found =
      std::find_if(runs_.begin(), runs_.end(), [run](const Run& r) { return r.run == run; });
  if (found != runs_.end()) return found->spans;
  if (runs_.size() >= kMaxRuns) runs_.pop_front();
  return runs_.emplace_back(Run{run, {}}).spans;
}

PlaceBook::Verdict PlaceBook::Note(const Place& place) {
  Spans& spans = SpansOf(place.run);
  const std::uint64_t n = place.number;
  Verdict verdict;
  auto behind = spans.upper_bound(n);  // the first span that begins after n
  auto span = behind == spans.begin() ? spans.end() : std::prev(behind);
  verdict.again = span != spans.end() && n <= span->second;
  if (verdict.again) return verdict;
  verdict.late = behind != spans.end();
  verdict.fills_gap = verdict.late && span != spans.end();
  if (!verdict.late && span != spans.end()) verdict.missing = n - span->second - 1;
  if (verdict.missing > kMaxMissing) verdict.missing = 0;
  // The number extends a neighbouring span, or becomes a span of its own.
  if (span != spans.end() && span->second + 1 == n)
    span->second = n;
  else
    span = spans.emplace_hint(behind, n, n);
  if (behind != spans.end() && behind->first == n + 1) {
    span->second = behind->second;
    spans.erase(behind);
  }
  if (spans.size() > kMaxSpans) spans.erase(spans.begin());
  return verdict;
}

}  // namespace lidar::nats
