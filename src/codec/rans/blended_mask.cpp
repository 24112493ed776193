// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/rans/blended_mask.h"

#include <algorithm>
#include <cstring>

namespace lidar::codec {
namespace {

constexpr std::uint32_t kBytes = 0x01010101;

/// Returns the bytes of four pixels as a number. The first byte is in the lowest bits.
std::uint32_t FourAt(const std::uint8_t* bytes) {
  return std::uint32_t{bytes[0]} | std::uint32_t{bytes[1]} << 8 | std::uint32_t{bytes[2]} << 16 |
         std::uint32_t{bytes[3]} << 24;
}
/// Returns the lowest bits of four bytes as a number of four bits.
std::uint32_t PackFour(std::uint32_t four) { return (four & kBytes) * 0x10204080U >> 28; }
/// Returns the sum of four bytes, each of which is less than 64.
std::uint32_t SumOf(std::uint32_t four) { return four * kBytes >> 24; }

/// Tables about the last eight pixels of a row, which are the bits of `before`; bit 0 is the last
/// pixel. `ones` counts the returns, `runs` the equal pixels up to the last one. `reversed` is a
/// number of four bits with their order reversed.
struct LeftTable {
  constexpr LeftTable() {
    for (unsigned before = 0; before < 256; ++before) {
      for (unsigned i = 0; i < 8; ++i) ones[before] += before >> i & 1;
      unsigned run = 1;
      while (run < 8 && (before >> run & 1) == (before & 1)) ++run;
      runs[before] = static_cast<std::uint8_t>(run);
    }
    for (unsigned four = 0; four < kNibbles; ++four)
      for (unsigned i = 0; i < 4; ++i) reversed[four] |= (four >> i & 1) << (3 - i);
  }
  std::uint8_t ones[256] = {};
  std::uint8_t runs[256] = {};
  std::uint8_t reversed[kNibbles] = {};
};
constexpr LeftTable kLeft;

/// Returns the class of the number of equal pixels to the left: 1, 2, 3, 4-7, 8-14, more.
std::uint32_t RunClass(std::uint32_t before) {
  const std::uint32_t near = kLeft.runs[before & 255];
  if (near < 4) return near - 1;
  if (near < 8) return 3;
  const std::uint32_t all = (before & 1) != 0 ? 0x7FFF : 0;
  return (before & 0x7FFF) == all ? 5 : 4;
}

/// Returns true if there is no return among the pixels that choose the models of a group. `above`
/// points to the byte above the group's first pixel.
bool IsAmongEmpty(const std::uint8_t* above, std::uint32_t before) {
  constexpr std::uint32_t kThreeBeams = 7 * kBytes;
  const std::uint32_t beside =
      FourAt(above - MaskCoder::kGroup) | FourAt(above + MaskCoder::kGroup);
  return ((FourAt(above) & kThreeBeams) | (beside & kBytes) | (before & 0x7FFF)) == 0;
}

}  // namespace

void BlendedMask::Reset(const AzimuthAlignment& alignment, std::uint32_t columns) {
  const auto& first = MaskCoder::InitialModels();
  models_[0].assign(first.begin(), first.end());
  for (unsigned k = 1; k < kBlended; ++k) models_[k].assign(kSizes[k], NibbleModel());
  above_.Reset(alignment, columns, 0xFF);
  row_.assign(std::size_t{MaskCoder::Groups(columns)} * kGroup, 0);
}

/// Returns the models of a group. `above` points to the byte above the group's first pixel.
[[gnu::always_inline]] inline BlendedModels BlendedMask::ModelsOf(const std::uint8_t* above,
                                                                  std::uint32_t before) {
  const std::uint32_t here = FourAt(above);
  const std::uint32_t up = PackFour(here);
  const std::uint32_t west = above[-1] & 1;
  const std::uint32_t east = above[kGroup] & 1;
  const std::uint32_t last = before & 1;
  const std::uint32_t farther = SumOf((here >> 1 & kBytes) + (here >> 2 & kBytes));
  const std::uint32_t to_west = SumOf(FourAt(above - kGroup) & kBytes);
  const std::uint32_t to_east = SumOf(FourAt(above + kGroup) & kBytes);
  const BlendedModels models = {
      &models_[0][west | up << 1 | east << 5 | (before & 3) << 6],
      &models_[1][(before & 15) | up << 4 | east << 8 | (above[kGroup + 1] & 1U) << 9 | west << 10],
      &models_[2]
              [(((farther * 5 + to_east) * 5 + to_west) * 9 + kLeft.ones[before & 255]) * 2 + last],
      &models_[3][up | last << 4 | (RunClass(before) * 9 + farther) << 5]};
  for (unsigned k = 1; k < kBlended; ++k) models[k]->InheritOnce(*models[0]);
  return models;
}

/// Returns the models of a group that has only empty pixels around it.
BlendedModels BlendedMask::EmptyModels() {
  const std::array<std::uint8_t, 3 * kGroup> above{};
  return ModelsOf(&above[kGroup], 0);
}

/// Calls code(lane, models, pixels) for each group of a row. `code` returns the bits of the group.
///
/// Most pixels of a mask may be empty. If all pixels around a group are empty, code_empty(lane,
/// interval, pixels) may be called first. If the group itself is empty, `code_empty` codes it and
/// returns true. In this case `code` is not called.
template <class CodeFour, class CodeEmpty>
[[gnu::always_inline]] inline void BlendedMask::CodeRow(std::uint32_t beam, std::uint32_t columns,
                                                        CodeFour&& code, CodeEmpty&& code_empty) {
  std::uint8_t* above = above_.At(beam);
  std::uint32_t before = 0;
  for (std::ptrdiff_t i = 8; i > 0; --i) before = before << 1 | (above[-i] & 1U);
  const BlendedModels empty = EmptyModels();
  for (std::uint32_t x = 0; x < columns; x += kGroup) {
    if (IsAmongEmpty(above + x, before) && NibbleModel::ZeroRun::IsReady(empty)) {
      NibbleModel::ZeroRun run(empty);
      while (x < columns && IsAmongEmpty(above + x, before) &&
             code_empty(x / kGroup % kRansLanes, run.interval(), &row_[x])) {
        run.Update();
        x += kGroup;
      }
      run.Store(empty);
      if (x >= columns) break;
    }
    const BlendedModels models = ModelsOf(above + x, before);
    const unsigned four = code(x / kGroup % kRansLanes, models, &row_[x]);
    before = before << 4 | kLeft.reversed[four];
  }
  for (std::uint32_t i = 0; i < columns; ++i)
    above[i] = static_cast<std::uint8_t>(above[i] << 1 | row_[i]);
  above_.CloseTurn(beam);
}

void BlendedMask::Encode(const Mask& mask, const AzimuthAlignment& alignment, std::uint32_t columns,
                         RansEncoder* encoder) {
  Reset(alignment, columns);
  RansEncoder::Writer writer(encoder);
  for (std::uint32_t beam = 0; beam < alignment.beams(); ++beam) {
    std::copy_n(&mask[std::size_t{beam} * columns], columns, row_.data());
    CodeRow(
        beam, columns,
        [&](unsigned lane, const BlendedModels& models, const std::uint8_t* pixels) {
          const unsigned four = PackFour(FourAt(pixels));
          writer.Put(lane, four, models);
          return four;
        },
        [&](unsigned lane, Interval interval, const std::uint8_t* pixels) {
          if (FourAt(pixels) != 0) return false;
          writer.Put(lane, interval);
          return true;
        });
  }
}

bool BlendedMask::Decode(const AzimuthAlignment& alignment, std::uint32_t columns,
                         RansDecoder* decoder, Mask* mask) {
  Reset(alignment, columns);
  RansDecoder local = *decoder;
  for (std::uint32_t beam = 0; beam < alignment.beams(); ++beam) {
    CodeRow(
        beam, columns,
        [&](unsigned lane, const BlendedModels& models, std::uint8_t* pixels) {
          const unsigned four = local.Get(lane, models);
          local.GetBits(lane, 0);
          for (unsigned i = 0; i < kGroup; ++i) pixels[i] = four >> i & 1;
          return four;
        },
        [&](unsigned lane, Interval interval, std::uint8_t* pixels) {
          if (!local.GetZero(lane, interval)) return false;
          for (unsigned i = 0; i < kGroup; ++i) pixels[i] = 0;
          return true;
        });
    std::copy_n(row_.data(), columns, &(*mask)[std::size_t{beam} * columns]);
    if (local.overran()) return false;
  }
  *decoder = local;
  return true;
}

}  // namespace lidar::codec
