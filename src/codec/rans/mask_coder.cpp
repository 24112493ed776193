// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/rans/mask_coder.h"

#include <algorithm>

namespace lidar::codec {
namespace {

// The initial chance of a return, in 1/64. The index is the sum of 1 if there is a return above, 2
// if there is one to the left, and 4 if there is one above right. Part of the format.
constexpr std::array<std::uint32_t, 8> kChance = {2, 24, 36, 55, 15, 32, 47, 63};

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
            kChance[(context >> (i + 1) & 1) | left << 1 | (context >> (i + 2) & 1) << 2];
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

/// Packs eight bytes of 0 or 1: byte i becomes bit i.
unsigned PackEight(const std::uint8_t* bytes) {
  std::uint64_t eight = 0;
  for (unsigned i = 0; i < 8; ++i) eight |= std::uint64_t{bytes[i]} << (8 * i);
  return static_cast<unsigned>(eight * 0x0102040810204080U >> 56);
}

/// Sets four bytes to the four bits of `four`, beginning with the lowest bit.
void Unpack(unsigned four, std::uint8_t* bytes) {
  const std::uint32_t spread = four * 0x00204081U & 0x01010101U;
  for (unsigned i = 0; i < 4; ++i) bytes[i] = static_cast<std::uint8_t>(spread >> (8 * i));
}

}  // namespace

const std::array<NibbleModel, MaskCoder::kContexts>& MaskCoder::InitialModels() {
  static const std::array<NibbleModel, kContexts> initial = MakeInitialModels();
  return initial;
}

void MaskCoder::Reset(const AzimuthAlignment& alignment, std::uint32_t columns) {
  models_ = InitialModels();
  above_.Reset(alignment, columns, 1);
  row_.assign(std::size_t{Groups(columns)} * kGroup, 0);
}

/// Calls code(lane, model, pixels) for each group of a row, in the order of coding. `code` returns
/// the bits of the group. At the end the row is kept in `above_` for the next beam.
template <class CodeFour>
[[gnu::always_inline]] inline void MaskCoder::CodeRow(std::uint32_t beam, std::uint32_t columns,
                                                      CodeFour&& code) {
  std::uint8_t* above = above_.At(beam);
  const RowLanes lanes(Groups(columns));
  unsigned left[kRansLanes];  // bits 6 and 7 of the context: two pixels to the left
  for (unsigned lane = 0; lane < kRansLanes; ++lane) {
    const std::uint8_t* start = above + kGroup * (lane < lanes.lanes ? lanes.Start(lane) : 0);
    left[lane] = static_cast<unsigned>(start[-1] << 6 | start[-2] << 7);
  }
  ForEachInTurns(
      lanes, [&](unsigned lane, std::size_t group) __attribute__((always_inline)) {
        const unsigned context = (PackEight(above + kGroup * group - 1) & 63) | left[lane];
        const unsigned four = code(lane, &models_[context], &row_[kGroup * group]);
        left[lane] = (four << 3 & 64) | (four << 5 & 128);
      });
  std::copy_n(row_.data(), columns, above);
  above_.CloseTurn(beam);
}

void MaskCoder::Encode(const Mask& mask, const AzimuthAlignment& alignment, std::uint32_t columns,
                       RansEncoder* encoder) {
  Reset(alignment, columns);
  RansEncoder::Writer writer(encoder);
  for (std::uint32_t beam = 0; beam < alignment.beams(); ++beam) {
    std::copy_n(&mask[std::size_t{beam} * columns], columns, row_.data());
    CodeRow(beam, columns, [&](unsigned lane, NibbleModel* model, const std::uint8_t* pixels) {
      const auto four =
          static_cast<unsigned>(pixels[0] | pixels[1] << 1 | pixels[2] << 2 | pixels[3] << 3);
      writer.Put(lane, four, model);
      return four;
    });
  }
}

bool MaskCoder::Decode(const AzimuthAlignment& alignment, std::uint32_t columns,
                       RansDecoder* decoder, Mask* mask) {
  Reset(alignment, columns);
  RansDecoder local = *decoder;
  for (std::uint32_t beam = 0; beam < alignment.beams(); ++beam) {
    CodeRow(beam, columns, [&](unsigned lane, NibbleModel* model, std::uint8_t* pixels) {
      const unsigned four = local.Get(lane, model);
      local.GetBits(lane, 0);
      Unpack(four, pixels);
      return four;
    });
    std::copy_n(row_.data(), columns, &(*mask)[std::size_t{beam} * columns]);
    if (local.overran()) return false;
  }
  *decoder = local;
  return true;
}

}  // namespace lidar::codec
