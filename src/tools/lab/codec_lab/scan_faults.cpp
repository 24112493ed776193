// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/lab/codec_lab/scan_faults.h"

#include <random>
#include <utility>

namespace lidar::tools {
namespace {

constexpr int kBurst = 3;  // number of consecutive scans that are lost together
constexpr Duration kBeforeTheGap = std::chrono::seconds(10);

void KeepBeams(unsigned every, Scan* scan) {
  if (scan->organised()) {
    const std::size_t columns = scan->geometry->model.columns_per_scan;
    for (std::size_t i = 0; i < scan->ranges.size(); ++i)
      if (i / columns % every != 0) scan->ranges[i] = 0;
    return;
  }
  Scan kept;
  for (std::size_t i = 0; i < scan->rings.size(); ++i) {
    if (scan->rings[i] % every != 0) continue;
    kept.xyz.insert(kept.xyz.end(), &scan->xyz[3 * i], &scan->xyz[3 * i] + 3);
    kept.rings.push_back(scan->rings[i]);
    if (i < scan->intensity.size()) kept.intensity.push_back(scan->intensity[i]);
    if (i < scan->phases.size()) kept.phases.push_back(scan->phases[i]);
  }
  if (!scan->rings.empty()) *scan = std::move(kept);
}

class FaultyScans final : public ScanStream {
 public:
  FaultyScans(std::unique_ptr<ScanStream> scans, const ScanFaults& faults)
      : ScanStream(scans->scans_per_second()), scans_(std::move(scans)), faults_(faults) {}

  std::optional<TimedScan> Next() override {
    while (auto timed = scans_->Next()) {
      if (!first_) first_ = timed->start;
      if (number_++ % faults_.every_scan != 0) continue;
      if (IsLost(timed->start - *first_)) continue;
      if (faults_.every_beam > 1) KeepBeams(faults_.every_beam, &timed->scan);
      return timed;
    }
    return std::nullopt;
  }
  const synth::Trajectory* trajectory() const override { return scans_->trajectory(); }

 private:
  bool IsLost(Duration since_first) {
    const Duration after = since_first - kBeforeTheGap;
    if (after >= Duration{0} && after < FromSeconds(faults_.gap_s)) return true;
    if (left_of_burst_ > 0) return left_of_burst_-- > 0;
    // The chance that a burst begins at this scan. It makes the bursts lose `lost_share` of all
    // scans.
    const double begins =
        faults_.lost_share / (kBurst * (1 - faults_.lost_share) + faults_.lost_share);
    const double drawn = static_cast<double>(random_()) / static_cast<double>(random_.max());
    if (since_first == Duration{0} || drawn >= begins) return false;
    left_of_burst_ = kBurst - 1;
    return true;
  }

  std::unique_ptr<ScanStream> scans_;
  ScanFaults faults_;
  std::optional<Time> first_;
  std::size_t number_ = 0;
  int left_of_burst_ = 0;
  std::minstd_rand random_{1};
};

}  // namespace

std::unique_ptr<ScanStream> WithFaults(std::unique_ptr<ScanStream> scans,
                                       const ScanFaults& faults) {
  if (!faults.any()) return scans;
  return std::make_unique<FaultyScans>(std::move(scans), faults);
}

}  // namespace lidar::tools
