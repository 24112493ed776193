// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads capture files with PcapReader, which uses libpcap. Reads each file twice, if it can be
// rewound.
#include <sys/mman.h>
#include <unistd.h>

#include <string>

#include "src/ouster/pcap_reader.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const int fd = memfd_create("capture", MFD_CLOEXEC);
  FUZZ_CHECK(fd >= 0 && write(fd, data, size) == static_cast<ssize_t>(size));
  const std::string path = "/proc/self/fd/" + std::to_string(fd);
  std::string error;
  const auto reader = lidar::ouster::PcapReader::Open(path, &error);
  FUZZ_CHECK((reader != nullptr) == error.empty());
  for (int pass = 0; reader != nullptr && pass < 2; ++pass) {
    while (const auto captured = reader->Next())
      FUZZ_CHECK(captured->datagram.payload.size() <= 65'535);
    if (!reader->Rewind()) break;
  }
  close(fd);
  return 0;
}
