// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/beam_part.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>

#include "src/codec/cloud/number_model.h"
#include "src/codec/mixing/binary_coder.h"

namespace lidar::codec::cloud {
namespace {

/// Guesses a field of the next beam. There are ten ways to guess, and the one that was best for the
/// last beams is used. The first eight ways take the value of one of the last eight beams, because
/// sensors repeat their patterns. The others are the last value plus the last change, and the mean.
class FieldGuess {
 public:
  static constexpr unsigned kWays = 10;

  /// Returns the best way. If several ways are equally good, returns the first of them.
  unsigned way() const {
    return static_cast<unsigned>(std::min_element(costs_.begin(), costs_.end()) - costs_.begin());
  }
  std::int32_t By(unsigned way) const {
    if (way < kLast) return last_[way];
    return way == kLast ? 2 * last_[0] - last_[1] : mean_ / kMeanParts;
  }
  /// Updates the guesses by the true value. `value` is an angle modulo `turn`, or not an angle if
  /// `turn` is 0.
  void See(std::int32_t value, std::int32_t turn) {
    for (unsigned way = 0; way < kWays; ++way) {
      std::int32_t off = std::abs(value - By(way));
      if (turn > 0) off = std::min(off, std::abs(turn - off));
      const auto bits = static_cast<std::uint32_t>(off);
      costs_[way] += (16 * mixing::BitLength(bits)) - costs_[way] / 8;
    }
    mean_ = last_seen_ ? mean_ + (kMeanParts * value - mean_) / 8 : kMeanParts * value;
    last_seen_ = true;
    std::copy_backward(last_.begin(), last_.end() - 1, last_.end());
    last_[0] = value;
  }

 private:
  static constexpr unsigned kLast = 8;
  static constexpr std::int32_t kMeanParts = 16;
  std::array<std::int32_t, kLast> last_{};
  std::array<std::int32_t, kWays> costs_{};
  std::int32_t mean_ = 0;
  bool last_seen_ = false;
};

template <class Coder>
class BeamFields {
 public:
  explicit BeamFields(Coder* coder) : coder_(*coder) {}

  /// Codes the next value of a field. It is a multiple of `unit`. If `turn` is not 0, it is an
  /// angle modulo `turn`.
  std::int32_t Code(unsigned field, std::int32_t value, std::int32_t unit, std::int32_t turn = 0) {
    FieldGuess& guess = guesses_[field];
    const unsigned way = guess.way();
    std::int32_t& length = lengths_[field];
    const std::int32_t from = guess.By(way);
    std::int32_t wanted = value / unit - from;
    const std::int32_t around = turn / unit;
    if (turn > 0) wanted = ((wanted + around / 2) & (around - 1)) - around / 2;
    const auto number = model_->Code(
        wanted, {field, field * 32 + static_cast<std::uint32_t>(length), field * 16 + way},
        &coder_);
    length = mixing::BitLength(static_cast<std::uint32_t>(std::abs(number)));
    // A damaged stream may have any number, so the value is limited. Valid values are smaller than
    // kLimit.
    const std::int32_t back =
        turn > 0 ? (from + number) & (around - 1) : std::clamp(from + number, -kLimit, kLimit);
    guess.See(back, around);
    return back * unit;
  }

 private:
  static constexpr std::int32_t kLimit = 2 * kTurn;
  static constexpr unsigned kFields = 6 + BeamTable::kMostPeriod;
  Coder& coder_;
  std::unique_ptr<NumberModel<3>> model_ = std::make_unique<NumberModel<3>>();
  std::array<FieldGuess, kFields> guesses_;
  std::array<std::int32_t, kFields> lengths_{};
};

}  // namespace

template <class Coder>
bool CodeBeams(BeamTable* table, Coder* coder) {
  BeamFields<Coder> fields(coder);
  const std::int32_t fine = table->bends ? BeamTable::kBentElevation : 1;
  std::int32_t above = kTurn / 4;
  for (BeamTable::Beam& beam : table->beams) {
    const std::int32_t below = fields.Code(0, above - beam.elevation, fine);
    beam.offset = fields.Code(1, beam.offset, table->bends ? BeamTable::kBentOffset : 1, kTurn);
    beam.height_um = fields.Code(2, beam.height_um, BeamTable::kLengthUnitUm);
    beam.side_um = fields.Code(3, beam.side_um, BeamTable::kLengthUnitUm);
    beam.reach_um = fields.Code(4, beam.reach_um, BeamTable::kLengthUnitUm);
    std::int32_t delay = 0;
    if (table->grains > 0 && !table->bends)
      delay = fields.Code(5, static_cast<std::int32_t>(beam.delay), 1);
    std::int32_t largest_swing = 0;
    for (std::uint32_t k = 0; k < table->period && table->period > 1; ++k) {
      beam.swings[k] = fields.Code(6 + k, beam.swings[k], BeamTable::kSwingUnit);
      largest_swing = std::max(largest_swing, std::abs(beam.swings[k]));
    }
    const std::int32_t largest_um =
        std::max({std::abs(beam.height_um), std::abs(beam.side_um), std::abs(beam.reach_um)});
    if (coder->overran() || below < 0 || below > above + kTurn / 4 || delay < 0 ||
        delay >= static_cast<std::int32_t>(table->columns()) || largest_swing > kTurn ||
        largest_um > BeamTable::kMostOffsetUm) {
      return false;
    }
    beam.elevation = above -= below;
    beam.delay = static_cast<std::uint32_t>(delay);
  }
  return true;
}

template bool CodeBeams(BeamTable*, mixing::BinaryEncoder*);
template bool CodeBeams(BeamTable*, mixing::BinaryDecoder*);

}  // namespace lidar::codec::cloud
