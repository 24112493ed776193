// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/demo/ledger.h"

#include <algorithm>

namespace lidar::demo {
namespace {

constexpr std::uint32_t kMaxSlices = 16384;

void Apply(const nlohmann::json& record, const std::string& type, SliceLife* life) {
  const auto time = record.at("unix_ns").get<std::int64_t>();
  if (type == "captured") {
    life->captured = time;
    life->due = record.at("due_ns").get<std::int64_t>();
    life->returns = record.value("returns", std::uint64_t{0});
    return;
  }
  const auto took = record.at("took_ns").get<std::int64_t>();
  if (type == "encoded") {
    life->encoded = time;
    life->bytes = record.at("bytes").get<std::uint64_t>();
    life->encode_ms = Ms(took);
  } else {
    life->received = time - took;
    life->decoded = time;
    life->decode_ms = Ms(took);
  }
}

}  // namespace

void Ledger::Add(const nlohmann::json& record) {
  const std::string type = record.value("type", "");
  if (type == "posed") posed_[record.value("scan", 0U)] = record.value("unix_ns", std::int64_t{0});
  if (type != "captured" && type != "encoded" && type != "decoded") return;
  const SliceKey key{record.value("scan", 0U), record.value("slice", 0U)};
  const auto count = record.value("count", 0U);
  if (count > kMaxSlices || key.slice >= count) return;
  // Records of the sender and of the receiver may overtake each other, so a record of either may be
  // the first of its scan.
  ScanLife& scan = scans_[key.scan];
  if (scan.size() < count) scan.resize(count);
  Apply(record, type, &scan[key.slice]);
}

void Ledger::Add(SliceKey key, const Comparison& comparison) {
  total_ += comparison;
  ++compared_slices_;
  if (SliceLife* life = Find(key)) life->comparison = comparison;
}

SliceLife* Ledger::Find(SliceKey key) {
  const auto scan = scans_.find(key.scan);
  if (scan == scans_.end() || key.slice >= scan->second.size()) return nullptr;
  return &scan->second[key.slice];
}

ScanCounts Ledger::Count(std::int64_t settled) const {
  ScanCounts n;
  for (const auto& [id, scan] : scans_) {
    const auto all = [&scan = scan](auto&& condition) {
      return std::all_of(scan.begin(), scan.end(), condition);
    };
    for (const SliceLife& s : scan) {
      n.slices_sent += s.encoded > 0;
      n.slices_lost += s.encoded > 0 && s.encoded < settled && s.decoded == 0;
    }
    if (!all([](const SliceLife& s) { return s.captured > 0; })) continue;
    ++n.captured;
    const bool sent = all([](const SliceLife& s) { return s.encoded > 0; });
    n.sent += sent;
    n.skipped += !sent && all([settled](const SliceLife& s) { return s.captured < settled; });
    n.complete += all([](const SliceLife& s) { return s.decoded > 0; });
    n.in_time += all(
        [](const SliceLife& s) { return s.decoded > 0 && Duration(s.decoded - s.due) <= kMaxAge; });
  }
  return n;
}

}  // namespace lidar::demo
