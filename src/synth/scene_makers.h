// SPDX-License-Identifier: LGPL-2.1-or-later
// The functions that make the scenes. Each is defined in a file of its own.
#pragma once
#include "src/synth/scene.h"

namespace lidar::synth {

std::unique_ptr<Scene> MakeStreet(std::uint64_t seed);
std::unique_ptr<Scene> MakeTunnel(std::uint64_t seed);
std::unique_ptr<Scene> MakeField(std::uint64_t seed);
std::unique_ptr<Scene> MakeTown(std::uint64_t seed);

}  // namespace lidar::synth
