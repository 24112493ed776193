// SPDX-License-Identifier: LGPL-2.1-or-later
#include <string>

#include "src/link/capacity.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (const bool repeat : {false, true}) {
    std::string error;
    const auto capacity =
        lidar::link::Capacity::ParseTrace(lidar::fuzz::Text(data, size), repeat, &error);
    FUZZ_CHECK(capacity.has_value() == error.empty());
    if (!capacity) continue;
    lidar::Duration t{0};
    for (int i = 0; i < 20 && t < std::chrono::hours(10'000); ++i) {
      const auto rate = capacity->RateAt(t);
      FUZZ_CHECK(rate.bits_per_second() >= 0);
      const auto end = capacity->Finish(t, lidar::DataSize::Bytes(1'200));
      FUZZ_CHECK(end >= t);
      const auto next = capacity->NextChange(t);
      FUZZ_CHECK(next > t);
      t = next;
    }
  }
  return 0;
}
