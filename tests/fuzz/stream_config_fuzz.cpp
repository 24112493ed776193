// SPDX-License-Identifier: LGPL-2.1-or-later
#include <vector>

#include "src/rtp/stream_config.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto config = lidar::rtp::StreamConfig::Parse({data, size});
  if (config) FUZZ_CHECK(config->Serialise() == std::vector<std::uint8_t>(data, data + size));
  return 0;
}
