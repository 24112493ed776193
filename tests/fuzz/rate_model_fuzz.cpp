// SPDX-License-Identifier: LGPL-2.1-or-later
#include <cmath>
#include <string>

#include "src/rate/model_file.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string error;
  const auto file = lidar::rate::ParseModelFile(lidar::fuzz::Text(data, size), &error);
  FUZZ_CHECK(file.has_value() == error.empty());
  if (!file) return 0;
  for (const auto kind : {lidar::rate::RateModel::kAdaptive, lidar::rate::RateModel::kPaper}) {
    std::string reason;
    const auto model = lidar::rate::MakeModel(*file, kind, &reason);
    FUZZ_CHECK((model != nullptr) == reason.empty());
    if (model == nullptr) continue;
    lidar::rate::SliceFeatures slice;
    slice.returns = 10'000;
    slice.extent_m = 80;
    for (const char* mode : {"range-adaptive", "xyz-kd6"}) {
      slice.mode = mode;
      const lidar::rate::SettingLimits limits;
      const auto settings = model->Choose(slice, 20'000, limits);
      FUZZ_CHECK(std::isfinite(settings.step_m));
      FUZZ_CHECK(settings.step_m >= limits.finest_step_m &&
                 settings.step_m <= limits.coarsest_step_m);
      const auto predicted = model->Predict(slice, settings);
      FUZZ_CHECK(std::isfinite(predicted.total()) && predicted.total() >= 0);
      model->OnEncoded(slice, settings, {lidar::DataSize::Bytes(15'000), settings.step_m, 1});
      FUZZ_CHECK(std::isfinite(model->Predict(slice, settings).total()));
    }
  }
  return 0;
}
