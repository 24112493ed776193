// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/pixel_part.h"

#include <algorithm>
#include <array>
#include <memory>

#include "src/codec/cloud/number_model.h"
#include "src/codec/mixing/binary_coder.h"

namespace lidar::codec::cloud {
namespace {

using mixing::BitLength;

constexpr std::int32_t kUnknownResidual = INT32_MIN;

/// The last two residuals of a beam, and the quotient that was coded last.
struct ResidualHistory {
  std::int32_t last = 0;
  std::int32_t before = 0;
  std::int32_t quotient = 0;
};

}  // namespace

/// Divides numbers of up to 2^24 by `width` and rounds the quotients, without a division for each.
class Rounder {
 public:
  explicit Rounder(std::int32_t width) : half_(width / 2), per_width_(1.0 / width) {}
  std::int32_t Of(std::int32_t number) const {
    // The 0.5 is added because an exact quotient may round to just below an integer.
    const auto size = static_cast<std::int32_t>((std::abs(number) + half_ + 0.5) * per_width_);
    return number < 0 ? -size : size;
  }

 private:
  std::int32_t half_;
  double per_width_;
};

template <class Coder>
bool CodePlaces(BeamTable* table, Coder* coder) {
  const auto model = std::make_unique<NumberModel<3>>();
  const auto usual =
      static_cast<std::int32_t>(std::uint64_t{table->grains} * BeamTable::kParts / table->turn);
  constexpr std::uint32_t kLongest = 31;
  std::int64_t place = -usual;
  std::array<std::uint32_t, 2> last = {8, 8};
  std::uint32_t run = 0;  // length of a run of equal numbers
  for (std::uint32_t& coded : table->places) {
    const std::array<std::uint32_t, 3> contexts = {last[0], last[0] * 16 + last[1],
                                                   run * 16 + last[0]};
    const auto number =
        model->Code(static_cast<std::int32_t>(coded - (place + usual)), contexts, coder);
    place += usual + number;
    if (coder->overran() || number < -usual || place < 0 || place >= table->grains) return false;
    coded = static_cast<std::uint32_t>(place);
    const auto near = static_cast<std::uint32_t>(std::clamp(number, -7, 7) + 8);
    run = near == last[0] ? std::min(run + 1, kLongest) : 0;
    last = {near, last[0]};
  }
  return true;
}

template <class Coder>
bool CodePath(std::vector<PathBeam>* path, Coder* coder) {
  const auto model = std::make_unique<NumberModel<3>>();
  PathBeam last;
  for (PathBeam& beam : *path) {
    std::uint32_t part = 0;
    for (const auto curve : {&PathBeam::azimuth, &PathBeam::elevation}) {
      std::uint32_t length = 0;  // bit length of the previous number
      for (std::uint32_t term = 0; term < kPathTerms; ++term) {
        std::int32_t& factor = (beam.*curve)[term];
        const std::int32_t guess = (last.*curve)[term];
        const std::uint32_t own = part * kPathTerms + term;
        const auto number = model->Code(factor - guess, {own, length, part * 32 + length}, coder);
        factor = guess + number;
        if (coder->overran() || std::abs(factor) > kTurn / kPathUnit) return false;
        length =
            static_cast<std::uint32_t>(BitLength(static_cast<std::uint32_t>(std::abs(number))));
      }
      ++part;
    }
    last = beam;
  }
  return true;
}

template <class Coder>
bool CodeResiduals(const RangeImage& image, const ResidualSettings& settings,
                   std::vector<std::int32_t>* residuals, Coder* coder) {
  const auto model = std::make_unique<NumberModel<4>>();
  std::vector<std::int32_t> of_column(image.columns, kUnknownResidual);
  for (std::uint32_t beam = 0; beam < image.beams; ++beam) {
    ResidualHistory row;
    for (std::uint32_t column = 0; column < image.columns; ++column) {
      const std::size_t pixel = std::size_t{beam} * image.columns + column;
      if (image.ranges[pixel] == 0) continue;
      const std::int32_t width = ResidualWidth(settings.tangent_um, image.ranges[pixel]);
      const Rounder rounder(width);
      const bool has_column = of_column[column] != kUnknownResidual;
      const std::int32_t above = has_column ? of_column[column] : row.last;
      const std::array<std::int32_t, kResidualGuesses> guesses = {0, above, row.last, row.before};
      const auto chosen = static_cast<std::size_t>(settings.guess);
      const std::int32_t guess = guesses[chosen];
      const auto away = [&](std::size_t other) {
        const std::int32_t q = rounder.Of(guesses[(chosen + other) % kResidualGuesses] - guess);
        return static_cast<std::uint32_t>(std::clamp(q, -3, 3) + 3);
      };
      const auto wide =
          static_cast<std::uint32_t>(std::min(BitLength(static_cast<std::uint32_t>(width)), 15));
      const auto size = static_cast<std::uint32_t>(std::min(std::abs(row.quotient), 3));
      const std::array<std::uint32_t, 4> contexts = {wide * 8 + size * 2 + (has_column ? 1 : 0),
                                                     away(1) * 7 + away(2), wide * 7 + away(1),
                                                     wide * 7 + away(2)};
      const std::int32_t quotient =
          model->Code(rounder.Of((*residuals)[pixel] - guess), contexts, coder);
      const std::int64_t back = guess + std::int64_t{quotient} * width;
      if (coder->overran() || back < -kTurn || back > kTurn) return false;
      (*residuals)[pixel] = of_column[column] = static_cast<std::int32_t>(back);
      row = {static_cast<std::int32_t>(back), row.last, quotient};
    }
  }
  return true;
}

namespace {

template <class Coder>
class ExtraCoder {
 public:
  ExtraCoder(const std::vector<std::int32_t>& bins, std::uint32_t columns,
             const ExtraSettings& settings, Coder* coder)
      : bins_(bins),
        columns_(columns),
        level_bits_(settings.level_bits),
        by_four_(settings.by_four),
        coder_(*coder),
        above_(columns, 0) {
    if (level_bits_ > 0) levels_ = std::make_unique<Model>();
  }

