// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/lab/mixing_train/training.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "src/codec/intensity_scale.h"

namespace lidar::tools {
namespace {

namespace mixing = codec::mixing;
using mixing::SliceBins;

constexpr std::uint32_t kSlices = 8;
// The largest errors [m] to train with. Each class of steps has at least one of these errors, both
// if ranges have units of 1 mm and if they have units of 8 mm.
constexpr std::array<double, 6> kErrors = {0.001, 0.004, 0.01, 0.02, 0.05, 0.1};
constexpr std::array<unsigned, mixing::kLevelClasses> kLevelBits = {5, 8};
constexpr double kLevelError = 0.02;
// The least rates of trained counters. With a lower rate, a counter would hardly change in a slice.
constexpr std::uint16_t kLeastRate = mixing::RateAfter(24);
constexpr std::uint16_t kLeastJumpRate = mixing::RateAfter(48);
// The size of the version, the flags, the lengths and the first byte of the payload.
constexpr std::size_t kHeaderBytes = 13;

/// Fills `bins` with the ranges of a slice. Returns how many LiDAR returns the slice has.
std::size_t ToBins(const Scan& scan, SliceOf slice, const MixingCase& setting, SliceBins* bins) {
  const SensorModel& model = scan.geometry->model;
  const ColumnWindow window = WindowOf(scan, slice);
  const auto grid = RangeGrid::ForError(setting.error_m, model.range_unit_mm);
  const codec::IntensityScale scale(codec::FullScale::kByte, setting.level_bits);
  bins->beams = static_cast<std::uint32_t>(model.beams.size());
  bins->columns = window.count;
  bins->step_mm = std::int64_t{grid.parts() / RangeGrid::kParts} * grid.unit_mm();
  bins->level_bits = setting.level_bits;
  bins->has_gaps = false;
  bins->bins.clear();
  bins->levels.clear();
  std::size_t returns = 0;
  for (std::size_t beam = 0; beam < bins->beams; ++beam) {
    for (std::size_t i = 0; i < window.count; ++i) {
      const std::size_t at = beam * model.columns_per_scan + window.first + i;
      const std::uint32_t range = scan.ranges[at];
      bins->bins.push_back(range == 0 ? mixing::kNoReturn
                                      : static_cast<std::int32_t>(grid.BinOf(range)));
      if (setting.level_bits > 0)
        bins->levels.push_back(range == 0 ? 0 : scale.LevelOf(scan.intensity[at]));
      bins->has_gaps = bins->has_gaps || range == 0;
      returns += range != 0 ? 1 : 0;
    }
  }
  return returns;
}

template <std::size_t kSize>
void Hasten(std::uint16_t least_rate, std::array<mixing::Counter, kSize>* counters) {
  for (mixing::Counter& counter : *counters) counter.rate = std::max(counter.rate, least_rate);
}

/// The mean of each number over the slices that visited or changed the number. All slices have the
/// same weight.
class Means {
 public:
  void Add(std::size_t place, std::int64_t number) {
    if (sums_.size() <= place) {
      sums_.resize(place + 1);
      counts_.resize(place + 1);
    }
    sums_[place] += number;
    ++counts_[place];
  }
  template <class Number>
  void Take(std::size_t place, Number* number) const {
    if (place < sums_.size() && counts_[place] > 0)
      *number = static_cast<Number>(sums_[place] / counts_[place]);
  }

 private:
  std::vector<std::int64_t> sums_;
  std::vector<std::int64_t> counts_;
};

/// Visits the numbers of two objects of the same type in pairs. The order is always the same.
class Walk {
 public:
  template <std::size_t kSize, class Do>
  void Of(std::array<mixing::Counter, kSize>& a, const std::array<mixing::Counter, kSize>& b,
          Do&& act) {
    for (std::size_t i = 0; i < kSize; ++i, ++place_)
      act(place_, a[i].chance, b[i].chance, a[i].rate != b[i].rate);
  }
  template <std::size_t kSize, class Do>
  void Of(std::array<mixing::Weights, kSize>& a, const std::array<mixing::Weights, kSize>& b,
          Do&& act) {
    for (std::size_t i = 0; i < kSize; ++i)
      for (unsigned k = 0; k < mixing::kInputs; ++k, ++place_)
        act(place_, a[i].values[k], b[i].values[k], false);
  }
  template <std::size_t kSize, class Do>
  void Of(std::array<std::int32_t, kSize>& a, const std::array<std::int32_t, kSize>& b, Do&& act) {
    for (std::size_t i = 0; i < kSize; ++i, ++place_) act(place_, a[i], b[i], false);
  }

