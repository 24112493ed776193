// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/mixing/neighbours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

namespace lidar::codec::mixing {
namespace {

TEST(ALineThroughTwoReturns, GoesOnAsADivisionTells) {
  for (const std::int64_t near : {8, 24, 40, 1'000, 3'336, 100'008, 536'870'904}) {
    for (std::int64_t step = -3'000; step <= 3'000; ++step) {
      const std::int64_t far = near - step;
      const std::int64_t divisor = 2 * far - near;
      if (far < 8 || far > 536'870'904) continue;
      const std::int64_t met = divisor > 0 ? std::min(near * far / divisor, 2 * near) : near;
      ASSERT_EQ(Extrapolate(static_cast<std::int32_t>(near), static_cast<std::int32_t>(far)), met)
          << near << " after " << far;
    }
  }
}

}  // namespace
}  // namespace lidar::codec::mixing
