// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rate/rate_controller.h"

#include <algorithm>
#include <cmath>

namespace lidar::rate {
namespace {

// Each scan spends or repays only half of the bytes that earlier scans saved or sent in excess. To
// spend or repay all of them at once would double the noise of the sizes.
constexpr double kRepayGain = 0.5;
// The largest number of saved bytes, as a part of a scan's budget. It is small, because the network
// does not keep unused capacity for later.
constexpr double kMaxSaved = 0.05;
// A slice is encoded a second time if it exceeds its budget by more than kOver of this budget and
// by more than kOverOfScan of the scan's budget. Later slices even out smaller errors.
constexpr double kOver = 0.015;
constexpr double kOverOfScan = 0.01;
constexpr double kUnder = 3;         // a shortfall may be this many times larger than an excess
constexpr double kSameStep = 0.004;  // steps closer than this are the same
// The second encoding aims at a size below the budget, because the slope of the model may be wrong.
// The size is lower by this many doublings for each doubling between the first size and the budget.
constexpr double kReencodeMargin = 0.02;
constexpr double kBoundsChange = 0.03;
constexpr double kMaxTarget = 1e12;
constexpr std::uint32_t kMaxSlices = 4096;
constexpr double kDefaultScansPerSecond = 10;
constexpr double kMaxScansPerSecond = 1000;

SliceFeatures Sanitise(SliceFeatures slice) {
  slice.slice_count = std::clamp<std::uint32_t>(slice.slice_count, 1, kMaxSlices);
  slice.slice_index = std::min(slice.slice_index, slice.slice_count - 1);
  const double rate = slice.scans_per_second;
  if (!(rate > 0) || !std::isfinite(rate)) slice.scans_per_second = kDefaultScansPerSecond;
  slice.scans_per_second = std::min(slice.scans_per_second, kMaxScansPerSecond);
  return slice;
}

bool Moved(DataRate a, DataRate b) {
  return std::abs(a.bits_per_second() - b.bits_per_second()) > kBoundsChange * b.bits_per_second();
}

}  // namespace

RateController::RateController(ControllerParameters parameters, std::unique_ptr<SizeModel> model)
    : parameters_(parameters), model_(std::move(model)) {}

void RateController::SetTarget(std::optional<DataRate> target) {
  target_ = target;
  if (!target) return;
  const double bps = target->bits_per_second();
  target_ = DataRate::BitsPerSecond(bps > 0 ? std::min(bps, kMaxTarget) : 0);
}

double RateController::ScanBudget() const {
  return target_ ? target_->bits_per_second() / 8 / slice_.scans_per_second : 0;
}

void RateController::UpdateDemand() {
  const unsigned most = std::min(parameters_.limits.intensity_bits, kMaxIntensityBits);
  Demand demand;
  Settings settings{parameters_.limits.finest_step_m, 0, parameters_.limits.level};
  demand.finest = model_->Predict(slice_, settings).geometry_bytes;
  settings.step_m = parameters_.limits.coarsest_step_m;
  for (unsigned bits = 0; bits <= most; ++bits) {
    settings.intensity_bits = bits;
    const PredictedSize size = model_->Predict(slice_, settings);
    demand.coarsest = size.geometry_bytes;
    demand.intensity[bits] = size.intensity_bytes;
  }
  demand_.Set(slice_.slice_index, slice_.slice_count, demand);
}

void RateController::StartScan() {
  const Demand needed = demand_.Sum();
  const unsigned bits = std::min(parameters_.limits.intensity_bits, kMaxIntensityBits);
  saved_ += repay_ + ledger_;
  ledger_ = 0;
  repay_ = 0;
  const unsigned last_bits = started_ ? plan_.intensity_bits : bits;
  plan_ = {};
  plan_.intensity_bits = bits;
  if (!target_ || !parameters_.closed_loop) {
    saved_ = 0;
    return;
  }
  plan_ = PlanScan(
      {needed, ScanBudget(), saved_, measured_, bits, parameters_.min_intensity_bits, last_bits},
      parameters_.degradation);
  const double scan = needed.AtCoarsest(plan_.intensity_bits);
  const double budget = ScanBudget();
  saved_ =
      std::clamp(saved_, -2 * std::max(scan, budget), plan_.degraded ? scan : kMaxSaved * budget);
  if (plan_.degraded) {
    if (plan_.skip) ++stats_.scans_skipped;
    if (!plan_.skip && plan_.keep_fraction < 1) ++stats_.scans_thinned;
  } else {
    repay_ = kRepayGain * saved_;
    saved_ -= repay_;
  }
}

double RateController::SliceBudget() const {
  const double share = ScanBudget() / slice_.slice_count;
  if (!parameters_.closed_loop) return share;
  const std::uint32_t left = slice_.slice_count - slice_.slice_index;
  const double rest = repay_ + ledger_ + share * (left - 1);
  // Each slice gets the bytes that its error bound needs, and an equal share of the rest. The
  // quality is therefore uniform if the budget is near the minimum. If the budget is far above the
  // minimum, the transmission times are uniform.
  //
  // Slices outside of the sensor's window have few returns or none. The other slices get the bytes
  // that these slices do not use.
  const Demand needed = demand_.Sum(slice_.slice_index);
  const unsigned bits = plan_.intensity_bits;
  const double own = model_->Predict(slice_, {parameters_.limits.coarsest_step_m, bits, 0}).total();
  const double surplus = rest - needed.AtCoarsest(bits);
  return std::max(0.0, own + demand_.EvenShare(slice_.slice_index, surplus));
}

Decision RateController::NextSlice(const SliceFeatures& slice) {
  const bool scan_starts = !started_ || slice.scan_id != slice_.scan_id;
  if (pending_) Settle(0);
  slice_ = Sanitise(slice);
  UpdateDemand();
  if (scan_starts) StartScan();
  started_ = true;
  pending_ = true;
  reencoded_ = false;
  ++stats_.slices;
  ledger_ += ScanBudget() / slice_.slice_count;

  decision_ = {};
  decision_.settings = {parameters_.limits.coarsest_step_m, plan_.intensity_bits,
                        parameters_.limits.level};
  decision_.keep_fraction = plan_.keep_fraction;
  if (plan_.skip) {
    decision_.skip = true;
    ++stats_.slices_skipped;
    pending_ = false;
  } else if (target_ && !plan_.degraded) {
    const double budget = SliceBudget();
    SettingLimits limits = parameters_.limits;
    limits.intensity_bits = plan_.intensity_bits;
    decision_.budget = DataSize::Bytes(static_cast<std::int64_t>(std::min(budget, 1e15)));
    decision_.settings = model_->Choose(slice_, budget, limits);
  }
  stats_.saved_bytes = saved_ + repay_ + ledger_;
  return decision_;
}

void RateController::Settle(double bytes) {
  if (target_) ledger_ -= bytes;
  pending_ = false;
  bounds_due_ = bounds_due_ || slice_.slice_index + 1 == slice_.slice_count;
  stats_.saved_bytes = saved_ + repay_ + ledger_;
}

std::optional<Settings> RateController::OnEncoded(const EncodedSize& encoded) {
  if (!pending_) return std::nullopt;
  const double bytes = static_cast<double>(encoded.size.bytes());
  model_->OnEncoded(slice_, decision_.settings, encoded);
  measured_ = true;
  UpdateDemand();
  if (decision_.budget && parameters_.closed_loop && !reencoded_) {
    const double budget = static_cast<double>(decision_.budget->bytes());
    const double tolerance = std::max(kOver * budget, kOverOfScan * ScanBudget());
    if (bytes > budget + tolerance || bytes < budget - kUnder * tolerance) {
      const double margin =
          kReencodeMargin * std::abs(std::log2(std::max(bytes, 1.0) / std::max(budget, 1.0)));
      SettingLimits limits = parameters_.limits;
      limits.intensity_bits = plan_.intensity_bits;
      const Settings second = model_->Choose(slice_, budget * std::exp2(-margin), limits);
      if (std::abs(second.step_m / encoded.step_m - 1) > kSameStep) {
        reencoded_ = true;
        ++stats_.slices_reencoded;
        decision_.settings = second;
        return second;
      }
    }
  }
  Settle(bytes);
  return std::nullopt;
}

RateBounds RateController::bounds() const {
  const Demand scan = demand_.Sum();
  const unsigned bits = std::min(parameters_.limits.intensity_bits, kMaxIntensityBits);
  const unsigned least = std::min(parameters_.min_intensity_bits, bits);
  const double to_rate = 8 * slice_.scans_per_second;
  const auto rate = [&](double bytes) { return DataRate::BitsPerSecond(bytes * to_rate); };
  return {rate(scan.AtCoarsest(least)), rate(scan.AtCoarsest(bits)), rate(scan.AtFinest(bits))};
}

std::optional<RateBounds> RateController::TakeChangedBounds() {
  if (!bounds_due_ || !measured_) return std::nullopt;
  bounds_due_ = false;
  const RateBounds now = bounds();
  if (!Moved(now.min, bounds_taken_.min) && !Moved(now.nominal, bounds_taken_.nominal) &&
      !Moved(now.max, bounds_taken_.max))
    return std::nullopt;
  bounds_taken_ = now;
  return now;
}

}  // namespace lidar::rate
