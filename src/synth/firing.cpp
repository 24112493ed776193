// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/synth/firing.h"

namespace lidar::synth {
namespace {

constexpr DriverLayout kVelodyne = {
    "x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,ring:U16:16,time:F32:18", 1};
constexpr DriverLayout kHesai = {
    "x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,ring:U16:16,timestamp:F64:18", 1};
constexpr DriverLayout kLivox = {
    "x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,tag:U8:16,line:U8:17,timestamp:F64:18", 1e-9};

// The values follow the user manuals of the VLP-16 (63-9243), the Pandar XT32, the AT128 and the
// Mid-360. The makers publish neither how the AT128's mirrors bend its beams, nor the path of the
// Mid-360's beams. So the bend is a guess. The path has the turns, swings and fan of a recorded
// path (mid180.csv of github.com/sara-sliprobotics/Mid360_simulation_plugin).
constexpr Firing kFirings[] = {
    {"vlp-16", 16, 2, -15, 2, 0, 2304, 1808, 0, 360, 1, 0, 0, 0, 0.01, 2, 0.5, 100, 50, kVelodyne},
    {"xt32", 32, 1, 15, -1, 0, 1512, 2000, 0, 360, 1, 0, 0, 0, 0.01, 4, 0.05, 120, 80, kHesai},
    {"at128", 128, 4,   12.5, -0.2, 1.25, 0,   1200, -60, 120,
     1,       0.3, 0.5, 0,    0.01, 4,    0.5, 200,  180, kHesai},
    {"mid-360", 4,    1,     22.3, 0, 0, 5000, 5000, 0,  360,
     17.75,     25.7, 1.014, 1.9,  0, 1, 0.1,  70,   40, kLivox}};

}  // namespace

const Firing* FindFiring(std::string_view name) {
  for (const Firing& firing : kFirings)
    if (firing.name == name) return &firing;
  return nullptr;
}

}  // namespace lidar::synth
