// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/scream_bench/receiver.h"

#include <gst/rtp/gstrtpbuffer.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "gst/lidar/gstlidar.h"
#include "src/base/sequence.h"
#include "src/base/time.h"
#include "src/base/units.h"
#include "src/tools/bench/scream_bench/frame_source.h"
#include "src/tools/bench/scream_bench/pipeline.h"
#include "src/tools/common/distribution.h"
#include "src/tools/common/output_file.h"
#include "src/tools/common/udp_socket.h"

namespace lidar::tools {
namespace {

/// If the first frame is older than this, the sender's RTP timestamps are not Unix time.
constexpr Duration kPlausibleAge = std::chrono::seconds{60};

Duration FromTicks(std::int32_t ticks) {
  return std::chrono::nanoseconds{std::int64_t{ticks} * 1'000'000'000 /
                                  FramePacketizer::kClockRate};
}

struct ReceivedPacket {
  std::uint16_t sequence = 0;
  std::uint32_t timestamp = 0;  // 90 kHz
  bool marker = false;
  bool is_ce = false;
  DataSize size;          // size on the wire
  Duration unix_time{0};  // time of arrival
};

/// Measures the ages of frames. The age is the time from a frame's creation to the arrival of its
/// last packet.
class FrameMeter {
 public:
  /// Returns the age of the frame if this is its last packet, and otherwise nothing.
  std::optional<Duration> OnPacket(const ReceivedPacket& packet);

  std::uint64_t packets() const { return packets_; }
  std::uint64_t ce_packets() const { return ce_packets_; }
  DataSize received() const { return received_; }
  /// Returns the number of missing packets between the oldest and the newest received packet.
  std::uint64_t lost() const;
  std::uint64_t frames() const { return ages_ms_.count(); }
  /// Returns true if the sender's clock differs from the receiver's clock. Ages are then relative
  /// to the smallest age.
  bool is_relative() const { return offset_ != Duration{0}; }
  const Distribution& ages_ms() const { return ages_ms_; }

 private:
  SequenceUnwrapper<std::uint16_t> sequence_;
  std::optional<std::int64_t> first_sequence_;
  std::uint64_t packets_ = 0;
  std::uint64_t ce_packets_ = 0;
  DataSize received_;
  Duration offset_{0};
  Distribution ages_ms_;
};

std::optional<Duration> FrameMeter::OnPacket(const ReceivedPacket& packet) {
  const std::int64_t sequence = sequence_.Unwrap(packet.sequence);
  first_sequence_ = std::min(first_sequence_.value_or(sequence), sequence);
  ++packets_;
  ce_packets_ += packet.is_ce;
  received_ += packet.size;
  if (!packet.marker) return std::nullopt;
  Duration age =
      FromTicks(SequenceDistance(RtpTimestamp(packet.unix_time), packet.timestamp)) - offset_;
  const bool differs = frames() == 0 && (age < Duration{0} || age > kPlausibleAge);
  const bool is_youngest = is_relative() && age < Duration{0};
  if (differs || is_youngest) {
    offset_ += age;
    age = Duration{0};
  }
  age = std::max(Duration{0}, age);
  ages_ms_.Add(Milliseconds(age));
  return age;
}

std::uint64_t FrameMeter::lost() const {
  if (!first_sequence_) return 0;
  const auto expected = static_cast<std::uint64_t>(*sequence_.newest() - *first_sequence_ + 1);
  return expected > packets_ ? expected - packets_ : 0;
}

constexpr DataSize kIpUdp = DataSize::Bytes(28);
constexpr const char* kCaps =
    "application/x-rtp,media=application,encoding-name=X-SCREAM-BENCH,clock-rate=90000";

/// Parses HOST:PORT. Throws std::runtime_error if the text is wrong.
std::pair<std::string, gint> ParseFeedback(const std::string& text) {
  const HostPort to = Split(text, "");
  guint64 port = 0;
  if (to.host.empty() || !g_ascii_string_to_unsigned(to.port.c_str(), 10, 1, 65535, &port, nullptr))
    throw std::runtime_error("--feedback must be HOST:PORT");
  return {to.host, static_cast<gint>(port)};
}

class Receiver {
 public:
  explicit Receiver(const BenchOptions& options);
  ~Receiver() { gst_element_set_state(pipeline_.get(), GST_STATE_NULL); }
  int Run();