 private:
  std::size_t place_ = 0;
};

template <class States>
constexpr auto kParts = std::tuple(&States::small, &States::rest);
template <>
constexpr auto kParts<mixing::LevelWeights> = std::tuple(&mixing::LevelWeights::uneven,
                                                         &mixing::LevelWeights::surfaces);
template <>
constexpr auto kParts<mixing::BinCounters> = std::tuple(&mixing::BinCounters::mask,
                                                        &mixing::BinCounters::range,
                                                        &mixing::BinCounters::jump,
                                                        &mixing::BinCounters::candidates,
                                                        &mixing::BinCounters::spread);
template <>
constexpr auto kParts<mixing::BinWeights> = std::tuple(&mixing::BinWeights::mask,
                                                       &mixing::BinWeights::range,
                                                       &mixing::BinWeights::event,
                                                       &mixing::BinWeights::jump);

template <class States, class Do>
void ForEach(States& a, const States& b, Do&& act) {
  Walk walk;
  std::apply([&](auto... part) { (walk.Of(a.*part, b.*part, act), ...); }, kParts<States>);
}

/// Adds to `means` the numbers that a slice has visited or changed. Sets `states` to `learnt`.
template <class States>
void Keep(States& learnt, States* states, Means* means) {
  ForEach(learnt, *states, [&](std::size_t place, auto& now, auto before, bool visited) {
    if (visited || now != before) means->Add(place, now);
  });
  *states = learnt;
}
template <class States>
void TakeMeans(const Means& means, States* states) {
  ForEach(*states, *states,
          [&](std::size_t place, auto& now, auto, bool) { means.Take(place, &now); });
}

/// Trains the start states. Each slice starts with the states that the slice before it has left.
class Trainer {
 public:
  Trainer() {
    for (auto& states : states_) states->Reset();
  }

  void Learn(const Scan& scan, SliceOf slice) {
    const codec::AzimuthAlignment alignment(scan.geometry->model);
    mixing::SliceCoder coder(alignment);
    for (const double error : kErrors) {
      ToBins(scan, slice, {1, error, 0, kSlices}, &bins_);
      for (unsigned effort = 1; effort <= mixing::kEfforts; ++effort) LearnBins(effort, &coder);
    }
    for (unsigned i = 0; i < kLevelBits.size(); ++i) {
      if (scan.intensity.empty()) break;
      ToBins(scan, slice, {1, kLevelError, kLevelBits[i], kSlices}, &bins_);
      for (unsigned effort = 1; effort <= mixing::kEfforts; ++effort)
        LearnLevels(effort, i, &coder);
    }
  }

  std::unique_ptr<mixing::StartStates> Finish() {
    for (unsigned i = 0; i < mixing::kEfforts; ++i) {
      all().weights[i] = states_[i]->weights[i];
      TakeMeans(weight_means_[i], &all().weights[i]);
      all().level_weights[i] = states_[i]->level_weights[i];
      for (unsigned k = 0; k < mixing::kLevelClasses; ++k)
        TakeMeans(level_weight_means_[i][k], &all().level_weights[i][k]);
    }
    for (unsigned i = 0; i < mixing::kStepClasses; ++i) {
      auto& c = all().counters[i];
      TakeMeans(counter_means_[i], &c);
      Hasten(kLeastRate, &c.mask);
      Hasten(kLeastRate, &c.range);
      Hasten(kLeastJumpRate, &c.jump);
      Hasten(kLeastJumpRate, &c.candidates);
    }
    for (unsigned i = 0; i < mixing::kLevelClasses; ++i) {
      auto& level = all().level_counters[i];
      TakeMeans(level_counter_means_[i], &level);
      Hasten(kLeastRate, &level.small);
      Hasten(kLeastRate, &level.rest);
    }
    all().Round();
    return std::move(states_.back());
  }

