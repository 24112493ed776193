// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/tx/sender_reports.h"

#include <algorithm>

#include "src/rtcp/sender_report.h"

namespace lidar::gst {
namespace {

// A report has 72 bytes. At this interval, the reports with all their headers need less than 10
// kbit/s, even if the property sets a shorter one.
constexpr Duration kMinInterval = std::chrono::milliseconds(100);

rtcp::SenderReport ReportOf(const scream::Statistics& s) {
  rtcp::SenderReport r;
  r.target_bitrate = s.target_bitrate;
  r.estimated_capacity = s.estimated_capacity;
  r.sent_bitrate = s.sent_bitrate;
  r.ref_wnd = s.ref_wnd;
  r.bytes_in_flight = s.bytes_in_flight;
  r.queue_delay = s.qdelay;
  r.rtt = s.s_rtt;
  r.sender_queue_delay = s.media_qdelay;
  r.packets_sent = static_cast<std::uint32_t>(s.packets_sent);
  r.packets_lost = static_cast<std::uint32_t>(s.packets_lost);
  r.packets_ce = static_cast<std::uint32_t>(s.packets_ce);
  r.packets_dropped = static_cast<std::uint32_t>(s.packets_dropped);
  return r;
}

std::uint32_t Milliseconds(Time time) {
  return static_cast<std::uint32_t>(time.time_since_epoch() / std::chrono::milliseconds(1));
}

}  // namespace

std::vector<std::uint8_t> SenderReports::Take(Duration interval, const TxStreams& streams,
                                              const scream::Controller& controller, Time now) {
  if (interval <= Duration{0}) return {};
  if (!last_) last_ = now;
  if (now - *last_ < std::max(interval, kMinInterval)) return {};
  const auto known = std::find_if(streams.begin(), streams.end(),
                                  [](const auto& stream) { return stream->ssrc.has_value(); });
  if (known == streams.end()) return {};
  last_ = now;
  rtcp::SenderReport report = ReportOf(controller.statistics(now));
  report.ssrc = *(*known)->ssrc;
  report.time_ms = Milliseconds(now);
  return rtcp::BuildSenderReport(report);
}

}  // namespace lidar::gst
