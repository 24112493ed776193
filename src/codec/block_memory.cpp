// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/block_memory.h"

#include <algorithm>
#include <cstdlib>

namespace lidar::codec {

void PixelMemory::See(std::uint32_t range_mm, std::int64_t step) {
  returns = static_cast<std::uint8_t>(returns << 1 | (range_mm != 0 ? 1 : 0));
  if (range_mm == 0) return;
  constexpr std::int64_t kMostSpread = UINT16_MAX;
  const std::int64_t value = std::int64_t{range_mm} * kPerMm;
  const std::int64_t apart = value - mean;
  if (count == 0 || std::abs(apart) > 2 * step + 4 * std::int64_t{spread}) {
    mean = static_cast<std::uint32_t>(value);
    spread = static_cast<std::uint16_t>(std::min(step / 4, kMostSpread));
    count = 1;
    return;
  }
  count = std::min<std::uint8_t>(static_cast<std::uint8_t>(count + 1), kMostCount);
  mean = static_cast<std::uint32_t>(mean + apart / count);
  const std::int64_t away = std::min(std::abs(apart), kMostSpread);
  spread = static_cast<std::uint16_t>(spread + (away - spread) / std::min<int>(count, 8));
}

std::shared_ptr<BlockMemory> Remember(const RangeImage& image, const RangeGrid& grid,
                                      const BlockMemory* before) {
  auto memory =
      before != nullptr ? std::make_shared<BlockMemory>(*before) : std::make_shared<BlockMemory>();
  if (before == nullptr) {
    memory->beams = image.beams;
    memory->columns = image.columns;
    memory->first_column = image.first_column;
    memory->pixels.resize(image.size());
    memory->model.Reset();
  }
  const std::int64_t step = StepOf(grid);
  for (std::size_t i = 0; i < image.size(); ++i) memory->pixels[i].See(image.ranges[i], step);
  return memory;
}

}  // namespace lidar::codec