 private:
  void Run(unsigned effort, mixing::SliceCoder* coder) {
    written_.clear();
    mixing::BinaryEncoder encoder(&written_);
    coder->Code(effort, model_.get(), &bins_, &encoder);
  }
  void LearnBins(unsigned effort, mixing::SliceCoder* coder) {
    mixing::StartStates& states = *states_[effort - 1];
    states.CopyTo(effort, bins_.step_mm, 0, model_.get());
    Run(effort, coder);
    const unsigned step_class = mixing::StepClassOf(bins_.step_mm);
    Means unused;
    Keep(model_->counters, &states.counters[step_class],
         effort == mixing::kEfforts ? &counter_means_[step_class] : &unused);
    Keep(model_->weights, &states.weights[effort - 1], &weight_means_[effort - 1]);
  }
  void LearnLevels(unsigned effort, unsigned level_class, mixing::SliceCoder* coder) {
    mixing::StartStates& states = *states_[effort - 1];
    states.CopyTo(effort, bins_.step_mm, bins_.level_bits, model_.get());
    Run(effort, coder);
    Means unused;
    Keep(model_->level_counters, &states.level_counters[level_class],
         effort == mixing::kEfforts ? &level_counter_means_[level_class] : &unused);
    Keep(model_->level_weights, &states.level_weights[effort - 1][level_class],
         &level_weight_means_[effort - 1][level_class]);
  }
  /// Returns the states of the last effort, which has the counters of all efforts.
  mixing::StartStates& all() { return *states_.back(); }

  using States = std::unique_ptr<mixing::StartStates>;
  std::array<States, mixing::kEfforts> states_ = {std::make_unique<mixing::StartStates>(),
                                                  std::make_unique<mixing::StartStates>(),
                                                  std::make_unique<mixing::StartStates>()};
  std::array<Means, mixing::kStepClasses> counter_means_;
  std::array<Means, mixing::kEfforts> weight_means_;
  std::array<Means, mixing::kLevelClasses> level_counter_means_;
  std::array<std::array<Means, mixing::kLevelClasses>, mixing::kEfforts> level_weight_means_;
  std::unique_ptr<mixing::Model> model_ = std::make_unique<mixing::Model>();
  SliceBins bins_;
  std::vector<std::uint8_t> written_;  // not read, because only the learnt states matter
};

}  // namespace

std::unique_ptr<mixing::StartStates> TrainMixing(const std::vector<const ScanSet*>& sets) {
  Trainer trainer;
  // Alternates between the sets, because consecutive slices should differ from each other.
  for (std::uint32_t index = 0; index < kSlices; ++index)
    for (const ScanSet* set : sets)
      for (const Scan& scan : set->scans) trainer.Learn(scan, {index, kSlices});
  return trainer.Finish();
}

double BitsPerReturn(const ScanSet& set, const MixingCase& setting,
                     const mixing::StartStates& states) {
  const codec::AzimuthAlignment alignment(set.scans.front().geometry->model);
  mixing::SliceCoder coder(alignment);
  const auto model = std::make_unique<mixing::Model>();
  SliceBins bins;
  double returns = 0;
  double bytes = 0;
  for (const Scan& scan : set.scans) {
    for (std::uint32_t index = 0; index < setting.slices; ++index) {
      returns += static_cast<double>(ToBins(scan, {index, setting.slices}, setting, &bins));
      std::vector<std::uint8_t> payload;
      mixing::BinaryEncoder encoder(&payload);
      states.CopyTo(setting.effort, bins.step_mm, setting.level_bits, model.get());
      coder.Code(setting.effort, model.get(), &bins, &encoder);
      encoder.Finish();
      bytes += static_cast<double>(payload.size() + kHeaderBytes);

      SliceBins decoded = bins;
      std::fill(decoded.bins.begin(), decoded.bins.end(), 0);
      std::fill(decoded.levels.begin(), decoded.levels.end(), std::uint8_t{0});
      mixing::BinaryDecoder decoder({payload.data(), payload.size()});
      states.CopyTo(setting.effort, bins.step_mm, setting.level_bits, model.get());
      if (!coder.Code(setting.effort, model.get(), &decoded, &decoder) || !decoder.AtEnd() ||
          decoded.bins != bins.bins || decoded.levels != bins.levels) {
        throw std::runtime_error(set.name + ": a decoded slice differs from the original");
      }
    }
  }
  return 8 * bytes / returns;
}

}  // namespace lidar::tools
