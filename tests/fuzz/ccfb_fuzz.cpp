// SPDX-License-Identifier: LGPL-2.1-or-later
// Parses RTCP packets of both ends: feedback of RFC 8888, alone and in compound packets, and the
// sender's reports.
#include "src/rtcp/ccfb.h"
#include "src/rtcp/sender_report.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lidar::rtcp::CcfbParser parser;
  std::size_t total = 0;
  for (const auto& packet : lidar::rtcp::SplitRtcp({data, size})) {
    total += packet.size;
    const bool claims = lidar::rtcp::IsCcfb(packet);
    const auto feedback = parser.Parse(packet);
    FUZZ_CHECK(claims || !feedback);
    if (!feedback) continue;
    for (const auto reading :
         {lidar::rtcp::NumReports::kCount, lidar::rtcp::NumReports::kCountMinusOne}) {
      // Feedback that was parsed can be written again. The new packet is at most 4 bytes longer
      // than the old one.
      const auto again = lidar::rtcp::BuildCcfb(*feedback, reading);
      FUZZ_CHECK(again.size() <= packet.size + 4);
    }
  }
  FUZZ_CHECK(total == 0 || total == size);
  parser.Parse({data, size});
  const auto report = lidar::rtcp::ParseSenderReport({data, size});
  if (!report) return 0;
  FUZZ_CHECK(lidar::rtcp::HasSenderReport({data, size}));
  const auto bytes = lidar::rtcp::BuildSenderReport(*report);
  const auto again = lidar::rtcp::ParseSenderReport({bytes.data(), bytes.size()});
  FUZZ_CHECK(again && again->ssrc == report->ssrc && again->rtt == report->rtt &&
             again->target_bitrate == report->target_bitrate && again->ref_wnd == report->ref_wnd &&
             again->packets_dropped == report->packets_dropped);
  return 0;
}
