// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads data that a client may send to foxglovesink: WebSocket frames, and the requests in them.
#include "src/foxglove/protocol.h"
#include "src/foxglove/websocket.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kMax = 4096;
  constexpr std::size_t kPart = 97;  // bytes per read from the socket
  lidar::foxglove::MessageReader reader(kMax);
  const lidar::ByteView all{data, size};
  for (std::size_t at = 0; at < size; at += kPart) {
    reader.Append(all.Sub(at, kPart));
    while (const auto message = reader.Next()) {
      FUZZ_CHECK(message->payload.size() <= kMax);
      const auto request = lidar::foxglove::ParseRequest(
          {reinterpret_cast<const char*>(message->payload.data()), message->payload.size()});
      FUZZ_CHECK(request.error.empty() ==
                 (request.kind != lidar::foxglove::Request::Kind::kMalformed));
    }
    if (reader.error()) break;
  }
  return 0;
}
