// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/mixing/arithmetic.h"

namespace lidar::codec::mixing {
namespace {

/// The logistic function at every eighth of a nat from -8 to 8, in 1/65536.
constexpr std::array<std::uint16_t, 129> kLogistic = {
    22,    25,    28,    32,    36,    41,    47,    53,    60,    68,    77,    87,    98,
    111,   126,   143,   162,   184,   208,   236,   267,   302,   342,   387,   439,   497,
    562,   636,   720,   815,   922,   1042,  1179,  1333,  1506,  1701,  1921,  2168,  2446,
    2758,  3108,  3500,  3938,  4427,  4971,  5577,  6249,  6992,  7812,  8714,  9702,  10782,
    11955, 13226, 14595, 16062, 17625, 19282, 21025, 22849, 24743, 26695, 28693, 30723, 32768,
    34813, 36843, 38841, 40793, 42687, 44511, 46254, 47911, 49474, 50941, 52310, 53581, 54754,
    55834, 56822, 57724, 58544, 59287, 59959, 60565, 61109, 61598, 62036, 62428, 62778, 63090,
    63368, 63615, 63835, 64030, 64203, 64357, 64494, 64614, 64721, 64816, 64900, 64974, 65039,
    65097, 65149, 65194, 65234, 65269, 65300, 65328, 65352, 65374, 65393, 65410, 65425, 65438,
    65449, 65459, 65468, 65476, 65483, 65489, 65495, 65500, 65504, 65508, 65511, 65514};

/// 65536 ln(1 + i / 64).
constexpr std::array<std::uint32_t, 65> kLog = {
    0,     1016,  2017,  3002,  3973,  4930,  5873,  6802,  7719,  8623,  9515,  10394, 11262,
    12119, 12965, 13800, 14624, 15438, 16242, 17037, 17821, 18597, 19364, 20121, 20870, 21611,
    22343, 23067, 23783, 24492, 25193, 25886, 26573, 27252, 27924, 28589, 29248, 29900, 30546,
    31185, 31818, 32445, 33067, 33682, 34292, 34896, 35494, 36087, 36675, 37258, 37835, 38407,
    38975, 39537, 40095, 40648, 41196, 41740, 42280, 42815, 43345, 43872, 44394, 44912, 45426};

/// Returns the value at `at` by linear interpolation. Entry i of `table` is the value at i *
/// 2^shift.
template <class Table>
constexpr std::uint32_t Interpolate(const Table& table, std::uint32_t at, unsigned shift) {
  const std::size_t i = at >> shift;
  const std::uint32_t part = at & ((1U << shift) - 1);
  return table[i] + (((table[i + 1] - table[i] + 0U) * part + (1U << (shift - 1))) >> shift);
}

}  // namespace

constexpr Tables::Tables() {
  for (std::uint32_t i = 0; i < chance.size(); ++i)
    chance[i] = static_cast<std::uint16_t>(Interpolate(kLogistic, i, 5));
  std::int32_t x = -kMostLogit;
  for (std::int32_t i = 0; i < 4'096; ++i) {
    while (x < kMostLogit && chance[static_cast<std::size_t>(x + 2'048)] < 16 * i + 8) ++x;
    logit[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(x);
  }
  for (std::uint32_t i = 0; i < log_mantissa.size(); ++i)
    log_mantissa[i] = static_cast<std::uint16_t>(Interpolate(kLog, i, 2) >> 8);
}

const Tables kTables;

}  // namespace lidar::codec::mixing