 private:
  void Build();
  void OnBuffer(GstBuffer* buffer);
  void Tick();
  void PrintLine(Duration now);
  void Finish();

  const BenchOptions& options_;
  gst::ElementPtr pipeline_;
  OutputFile log_;
  std::mutex mutex_;  // guards the members below, which the streaming thread writes
  FrameMeter meter_;
  Distribution second_;  // ages of the frames since the last line [ms]
  DataSize line_bytes_;
  Duration first_{0};
  Duration last_{0};
  Duration line_since_{0};
};

Receiver::Receiver(const BenchOptions& options)
    : options_(options), log_(options.rx.log, OutputFile::Rest::kKeepRows) {
  log_.stream() << "time_s,rtp_timestamp,frame_age_ms\n";
  Build();
}

/// Makes the pipeline. It contains screamsrc. If feedback goes to another address, it contains the
/// elements of which screamsrc consists.
void Receiver::Build() {
  pipeline_.reset(GST_ELEMENT(gst_object_ref_sink(gst_pipeline_new("scream-bench-rx"))));
  const BenchRxOptions& o = options_.rx;
  GstElement* bin = pipeline_.get();
  GstElement* source = AddElement(bin, o.feedback.empty() ? "screamsrc" : "ecnudpsrc", "source");
  g_object_set(source, "port", static_cast<gint>(o.port), nullptr);
  if (!o.address.empty()) g_object_set(source, "address", o.address.c_str(), nullptr);
  const gst::CapsPtr caps(gst_caps_from_string(kCaps));
  g_object_set(source, "caps", caps.get(), nullptr);
  GstElement* sink = AddElement(bin, "fakesink", "sink");
  g_object_set(sink, "sync", FALSE, "async", FALSE, nullptr);
  if (o.feedback.empty()) {
    gst_util_set_object_arg(G_OBJECT(source), "num-reports", o.num_reports.c_str());
    LinkPads(source, "src", sink, "sink");
  } else {
    const auto [host, port] = ParseFeedback(o.feedback);
    GstElement* rx = AddElement(bin, "screamrx", "screamrx");
    gst_util_set_object_arg(G_OBJECT(rx), "num-reports", o.num_reports.c_str());
    GstElement* back = AddElement(bin, "ecnudpsink", "feedback");
    g_object_set(back, "host", host.c_str(), "port", port, "sync", FALSE, "async", FALSE, nullptr);
    // Only EOS of the media ends the run.
    GST_OBJECT_FLAGS(back) &= ~guint32{GST_ELEMENT_FLAG_SINK};
    LinkPads(source, "src", rx, "sink");
    LinkPads(rx, "src", sink, "sink");
    LinkPads(rx, "rtcp_src", back, "sink");
  }
  const gst::PadPtr pad(gst_element_get_static_pad(sink, "sink"));
  gst_pad_add_probe(
      pad.get(),
      static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_BUFFER_LIST),
      [](GstPad*, GstPadProbeInfo* info, gpointer data) -> GstPadProbeReturn {
        auto* self = static_cast<Receiver*>(data);
        if (GstBuffer* buffer = GST_PAD_PROBE_INFO_BUFFER(info);
            (info->type & GST_PAD_PROBE_TYPE_BUFFER) != 0) {
          self->OnBuffer(buffer);
        } else {
          GstBufferList* list = GST_PAD_PROBE_INFO_BUFFER_LIST(info);
          for (guint i = 0; i < gst_buffer_list_length(list); ++i)
            self->OnBuffer(gst_buffer_list_get(list, i));
        }
        return GST_PAD_PROBE_OK;
      },
      this, nullptr);
}

void Receiver::OnBuffer(GstBuffer* buffer) {
  GstRTPBuffer rtp = GST_RTP_BUFFER_INIT;
  if (!gst_rtp_buffer_map(buffer, GST_MAP_READ, &rtp)) return;
  ReceivedPacket packet;
  packet.sequence = gst_rtp_buffer_get_seq(&rtp);
  packet.timestamp = gst_rtp_buffer_get_timestamp(&rtp);
  packet.marker = gst_rtp_buffer_get_marker(&rtp) != FALSE;
  gst_rtp_buffer_unmap(&rtp);
  packet.size = DataSize::Bytes(static_cast<std::int64_t>(gst_buffer_get_size(buffer))) + kIpUdp;
  GstLidarEcn ecn = GST_LIDAR_ECN_NOT_ECT;
  GstClockTime arrival = GST_CLOCK_TIME_NONE;
  gst_lidar_buffer_get_ecn(buffer, &ecn, &arrival);
  packet.is_ce = ecn == GST_LIDAR_ECN_CE;
  packet.unix_time =
      GST_CLOCK_TIME_IS_VALID(arrival) ? Duration{static_cast<std::int64_t>(arrival)} : UnixNow();
  const std::lock_guard lock(mutex_);
  if (meter_.packets() == 0) {
    first_ = line_since_ = packet.unix_time;
  }
  last_ = packet.unix_time;
  line_bytes_ += packet.size;
  if (const auto age = meter_.OnPacket(packet)) {
    second_.Add(Milliseconds(*age));
    if (log_.is_open())
      log_.stream() << Seconds(packet.unix_time - first_) << ',' << packet.timestamp << ','
                    << Milliseconds(*age) << '\n';
  }
}

void Receiver::Tick() {
  const Duration now = UnixNow();
  const std::lock_guard lock(mutex_);
  if (meter_.packets() == 0 || now < line_since_ + std::chrono::seconds{1}) return;
  PrintLine(now);
  line_since_ = now;
}

/// Prints a line about the time since the last line. This time is one second, or slightly more
/// because it is checked at intervals.
void Receiver::PrintLine(Duration now) {
  std::printf(
      "%7.1f s  received %8.3f Mbit/s  frame age p50 %6.1f p95 %6.1f ms%s  CE %llu  lost %llu\n",
      Seconds(now - first_), line_bytes_.bits() / 1e6 / Seconds(now - line_since_),
      second_.Percentile(50), second_.Percentile(95),
      meter_.is_relative() ? " (over the youngest)" : "",
      static_cast<unsigned long long>(meter_.ce_packets()),
      static_cast<unsigned long long>(meter_.lost()));
  std::fflush(stdout);
  line_bytes_ = {};
  second_.Clear();
}

void Receiver::Finish() {
  const std::lock_guard lock(mutex_);
  const double seconds = Seconds(last_ - first_);
  const Distribution& ages = meter_.ages_ms();
  const nlohmann::ordered_json summary = {
      {"seconds", seconds},
      {"packets", meter_.packets()},
      {"lost", meter_.lost()},
      {"ce", meter_.ce_packets()},
      {"frames", meter_.frames()},
      {"mean_rate_bps", seconds > 0 ? meter_.received().bits() / seconds : 0},
      {"frame_age_is_relative", meter_.is_relative()},
      {"frame_age_ms",
       {{"p50", ages.Percentile(50)},
        {"p95", ages.Percentile(95)},
        {"p99", ages.Percentile(99)},
        {"max", ages.Max()}}}};
  std::puts(summary.dump(2).c_str());
  if (!options_.summary.empty()) tools::WriteFile(options_.summary, summary.dump(2) + '\n');
  log_.Close();
  FinishStandardOutput();
}

int Receiver::Run() {
  const int result = RunPipeline(
      pipeline_.get(), "scream-bench rx", options_.duration, [this] { Tick(); },
      [this] { gst_element_send_event(pipeline_.get(), gst_event_new_eos()); });
  Finish();
  if (result != 0 || meter_.packets() > 0) return result;
  std::fprintf(
      stderr,
      "No packets arrived: is \"scream-bench tx\" running, and does UDP pass the network?\n");
  return 1;
}

}  // namespace

int RunReceiver(const BenchOptions& options) { return Receiver(options).Run(); }

}  // namespace lidar::tools
