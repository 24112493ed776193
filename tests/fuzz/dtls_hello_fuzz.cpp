// SPDX-License-Identifier: LGPL-2.1-or-later
// Checks which datagrams are recognised as the beginning of a DTLS handshake. Any host can send
// such datagrams to a DTLS server.
#include <string>
#include <vector>

#include "gst/scream/srtp/dtls_hello.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using lidar::gst::HelloIn;
  using lidar::gst::IsOfHello;
  constexpr std::size_t kRecordHeader = 13, kHandshakeHeader = 12;
  constexpr std::size_t kFragmentOffset = kRecordHeader + 6;
  const std::string hello = HelloIn({data, size});
  if (!IsOfHello({data, size})) {
    FUZZ_CHECK(hello.empty());
    return 0;
  }
  FUZZ_CHECK(size >= kRecordHeader + kHandshakeHeader && data[0] == 22 && data[kRecordHeader] == 1);
  const std::size_t length = std::size_t{data[11]} << 8 | data[12];
  FUZZ_CHECK(length >= kHandshakeHeader && size >= kRecordHeader + length);
  const bool begins = data[kFragmentOffset] == 0 && data[kFragmentOffset + 1] == 0 &&
                      data[kFragmentOffset + 2] == 0;
  FUZZ_CHECK(hello.size() == (begins ? length : 0));
  // A record that is cut off is not accepted.
  FUZZ_CHECK(!IsOfHello({data, kRecordHeader + length - 1}));
  // Bytes after the record do not change the result.
  FUZZ_CHECK(HelloIn({data, kRecordHeader + length}) == hello);
  std::vector<std::uint8_t> other(data, data + size);
  for (std::size_t at = 5; at < 11; ++at) other[at] ^= 0xFF;
  // A repeated hello has another sequence number, and gives the same result.
  FUZZ_CHECK(HelloIn({other.data(), other.size()}) == hello);
  for (const std::size_t epoch : {3U, 4U}) {
    other[epoch] = 1;
    FUZZ_CHECK(!IsOfHello({other.data(), other.size()}));
    other[epoch] = 0;
  }
  return 0;
}
