// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/lidar_link/recorder.h"

#include <cinttypes>
#include <cstdio>

namespace lidar::tools {
namespace {

const char* Name(link::Fate fate) {
  switch (fate) {
    case link::Fate::kDelivered:
      return "delivered";
    case link::Fate::kLost:
      return "lost";
    case link::Fate::kQueueFull:
      return "queue-full";
    case link::Fate::kAqmDropped:
      break;
  }
  return "aqm-dropped";
}

struct RtpHeader {
  std::int64_t sequence = -1;  // -1: not RTP
  std::int64_t timestamp = -1;
  int marker = 0;
};

RtpHeader ParseRtp(ByteView payload) {
  ByteReader r(payload);
  const auto flags = r.U8();
  const auto type = r.U8();
  const auto sequence = r.Be16();
  const auto timestamp = r.Be32();
  constexpr std::size_t kHeader = 12;
  if (payload.size < kHeader || flags >> 6 != 2) return {};
  return {sequence, timestamp, type >> 7};
}

double Bps(std::uint64_t bytes, double seconds) {
  return seconds > 0 ? static_cast<double>(bytes) * 8 / seconds : 0;
}

nlohmann::ordered_json Percentiles(const Distribution& d) {
  return {{"p50", d.Percentile(50)},
          {"p95", d.Percentile(95)},
          {"p99", d.Percentile(99)},
          {"max", d.Max()}};
}

nlohmann::ordered_json EcnCounts(const std::array<std::uint64_t, 4>& n) {
  return {{"not_ect", n[0]}, {"ect1", n[1]}, {"ect0", n[2]}, {"ce", n[3]}};
}

}  // namespace

Recorder::Recorder(const std::string& log) : log_(log, OutputFile::Rest::kKeepRows) {
  log_.stream()
      << "time_s,unix_ns,flow,size,rtp_seq,rtp_timestamp,marker,ecn_in,ecn_out,fate,sojourn_ms,"
         "delay_ms\n";
}

void Recorder::Start(Time origin, Duration unix_offset) {
  origin_ = origin;
  live_since_ = origin;
  unix_offset_ = unix_offset;
}

void Recorder::OnPacket(const PacketRecord& record) {
  const link::Outcome& o = record.outcome;
  if (o.duplicate) return;
  if (flows_.size() <= record.flow) flows_.resize(record.flow + 1);
  Counts& flow = flows_[record.flow];
  const auto bytes = static_cast<std::uint64_t>(o.packet.size.bytes());
  const bool marked = o.packet.ecn == Ecn::kCe && record.ecn_in != Ecn::kCe;
  for (Counts* c : {&flow, &live_}) {
    c->packets += o.delivered();
    c->bytes += o.delivered() ? bytes : 0;
    c->dropped += !o.delivered();
    c->marked += marked;
  }
  ++ecn_in_[static_cast<std::size_t>(record.ecn_in)];
  if (o.delivered()) {
    ++ecn_out_[static_cast<std::size_t>(o.packet.ecn)];
    sojourn_.Add(Milliseconds(o.sojourn));
    live_sojourn_.Add(Milliseconds(o.sojourn));
  }
  if (!log_.is_open()) return;
  const RtpHeader rtp = ParseRtp(record.payload);
  char line[256];
  const int n = std::snprintf(
      line, sizeof line,
      "%.6f,%" PRId64 ",%zu,%" PRIu64 ",%" PRId64 ",%" PRId64 ",%d,%d,%d,%s,%.4f,%.4f\n",
      Seconds(o.sent - origin_), (o.sent.time_since_epoch() + unix_offset_).count(), record.flow,
      bytes, rtp.sequence, rtp.timestamp, rtp.marker, static_cast<int>(record.ecn_in),
      static_cast<int>(o.packet.ecn), Name(o.fate), Milliseconds(o.sojourn),
      Milliseconds(o.arrival - o.sent));
  log_.stream().write(line, n);
}

void Recorder::OnFeedback(bool delivered, std::size_t bytes) {
  feedback_packets_ += delivered;
  feedback_bytes_ += delivered ? bytes : 0;
  feedback_lost_ += !delivered;
}

nlohmann::ordered_json Recorder::Live(Time now, const link::Bottleneck& there,
                                      const link::Capacity& capacity) {
  const double seconds = Seconds(now - live_since_);
  nlohmann::ordered_json line{
      {"time_s", Seconds(now - origin_)},
      {"origin_unix_ns", (origin_.time_since_epoch() + unix_offset_).count()},
      {"capacity_bps", capacity.Between(live_since_ - origin_, now - origin_).bits() / seconds},
      {"delivered_bps", Bps(live_.bytes, seconds)},
      {"packets", live_.packets},
      {"marked", live_.marked},
      {"dropped", live_.dropped},
      {"queue_bytes", there.queued().bytes()},
      {"sojourn_ms", Percentiles(live_sojourn_)}};
  live_since_ = now;
  live_ = {};
  live_sojourn_.Clear();
  return line;
}

nlohmann::ordered_json Recorder::Summary(Time now, const link::Bottleneck* there,
                                         const link::Capacity& capacity) const {
  nlohmann::ordered_json summary;
  const bool started = there != nullptr;
  const Duration ran = started ? now - origin_ : Duration{0};
  const link::BottleneckStats stats = started ? there->stats() : link::BottleneckStats{};
  const double offered = capacity.Between(Duration{0}, ran).bits();
  summary["origin_unix_ns"] = started ? (origin_.time_since_epoch() + unix_offset_).count() : 0;
  summary["duration_s"] = Seconds(ran);
  summary["packets"] = stats.sent;
  summary["delivered"] = stats.delivered;
  summary["delivered_bytes"] = stats.delivered_size.bytes();
  summary["random_loss"] = stats.lost;
  summary["queue_full"] = stats.queue_full;
  summary["aqm_dropped"] = stats.aqm_dropped;
  summary["marked"] = stats.marked;
  summary["duplicated"] = stats.duplicated;
  summary["mean_rate_bps"] = ran > Duration{0} ? stats.delivered_size.bits() / Seconds(ran) : 0;
  summary["mean_capacity_bps"] = ran > Duration{0} ? offered / Seconds(ran) : 0;
  summary["utilisation"] = offered > 0 ? stats.delivered_size.bits() / offered : 0;
  summary["sojourn_ms"] = Percentiles(sojourn_);
  summary["ecn_in"] = EcnCounts(ecn_in_);
  summary["ecn_out"] = EcnCounts(ecn_out_);
  for (const Counts& f : flows_)
    summary["flows"].push_back({{"delivered", f.packets},
                                {"bytes", f.bytes},
                                {"dropped", f.dropped},
                                {"marked", f.marked},
                                {"mean_rate_bps", Bps(f.bytes, Seconds(ran))}});
  summary["feedback"] = {
      {"packets", feedback_packets_}, {"bytes", feedback_bytes_}, {"lost", feedback_lost_}};
  summary["refused_sends"] = refused_sends_;
  summary["lateness_ms"] = Percentiles(lateness_);
  return summary;
}

}  // namespace lidar::tools