  /// Codes the further returns of all pixels, which are `limit` at most. Returns false if the
  /// stream is damaged.
  bool Code(std::size_t limit, std::vector<ExtraBin>* extras) {
    std::size_t at = 0;
    for (std::uint32_t row = 0; row < bins_.size(); row += columns_) {
      left_ = 0;
      for (std::uint32_t column = 0; column < columns_; ++column) {
        const std::uint32_t pixel = row + column;
        if (bins_[pixel] < 0) {
          left_ = above_[column] = 0;
          continue;
        }
        Look(pixel, column);
        const std::size_t first = at;
        if (!CodePixel(pixel, limit, extras, &at)) return false;
        left_ = above_[column] = at > first ? 1 : 0;
      }
    }
    return at == extras->size();
  }

 private:
  using Model = NumberModel<3>;
  using CountModel = BitModel<3, 8>;
  static constexpr std::int32_t kNoReturn = INT32_MAX;

  /// Codes the further returns of a pixel. They begin at (*extras)[*at]. Moves `at` behind them.
  bool CodePixel(std::uint32_t pixel, std::size_t limit, std::vector<ExtraBin>* extras,
                 std::size_t* at) {
    std::uint32_t count = 0;
    while (CodeMore(*at < extras->size() && (*extras)[*at].pixel == pixel, count)) {
      if (*at == limit) return false;
      if constexpr (Coder::kDecodes) extras->push_back({pixel, 0, 0});
      if (!CodeReturn(pixel, &(*extras)[*at]) || coder_.overran()) return false;
      ++count;
      ++*at;
    }
    return !coder_.overran();
  }
  static std::uint32_t LengthOf(std::int32_t v) {
    return static_cast<std::uint32_t>(BitLength(static_cast<std::uint32_t>(std::abs(v))));
  }
  /// Returns by how many bins a neighbour is farther than the pixel, or kNoReturn if the neighbour
  /// has no return.
  std::int32_t StepTo(std::uint32_t pixel, std::int64_t distance) const {
    const std::int64_t at = pixel + distance;
    if (at < 0 || at >= static_cast<std::int64_t>(bins_.size())) return kNoReturn;
    const std::int32_t bin = bins_[static_cast<std::size_t>(at)];
    return bin < 0 ? kNoReturn : bin - bins_[pixel];
  }
  /// Sets the contexts of a pixel with a return.
  void Look(std::uint32_t pixel, std::uint32_t column) {
    const std::int64_t row = columns_;
    const std::array<std::int64_t, 4> neighbours = {-1, -row, 1, row};
    jumps_ = 0;
    farthest_ = 0;
    for (unsigned i = 0; i < (by_four_ ? 4 : 2); ++i) {
      const std::int32_t step = StepTo(pixel, neighbours[i]);
      const std::int32_t size = std::abs(step);
      jumps_ = jumps_ * 4 + (step == kNoReturn ? 3U : size < 3 ? 0U : size < 16 ? 1U : 2U);
      if (step != kNoReturn && size >= 3 && size > std::abs(farthest_)) farthest_ = step;
    }
    nearby_ = left_ * 2 + above_[column];
    if (by_four_) nearby_ = nearby_ * 2 + (column + 1 < columns_ ? above_[column + 1] : 0U);
  }
  std::uint32_t FarthestClass() const {
    return LengthOf(farthest_) * 2 + (farthest_ < 0 ? 1U : 0U);
  }
  bool CodeMore(bool more, std::uint32_t count) {
    const typename Model::Contexts contexts =
        by_four_ ? typename Model::Contexts{nearby_ * 16 + jumps_ / 16, jumps_,
                                            nearby_ * 32 + std::min(FarthestClass(), 31U)}
                 : typename Model::Contexts{nearby_ * 16 + jumps_, nearby_, jumps_};
    return counts_->CodeBit(more, std::min(count, 3U), contexts, &coder_);
  }
  /// Codes a further return of `pixel`. Returns false if the stream is damaged.
  bool CodeReturn(std::uint32_t pixel, ExtraBin* extra) {
    constexpr std::uint32_t kNearNode = 4;
    constexpr std::uint32_t kNear = Model::kValues / 2;  // the first context of near returns
    const std::uint32_t far = FarthestClass();
    // A pulse at an edge hits both surfaces, so a further return is often near a neighbour's range.
    const bool near =
        by_four_ && farthest_ != 0 &&
        counts_->CodeBit(
            static_cast<std::uint32_t>(std::abs(extra->bin - farthest_)) <= LengthOf(farthest_),
            kNearNode, {far, jumps_, 0}, &coder_);
    const std::uint32_t sign = last_ < 0 ? 1U : 0U;
    const typename Model::Contexts contexts =
        near ? typename Model::Contexts{kNear + far, kNear, kNear + jumps_}
             : typename Model::Contexts{LengthOf(last_) * 2 + sign, LengthOf(bins_[pixel]), jumps_};
    const std::int32_t from = near ? farthest_ : 0;
    const std::int32_t number = distances_->Code(extra->bin - from, contexts, &coder_);
    if (number == Model::kTooLarge) return false;
    extra->bin = last_ = from + number;
    std::uint32_t node = 1;
    for (unsigned bit = level_bits_; bit-- > 0;) {
      const bool is_set = levels_->CodeBit((extra->level >> bit & 1) != 0, node % Model::kNodes,
                                           {node, 0, 1}, &coder_);
      node = node << 1 | (is_set ? 1U : 0U);
    }
    extra->level = static_cast<std::uint8_t>(node - (1U << level_bits_));
    return true;
  }

