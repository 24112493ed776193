// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/scream_bench/sender.h"

#include <gst/app/gstappsrc.h>

#include <atomic>
#include <cstdio>
#include <ctime>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "gst/lidar/gstlidar.h"
#include "src/tools/bench/scream_bench/frame_source.h"
#include "src/tools/bench/scream_bench/pipeline.h"
#include "src/tools/common/output_file.h"

namespace lidar::tools {
namespace {

/// Returns a number of `stats` as a double, whatever its type is, or 0 if it is missing.
double Number(const GstStructure* stats, const char* name) {
  const GValue* value = gst_structure_get_value(stats, name);
  if (value == nullptr || !g_value_type_transformable(G_VALUE_TYPE(value), G_TYPE_DOUBLE)) return 0;
  GValue number = G_VALUE_INIT;
  g_value_init(&number, G_TYPE_DOUBLE);
  g_value_transform(value, &number);
  return g_value_get_double(&number);
}

class Sender {
 public:
  explicit Sender(const BenchOptions& options);
  ~Sender();
  int Run();

 private:
  void Build();
  GstPad* AddSinkPad(GstElement* sink);
  void SendFrames();
  void StopSending();
  void PushFrame(GstClockTime running_time);
  gst::StructurePtr Stats() const;
  void Tick();
  void PrintLine(double seconds, const GstStructure* stats);
  void Finish(const GstStructure* stats, double seconds);

