// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/initial_models.h"

namespace lidar::codec {
namespace {

using Counts = std::array<std::uint16_t, kNibbles>;

// Frequencies in a thousand, over OS0 and OS1 captures at errors of 1 mm to 5 cm. They are part of
// the format.
constexpr std::array<Counts, kContexts> kValues = {
    {{{687, 64, 122, 9, 17, 6, 18, 3, 19, 2, 15, 2, 9, 13, 14, 1}},
     {{684, 109, 155, 5, 9, 2, 6, 1, 6, 1, 6, 1, 6, 3, 8, 1}},
     {{671, 131, 111, 12, 16, 8, 9, 4, 7, 2, 7, 2, 6, 5, 10, 1}},
     {{670, 123, 155, 9, 11, 2, 4, 1, 4, 1, 4, 1, 5, 3, 8, 1}},
     {{584, 187, 156, 20, 16, 6, 7, 3, 3, 1, 3, 1, 3, 3, 8, 1}},
     {{507, 223, 173, 34, 25, 9, 9, 3, 3, 1, 2, 1, 2, 3, 6, 1}},
     {{451, 230, 170, 55, 38, 18, 16, 5, 5, 2, 2, 1, 2, 3, 5, 1}},
     {{389, 219, 166, 74, 50, 36, 28, 8, 11, 3, 4, 2, 2, 4, 4, 1}},
     {{341, 206, 153, 80, 57, 58, 41, 22, 18, 5, 7, 2, 2, 5, 4, 1}},
     {{283, 184, 140, 81, 61, 70, 52, 42, 31, 13, 16, 4, 10, 6, 6, 1}},
     {{266, 165, 126, 76, 55, 69, 55, 54, 36, 29, 24, 8, 14, 9, 11, 1}},
     {{238, 150, 117, 70, 51, 70, 54, 54, 41, 45, 31, 19, 22, 13, 25, 1}},
     {{228, 133, 115, 61, 47, 64, 47, 51, 41, 46, 31, 39, 36, 28, 34, 1}},
     {{218, 120, 107, 58, 46, 56, 42, 50, 36, 42, 32, 56, 34, 44, 59, 1}},
     {{176, 92, 100, 43, 45, 43, 42, 37, 33, 29, 26, 30, 22, 162, 120, 1}}}};
constexpr Counts kLongValues = {{14, 12, 24, 46, 77, 114, 155, 185, 148, 114, 69, 27, 11, 3, 1, 1}};
constexpr std::array<Counts, kContexts> kLevels = {
    {{{888, 52, 37, 6, 5, 3, 2, 2, 2, 1, 1, 1, 1, 1, 1, 1}},
     {{641, 119, 202, 13, 15, 4, 3, 1, 1, 1, 1, 1, 1, 1, 1, 1}},
     {{609, 161, 152, 24, 22, 10, 10, 5, 3, 2, 1, 1, 1, 1, 1, 1}},
     {{506, 148, 270, 23, 33, 7, 7, 3, 1, 1, 1, 1, 1, 1, 1, 1}},
     {{423, 262, 191, 46, 40, 15, 13, 5, 3, 2, 1, 1, 1, 1, 1, 1}},
     {{385, 232, 198, 65, 60, 22, 21, 6, 5, 2, 1, 1, 1, 1, 1, 1}},
     {{308, 215, 183, 101, 74, 46, 40, 12, 12, 3, 3, 1, 1, 1, 1, 1}},
     {{238, 176, 149, 112, 85, 90, 70, 31, 32, 6, 8, 1, 1, 1, 1, 1}},
     {{192, 142, 123, 96, 78, 124, 87, 62, 58, 14, 17, 3, 3, 1, 1, 1}},
     {{172, 100, 97, 78, 68, 115, 90, 106, 83, 29, 43, 6, 10, 1, 1, 1}},
     {{133, 85, 80, 64, 59, 97, 85, 122, 96, 71, 72, 12, 20, 2, 1, 1}},
     {{113, 66, 67, 54, 49, 87, 78, 118, 100, 120, 81, 32, 30, 3, 4, 1}},
     {{101, 59, 61, 48, 44, 72, 63, 103, 91, 134, 88, 71, 48, 6, 10, 1}},
     {{77, 52, 50, 42, 34, 61, 51, 98, 79, 126, 98, 128, 65, 14, 25, 1}},
     {{74, 45, 42, 33, 30, 52, 44, 63, 60, 87, 67, 99, 61, 146, 99, 1}}}};
constexpr Counts kLongLevels = {{43, 42, 73, 100, 145, 153, 188, 169, 87, 1, 1, 1, 1, 1, 1, 1}};

std::array<NibbleModel, kContexts> ModelsOf(const std::array<Counts, kContexts>& counts) {
  std::array<NibbleModel, kContexts> models;
  for (std::size_t i = 0; i < counts.size(); ++i) models[i] = NibbleModel(counts[i]);
  return models;
}

}  // namespace

const InitialModels& InitialModelsOfValues() {
  static const InitialModels models{ModelsOf(kValues), NibbleModel(kLongValues)};
  return models;
}

const InitialModels& InitialModelsOfLevels() {
  static const InitialModels models{ModelsOf(kLevels), NibbleModel(kLongLevels)};
  return models;
}

}  // namespace lidar::codec
