// SPDX-License-Identifier: LGPL-2.1-or-later
#include <vector>

#include "src/rtp/stream_config.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using lidar::rtp::StreamConfig;
  const auto config = StreamConfig::Parse({data, size});
  if (!config) return 0;
  const auto bytes = config->Serialise();
  // A configuration with a named coder contains caps as text. Equal caps can be written in several
  // ways, so the bytes may differ.
  if (config->coder != lidar::rtp::Coder::kNamed)
    FUZZ_CHECK(bytes == std::vector<std::uint8_t>(data, data + size));
  FUZZ_CHECK(StreamConfig::Parse({bytes.data(), bytes.size()}) == config);
  return 0;
}
