// SPDX-License-Identifier: LGPL-2.1-or-later
// Transport-wide feedback, to packets that were sent.
#include "src/scream/feedback/ccfb.h"
#include "src/scream/feedback/twcc_mapper.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lidar::scream;
  TwccMapper mapper;
  for (unsigned i = 0; i < 300; ++i)
    mapper.OnSent(static_cast<std::uint16_t>(i), 1 + i % 2, static_cast<std::uint16_t>(i / 2));
  for (const auto& packet : SplitRtcp({data, size})) {
    const auto feedback = ParseTwcc(packet);
    FUZZ_CHECK(IsTwcc(packet) || !feedback);
    if (!feedback) continue;
    FUZZ_CHECK(feedback->arrivals.size() <= kMaxTwccPackets);
    // What was understood can be said again.
    const auto again = BuildTwcc(*feedback);
    if (again) {
      const auto parsed = ParseTwcc({again->data(), again->size()});
      FUZZ_CHECK(parsed && parsed->arrivals.size() == feedback->arrivals.size());
    }
    const auto report = mapper.Map(*feedback);
    if (!report) continue;
    std::size_t metrics = 0;
    for (const auto& block : report->blocks) metrics += block.metrics.size();
    FUZZ_CHECK(metrics <= feedback->arrivals.size() && metrics <= 300);
  }
  return 0;
}
