// SPDX-License-Identifier: LGPL-2.1-or-later
#include <cmath>
#include <vector>

#include "src/cloud/range_projection.h"
#include "src/cloud/sensor_model.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto model = lidar::SensorModel::Parse({data, size});
  if (!model) return 0;
  FUZZ_CHECK(lidar::SensorModel::Parse({data, size})->Serialise() == model->Serialise());
  const lidar::RangeProjection projection(*model);
  for (const std::uint32_t column : {0U, model->columns_per_scan - 1}) {
    const auto beam = static_cast<std::uint32_t>(model->beams.size() - 1);
    const auto p = projection.Point(beam, column, 1'000'000);
    for (const float v : p) FUZZ_CHECK(std::isfinite(v));
    FUZZ_CHECK(std::isfinite(projection.RangeOf(beam, column, p.data())));
  }
  return 0;
}
