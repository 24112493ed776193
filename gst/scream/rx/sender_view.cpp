// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/rx/sender_view.h"

#include <array>

#include "gst/common/stats.h"

namespace lidar::gst {
namespace {

// A report that is not newer than the last one is accepted if no report has arrived for this time,
// because the sender may have another clock.
constexpr Duration kClockKept = std::chrono::seconds(10);

struct Shown {
  rtcp::SenderReport newest;
  guint64 reports = 0;
  Duration age{};
};
template <auto field>
constexpr auto N = At<&Shown::newest, field>;

}  // namespace

void SenderView::OnReport(Time now, const rtcp::SenderReport& report) {
  const auto ahead = static_cast<std::int32_t>(report.time_ms - newest_.time_ms);
  const bool same_clock = report.ssrc == newest_.ssrc && now - arrived_ < kClockKept;
  if (reports_ > 0 && same_clock && ahead <= 0) return;
  newest_ = report;
  arrived_ = now;
  ++reports_;
}

void SenderView::AddStats(Time now, GstStructure* stats) const {
  using R = rtcp::SenderReport;
  static const std::array<Stat<Shown>, 14> kStats = {{
      {"sender-reports", &Shown::reports},
      {"sender-report-age", &Shown::age},
      {"sender-target-bitrate", N<&R::target_bitrate>},
      {"sender-estimated-capacity", N<&R::estimated_capacity>},
      {"sender-sent-bitrate", N<&R::sent_bitrate>},
      {"sender-ref-wnd", N<&R::ref_wnd>},
      {"sender-bytes-in-flight", N<&R::bytes_in_flight>},
      {"sender-queue-delay", N<&R::queue_delay>},
      {"sender-rtt", N<&R::rtt>},
      {"sender-own-queue-delay", N<&R::sender_queue_delay>},
      {"sender-packets-sent", N<&R::packets_sent>},
      {"sender-packets-lost", N<&R::packets_lost>},
      {"sender-packets-ce", N<&R::packets_ce>},
      {"sender-packets-dropped", N<&R::packets_dropped>},
  }};
  const Shown shown{newest_, reports_, reports_ > 0 ? now - arrived_ : Duration{0}};
  gst::AddStats(stats, kStats, shown);
}

}  // namespace lidar::gst
