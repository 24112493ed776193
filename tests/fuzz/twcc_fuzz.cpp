// SPDX-License-Identifier: LGPL-2.1-or-later
// Maps transport-wide feedback to the packets that were sent.
#include "src/base/byte_reader.h"
#include "src/rtcp/twcc_mapper.h"
#include "tests/fuzz/fuzz.h"

// The input has the base number in 2 bytes. For each packet that follows it has the arrival time in
// 4 bytes, in ticks of 250 us. A time of 0 means that the packet did not arrive.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lidar::rtcp;
  TwccMapper mapper;
  for (unsigned i = 0; i < 300; ++i)
    mapper.OnSent(static_cast<std::uint16_t>(i), 1 + i % 2, static_cast<std::uint16_t>(i / 2));
  lidar::ByteReader reader(lidar::ByteView{data, size});
  TwccFeedback feedback;
  feedback.base_number = reader.Be16();
  while (reader.remaining() >= 4 && feedback.arrivals.size() < kMaxTwccPackets) {
    const std::uint32_t ticks = reader.Be32();
    feedback.arrivals.emplace_back();
    if (ticks > 0) feedback.arrivals.back() = std::chrono::microseconds(250) * std::int64_t{ticks};
  }
  const auto report = mapper.Map(feedback);
  if (!report) return 0;
  std::size_t metrics = 0;
  for (const auto& block : report->blocks) metrics += block.metrics.size();
  FUZZ_CHECK(metrics <= feedback.arrivals.size() && metrics <= 300);
  return 0;
}
