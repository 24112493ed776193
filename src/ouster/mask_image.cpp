// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/ouster/mask_image.h"

#include <cctype>

namespace lidar::ouster {
namespace {

/// Skips white space and comments, then reads a number and removes it from `text`. Returns nothing
/// if no number follows.
std::optional<std::uint32_t> ReadNumber(ByteView* text) {
  std::size_t at = 0;
  bool comment = false;
  for (; at < text->size; ++at) {
    const char c = static_cast<char>(text->data[at]);
    if (c == '#') comment = true;
    if (c == '\n') comment = false;
    if (!comment && std::isspace(static_cast<unsigned char>(c)) == 0) break;
  }
  constexpr std::uint32_t kLimit = 1'000'000;
  std::uint32_t value = 0;
  const std::size_t first = at;
  for (; at < text->size && std::isdigit(text->data[at]) != 0 && value < kLimit; ++at)
    value = value * 10 + (text->data[at] - std::uint32_t{'0'});
  if (at == first) return std::nullopt;
  *text = text->Sub(at);
  return value;
}

}  // namespace

std::optional<PixelMask> ParseMaskImage(ByteView pgm, const Metadata& metadata,
                                        std::string* error) {
  const std::uint32_t beams = metadata.format.beams;
  const std::uint32_t columns = metadata.model.columns_per_scan;
  const std::size_t pixels = std::size_t{beams} * columns;
  ByteView rest = pgm.Sub(2);
  const bool is_pgm = pgm.size > 2 && pgm.data[0] == 'P' && pgm.data[1] == '5';
  const auto width = is_pgm ? ReadNumber(&rest) : std::nullopt;
  const auto height = width ? ReadNumber(&rest) : std::nullopt;
  const auto brightest = height ? ReadNumber(&rest) : std::nullopt;
  if (!brightest || *brightest == 0 || *brightest > 255) {
    *error = "the mask is not a binary PGM image with 8 bits a pixel";
    return std::nullopt;
  }
  rest = rest.Sub(1);  // skips the single white space that ends the header
  if (*width != columns || *height != beams || rest.size < pixels) {
    *error = "the mask must have " + std::to_string(columns) + " x " + std::to_string(beams) +
             " pixels, as the sensor's scans";
    return std::nullopt;
  }
  PixelMask mask(pixels);
  for (std::uint32_t beam = 0; beam < beams; ++beam) {
    const int shift = metadata.model.beams[beam].pixel_shift;
    for (std::uint32_t column = 0; column < columns; ++column) {
      const auto seen =
          (column + static_cast<std::uint32_t>(shift + static_cast<int>(columns))) % columns;
      mask[std::size_t{beam} * columns + column] = rest.data[std::size_t{beam} * columns + seen];
    }
  }
  return mask;
}

}  // namespace lidar::ouster