  const BenchOptions& options_;
  gst::ElementPtr pipeline_;
  GstElement* source_ = nullptr;
  GstElement* sink_ = nullptr;
  OutputFile log_;
  FrameSizes sizes_;
  FramePacketizer packetizer_;
  std::atomic<std::uint32_t> target_bps_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
  Duration started_{0};
  Duration next_line_{0};
};

Sender::Sender(const BenchOptions& options)
    : options_(options),
      log_(options.tx.log, OutputFile::Rest::kKeepRows),
      sizes_(options.tx.fps, options.tx.frame_jitter_percent),
      packetizer_(options.tx.mtu),
      target_bps_(static_cast<std::uint32_t>(options.tx.init_bitrate.bits_per_second())) {
  log_.stream() << "time_s,target_bps,sent_bps,queue_delay_ms,rtt_ms,ref_wnd,bytes_in_flight,"
                   "media_queue_delay_ms,lost,ce\n";
  Build();
}

Sender::~Sender() {
  StopSending();
  gst_element_set_state(pipeline_.get(), GST_STATE_NULL);
}

/// Makes the thread end the stream, and waits for the thread. An EOS event to the pipeline would
/// race with the buffer lists, because basesrc of GStreamer 1.22 takes a list for a single buffer.
void Sender::StopSending() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void Sender::Build() {
  pipeline_.reset(GST_ELEMENT(gst_object_ref_sink(gst_pipeline_new("scream-bench-tx"))));
  source_ = AddElement(pipeline_.get(), "appsrc", "source");
  const gst::CapsPtr caps(gst_caps_new_simple(
      "application/x-rtp", "media", G_TYPE_STRING, "application", "encoding-name", G_TYPE_STRING,
      "X-SCREAM-BENCH", "clock-rate", G_TYPE_INT, static_cast<gint>(FramePacketizer::kClockRate),
      "payload", G_TYPE_INT, static_cast<gint>(FramePacketizer::kPayloadType), "ssrc", G_TYPE_UINT,
      guint{FramePacketizer::kSsrc}, nullptr));
  g_object_set(source_, "caps", caps.get(), "format", GST_FORMAT_TIME, "is-live", TRUE, "max-bytes",
               guint64{0}, nullptr);
  sink_ = AddElement(pipeline_.get(), "screamsink", "sink");
  const BenchTxOptions& o = options_.tx;
  g_object_set(sink_, "host", o.host.c_str(), "port", static_cast<gint>(o.port), "bind-port",
               static_cast<gint>(o.bind_port), "strict-feedback", FALSE, nullptr);
  if (!o.bind_address.empty()) g_object_set(sink_, "bind-address", o.bind_address.c_str(), nullptr);
  gst_util_set_object_arg(G_OBJECT(sink_), "ecn-mode", o.ecn.c_str());
  const gst::PadPtr to(AddSinkPad(sink_));
  const gst::PadPtr from(gst_element_get_static_pad(source_, "src"));
  if (gst_pad_link(from.get(), to.get()) != GST_PAD_LINK_OK)
    throw std::runtime_error("cannot link to screamsink");
  gst_pad_add_probe(
      from.get(), GST_PAD_PROBE_TYPE_EVENT_UPSTREAM,
      [](GstPad*, GstPadProbeInfo* info, gpointer data) -> GstPadProbeReturn {
        GstLidarTargetBitrate target{};
        if (gst_lidar_event_parse_target_bitrate(GST_PAD_PROBE_INFO_EVENT(info), &target))
          static_cast<Sender*>(data)->target_bps_ = target.bitrate;
        return GST_PAD_PROBE_OK;
      },
      this, nullptr);
}

GstPad* Sender::AddSinkPad(GstElement* sink) {
  GstPad* pad = gst_element_request_pad_simple(sink, "sink_%u");
  const auto bps = [](DataRate rate) { return static_cast<guint>(rate.bits_per_second()); };
  g_object_set(pad, "min-bitrate", bps(options_.tx.min_bitrate), "start-bitrate",
               bps(options_.tx.init_bitrate), "max-bitrate", bps(options_.tx.max_bitrate), nullptr);
  return pad;
}

/// Sends frames at a constant interval of GStreamer's system clock, which is monotonic. Sends at
/// least one frame.
void Sender::SendFrames() {
  const gst::ElementPtr keep(GST_ELEMENT(gst_object_ref(pipeline_.get())));
  GstClock* clock = gst_element_get_clock(pipeline_.get());
  const GstClockTime start = gst_clock_get_time(clock);
  const GstClockTime base = gst_element_get_base_time(pipeline_.get());
  for (std::uint64_t frame = 0; frame == 0 || !stop_; ++frame) {
    const GstClockTime due = start + frame * static_cast<std::uint64_t>(sizes_.period().count());
    GstClockID id = gst_clock_new_single_shot_id(clock, due);
    gst_clock_id_wait(id, nullptr);
    gst_clock_id_unref(id);
    PushFrame(gst_clock_get_time(clock) - base);
  }
  gst_object_unref(clock);
  gst_app_src_end_of_stream(GST_APP_SRC(source_));
}

void Sender::PushFrame(GstClockTime running_time) {
  const DataSize size = sizes_.Next(DataRate::BitsPerSecond(target_bps_.load()));
  gst::BufferListPtr packets = packetizer_.Packetize(size, UnixNow(), running_time);
  if (gst_buffer_list_length(packets.get()) == 0) return;
  gst_app_src_push_buffer_list(GST_APP_SRC(source_), packets.release());
}

gst::StructurePtr Sender::Stats() const {
  GstStructure* stats = nullptr;
  g_object_get(sink_, "stats", &stats, nullptr);
  return gst::StructurePtr(stats != nullptr ? stats : gst_structure_new_empty("stats"));
}

void Sender::Tick() {
  const Duration now = UnixNow();
  if (started_ == Duration{0}) {
    started_ = now;
    next_line_ = now + std::chrono::seconds{1};
    thread_ = std::thread([this] { SendFrames(); });
    return;
  }
  const gst::StructurePtr stats = Stats();
  const double seconds = Seconds(now - started_);
  const auto get = [&](const char* name) { return Number(stats.get(), name); };
  if (log_.is_open()) {
    log_.stream() << seconds << ',' << get("target-bitrate") << ',' << get("sent-bitrate") << ','
                  << get("queue-delay") / 1e6 << ',' << get("rtt") / 1e6 << ',' << get("ref-wnd")
                  << ',' << get("bytes-in-flight") << ',' << get("sender-queue-delay") / 1e6 << ','
                  << get("packets-lost") << ',' << get("packets-ce") << '\n';
  }
  if (now < next_line_) return;
  next_line_ += std::chrono::seconds{1};
  PrintLine(seconds, stats.get());
}

void Sender::PrintLine(double seconds, const GstStructure* stats) {
  const auto get = [&](const char* name) { return Number(stats, name); };
  std::printf(
      "%7.1f s  target %8.3f  sent %8.3f Mbit/s  queue delay %6.1f ms  RTT %6.1f ms  "
      "ref_wnd %8.0f  in flight %8.0f  lost %.0f  CE %.0f\n",
      seconds, get("target-bitrate") / 1e6, get("sent-bitrate") / 1e6, get("queue-delay") / 1e6,
      get("rtt") / 1e6, get("ref-wnd"), get("bytes-in-flight"), get("packets-lost"),
      get("packets-ce"));
  std::fflush(stdout);
}

void Sender::Finish(const GstStructure* stats, double seconds) {
  const nlohmann::ordered_json summary = {
      {"seconds", seconds},
      {"packets_sent", Number(stats, "packets-sent")},
      {"bytes_sent", Number(stats, "bytes-sent")},
      {"packets_lost", Number(stats, "packets-lost")},
      {"packets_ce", Number(stats, "packets-ce")},
      {"packets_dropped", Number(stats, "packets-dropped")},
      {"mean_rate_bps", seconds > 0 ? Number(stats, "bytes-sent") * 8 / seconds : 0}};
  std::puts(summary.dump(2).c_str());
  if (!options_.summary.empty()) tools::WriteFile(options_.summary, summary.dump(2) + '\n');
  log_.Close();
  FinishStandardOutput();
}

int Sender::Run() {
  const int result = RunPipeline(
      pipeline_.get(), "scream-bench tx", options_.duration, [this] { Tick(); },
      [this] { StopSending(); });
  const gst::StructurePtr last = Stats();
  const double seconds = started_ == Duration{0} ? 0 : Seconds(UnixNow() - started_);
  Finish(last.get(), seconds);
  const bool unheard =
      Number(last.get(), "packets-sent") > 0 && Number(last.get(), "feedback-accepted") == 0;
  if (result != 0 || !unheard) return result;
  std::fprintf(
      stderr,
      "No feedback arrived: is \"scream-bench rx\" running, and does UDP pass the network?\n");
  return 1;
}

}  // namespace

int RunSender(const BenchOptions& options) { return Sender(options).Run(); }

}  // namespace lidar::tools
