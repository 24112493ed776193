// SPDX-License-Identifier: LGPL-2.1-or-later
#include "draco/codec/mask_coder.h"

#include <algorithm>

namespace lidar::codec {
namespace {

// Chance of a return in 1/64, where the pixels above (1), to the left (2) and above right (4) have
// one. Only a start: the models learn from there. Part of the format.
constexpr std::array<std::uint32_t, 8> kChance = {2, 24, 36, 55, 15, 32, 47, 63};

/// The models before the first pixel. A context is, from bit 0: the four pixels above, the one
/// right and the one left of those, and the two to the left.
std::array<NibbleModel, 256> MakeInitialModels() {
  std::array<NibbleModel, 256> models;
  for (unsigned context = 0; context < models.size(); ++context) {
    std::array<std::uint16_t, kNibbles> counts{};
    for (unsigned four = 0; four < kNibbles; ++four) {
      std::uint32_t chance = 1;
      unsigned left = context >> 6 & 1;
      for (unsigned i = 0; i < 4; ++i) {
        const unsigned bit = four >> i & 1;
        const std::uint32_t p =
            kChance[(context >> i & 1) | left << 1 | (context >> (i + 1) & 1) << 2];
        chance =
            i == 3 ? chance / 64 * (bit != 0 ? p : 64 - p) / 64 : chance * (bit != 0 ? p : 64 - p);
        left = bit;
      }
      counts[four] = static_cast<std::uint16_t>(chance + 1);
    }
    models[context] = NibbleModel(counts);
  }
  return models;
}

/// Bit i of the result is byte i, each being 0 or 1.
unsigned PackFour(const std::uint8_t* bytes) {
  return static_cast<unsigned>(bytes[0] | bytes[1] << 1 | bytes[2] << 2 | bytes[3] << 3);
}

}  // namespace

void MaskCoder::Reset(const AzimuthAlignment& alignment, std::uint32_t columns) {
  static const std::array<NibbleModel, kContexts> initial = MakeInitialModels();
  models_ = initial;
  above_.Reset(alignment, columns, 1);
}

/// Calls code(model, beam, column) for the four bits from each column on. Bits past the last
/// column are zero.
template <class CodeFour>
void MaskCoder::ForEachFour(const AzimuthAlignment& alignment, std::uint32_t columns,
                            CodeFour&& code) {
  Reset(alignment, columns);
  for (std::uint32_t beam = 0; beam < alignment.beams(); ++beam) {
    std::uint8_t* above = above_.At(beam);
    unsigned left = above[-1] | static_cast<unsigned>(above[-2]) << 1;
    std::uint8_t above_left = above[-1];
    for (std::uint32_t column = 0; column < columns; column += 4) {
      std::uint8_t* here = above + column;
      const unsigned context = PackFour(here) | static_cast<unsigned>(here[4]) << 4 |
                               static_cast<unsigned>(above_left) << 5 | left << 6;
      const unsigned four = code(&models_[context], beam, column);
      above_left = here[3];
      const std::uint32_t count = std::min(4U, columns - column);
      for (unsigned i = 0; i < count; ++i) here[i] = four >> i & 1;
      left = (four >> 3 & 1) | (four >> 1 & 2);
    }
    above_.CloseTurn(beam);
  }
}

void MaskCoder::Encode(const Mask& mask, const AzimuthAlignment& alignment, std::uint32_t columns,
                       RansEncoder* encoder) {
  ForEachFour(alignment, columns,
              [&](NibbleModel* model, std::uint32_t beam, std::uint32_t column) {
                const std::uint8_t* bits = &mask[std::size_t{beam} * columns + column];
                unsigned four = 0;
                for (unsigned i = 0; i < std::min(4U, columns - column); ++i)
                  four |= static_cast<unsigned>(bits[i]) << i;
                encoder->Put(four, model);
                return four;
              });
}

void MaskCoder::Decode(const AzimuthAlignment& alignment, std::uint32_t columns,
                       RansDecoder* decoder, Mask* mask) {
  ForEachFour(alignment, columns,
              [&](NibbleModel* model, std::uint32_t beam, std::uint32_t column) {
                const unsigned four = decoder->Get(model);
                std::uint8_t* bits = &(*mask)[std::size_t{beam} * columns + column];
                for (unsigned i = 0; i < std::min(4U, columns - column); ++i)
                  bits[i] = four >> i & 1;
                return four;
              });
}

}  // namespace lidar::codec