  const std::vector<std::int32_t>& bins_;
  std::uint32_t columns_;
  unsigned level_bits_;
  bool by_four_;
  Coder& coder_;
  std::unique_ptr<CountModel> counts_ = std::make_unique<CountModel>();
  std::unique_ptr<Model> distances_ = std::make_unique<Model>();
  std::unique_ptr<Model> levels_;    // null without levels
  std::vector<std::uint8_t> above_;  // for each column: 1 if its last pixel has further returns
  std::uint32_t left_ = 0;
  std::uint32_t nearby_ = 0;
  std::uint32_t jumps_ = 0;
  std::int32_t farthest_ = 0;  // largest step to a neighbour on another surface
  std::int32_t last_ = 0;
};

}  // namespace

template <class Coder>
bool CodeExtras(const std::vector<std::int32_t>& bins, std::uint32_t columns,
                const ExtraSettings& settings, std::vector<ExtraBin>* extras, Coder* coder) {
  return ExtraCoder<Coder>(bins, columns, settings, coder).Code(settings.limit, extras);
}

using mixing::BinaryDecoder;
using mixing::BinaryEncoder;
template bool CodePlaces(BeamTable*, BinaryEncoder*);
template bool CodePlaces(BeamTable*, BinaryDecoder*);
template bool CodePath(std::vector<PathBeam>*, BinaryEncoder*);
template bool CodePath(std::vector<PathBeam>*, BinaryDecoder*);
template bool CodeResiduals(const RangeImage&, const ResidualSettings&, std::vector<std::int32_t>*,
                            BinaryEncoder*);
template bool CodeResiduals(const RangeImage&, const ResidualSettings&, std::vector<std::int32_t>*,
                            BinaryDecoder*);
template bool CodeExtras(const std::vector<std::int32_t>&, std::uint32_t, const ExtraSettings&,
                         std::vector<ExtraBin>*, BinaryEncoder*);
template bool CodeExtras(const std::vector<std::int32_t>&, std::uint32_t, const ExtraSettings&,
                         std::vector<ExtraBin>*, BinaryDecoder*);

}  // namespace lidar::codec::cloud
