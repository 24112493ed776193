// SPDX-License-Identifier: LGPL-2.1-or-later
// Measures how much CPU time a packet of 1200 bytes costs in screamtx and in screamrx, including
// the feedback.
#include <benchmark/benchmark.h>
#include <gst/gst.h>

#include <atomic>
#include <memory>
#include <vector>

#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"
#include "src/base/byte_writer.h"
#include "src/rtcp/ccfb.h"

namespace lidar {
namespace {

using gst::CapsPtr;
using gst::ElementPtr;
using gst::PadPtr;

constexpr gsize kPacket = 1200;
constexpr std::uint32_t kSsrc = 7;
constexpr std::size_t kPacketsPerReport = 16;

GstBuffer* NewPacket(std::uint16_t seq) {
  std::vector<std::uint8_t> header;
  ByteWriter w(&header);
  w.U8(0x80);
  w.U8(static_cast<std::uint8_t>(96 | (seq % 16 == 15 ? 0x80 : 0)));
  w.Be16(seq);
  w.Be32(seq / 16 * 900U);
  w.Be32(kSsrc);
  GstBuffer* buffer = gst_buffer_new_allocate(nullptr, kPacket, nullptr);
  gst_buffer_fill(buffer, 0, header.data(), header.size());
  return buffer;
}

void SendStart(GstPad* pad, const char* caps_text) {
  gst_pad_push_event(pad, gst_event_new_stream_start("bench"));
  const CapsPtr caps(gst_caps_from_string(caps_text));
  gst_pad_push_event(pad, gst_event_new_caps(caps.get()));
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  gst_pad_push_event(pad, gst_event_new_segment(&segment));
}

/// The receiver of the packets. It counts the packets, and sends a report about them to the pad
/// rtcp_sink as soon as kPacketsPerReport have arrived.
struct Receiver {
  GstPad* pad = gst_pad_new("sink", GST_PAD_SINK);
  GstPad* rtcp = gst_pad_new("src", GST_PAD_SRC);
  std::vector<std::uint16_t> unreported;
  std::atomic<std::uint64_t> packets{0};

  void Take(GstBuffer* buffer) {
    std::uint8_t seq[2];
    gst_buffer_extract(buffer, 2, seq, 2);
    unreported.push_back(static_cast<std::uint16_t>(seq[0] << 8 | seq[1]));
    ++packets;
    if (unreported.size() < kPacketsPerReport) return;
    rtcp::CongestionFeedback report;
    rtcp::SsrcReport block{kSsrc, unreported.front(), {}};
    block.metrics.assign(unreported.size(), {true, Ecn::kEct1, Duration{0}});
    report.blocks.push_back(std::move(block));
    report.report_timestamp =
        static_cast<std::uint32_t>(g_get_monotonic_time() * 65536 / G_USEC_PER_SEC);
    unreported.clear();
    const auto bytes = rtcp::BuildCcfb(report);
    GstBuffer* out = gst_buffer_new_allocate(nullptr, bytes.size(), nullptr);
    gst_buffer_fill(out, 0, bytes.data(), bytes.size());
    gst_pad_push(rtcp, out);
  }
  static Receiver& Of(GstPad* pad) {
    return *static_cast<Receiver*>(gst_pad_get_element_private(pad));
  }
};

GstFlowReturn TakeBuffer(GstPad* pad, GstObject*, GstBuffer* buffer) {
  Receiver::Of(pad).Take(buffer);
  gst_buffer_unref(buffer);
  return GST_FLOW_OK;
}

GstFlowReturn TakeList(GstPad* pad, GstObject*, GstBufferList* list) {
  for (guint i = 0; i < gst_buffer_list_length(list); ++i)
    Receiver::Of(pad).Take(gst_buffer_list_get(list, i));
  gst_buffer_list_unref(list);
  return GST_FLOW_OK;
}

GstFlowReturn Count(GstPad* pad, GstObject*, GstBuffer* buffer) {
  ++Receiver::Of(pad).packets;
  gst_buffer_unref(buffer);
  return GST_FLOW_OK;
}

/// Answers a latency query as a source that is not live. For such a source screamtx blocks the
/// input instead of dropping packets.
gboolean NotLive(GstPad* pad, GstObject* parent, GstQuery* query) {
  if (GST_QUERY_TYPE(query) != GST_QUERY_LATENCY) return gst_pad_query_default(pad, parent, query);
  gst_query_set_latency(query, FALSE, 0, GST_CLOCK_TIME_NONE);
  return TRUE;
}

void Report(benchmark::State& state, std::uint64_t packets) {
  const auto bits = static_cast<double>(packets) * kPacket * 8;
  state.counters["packets"] = static_cast<double>(packets);
  state.counters["bits_per_cpu_second"] =
      benchmark::Counter(bits, benchmark::Counter::kIsRate, benchmark::Counter::kIs1000);
}

void LinkReceiver(GstElement* tx, Receiver* receiver) {
  gst_pad_set_element_private(receiver->pad, receiver);
  gst_pad_set_chain_function(receiver->pad, TakeBuffer);
  gst_pad_set_chain_list_function(receiver->pad, TakeList);
  gst_pad_set_active(receiver->pad, TRUE);
  gst_pad_set_active(receiver->rtcp, TRUE);
  const PadPtr src(gst_element_get_static_pad(tx, "src"));
  const PadPtr rtcp(gst_element_get_static_pad(tx, "rtcp_sink"));
  gst_pad_link(src.get(), receiver->pad);
  gst_pad_link(receiver->rtcp, rtcp.get());
}

/// Measures the CPU time of the whole process. It includes input, pacing, feedback, and making the
/// reports.
void ScreamTx(benchmark::State& state) {
  const ElementPtr tx(
      GST_ELEMENT(gst_object_ref_sink(gst_element_factory_make("screamtx", nullptr))));
  g_object_set(tx.get(), "start-bitrate", 4'000'000'000U, "max-bitrate", 4'000'000'000U,
               "max-queue-delay", guint64{5 * GST_MSECOND}, nullptr);
  Receiver receiver;
  LinkReceiver(tx.get(), &receiver);
  GstPad* src = gst_pad_new("src", GST_PAD_SRC);
  gst_pad_set_query_function(src, NotLive);
  const PadPtr sink(gst_element_request_pad_simple(tx.get(), "sink_0"));
  gst_pad_link(src, sink.get());
  gst_element_set_state(tx.get(), GST_STATE_PLAYING);
  gst_pad_set_active(src, TRUE);
  SendStart(src, "application/x-rtp,media=application,clock-rate=90000,encoding-name=X");
  SendStart(receiver.rtcp, "application/x-rtcp");
  std::uint16_t seq = 0;
  for (auto _ : state) {
    GstBufferList* list = gst_buffer_list_new_sized(16);
    for (int i = 0; i < 16; ++i) gst_buffer_list_add(list, NewPacket(seq++));
    gst_pad_push_list(src, list);
  }
  Report(state, receiver.packets);
  gst_element_set_state(tx.get(), GST_STATE_NULL);
  for (GstPad* pad : {src, receiver.pad, receiver.rtcp}) {
    gst_pad_set_active(pad, FALSE);
    gst_object_unref(pad);
  }
}
BENCHMARK(ScreamTx)->MeasureProcessCPUTime()->Unit(benchmark::kMicrosecond);

void ScreamRx(benchmark::State& state) {
  const ElementPtr rx(
      GST_ELEMENT(gst_object_ref_sink(gst_element_factory_make("screamrx", nullptr))));
  Receiver media;
  Receiver reports;
  for (auto* r : {&media, &reports}) {
    gst_pad_set_element_private(r->pad, r);
    gst_pad_set_chain_function(r->pad, Count);
    gst_pad_set_active(r->pad, TRUE);
  }
  const PadPtr out(gst_element_get_static_pad(rx.get(), "src"));
  const PadPtr rtcp(gst_element_get_static_pad(rx.get(), "rtcp_src"));
  const PadPtr in(gst_element_get_static_pad(rx.get(), "sink"));
  GstPad* src = gst_pad_new("src", GST_PAD_SRC);
  gst_pad_link(src, in.get());
  gst_pad_link(out.get(), media.pad);
  gst_pad_link(rtcp.get(), reports.pad);
  gst_element_set_state(rx.get(), GST_STATE_PLAYING);
  gst_pad_set_active(src, TRUE);
  SendStart(src, "application/x-rtp,media=application,clock-rate=90000,encoding-name=X");
  std::uint16_t seq = 0;
  for (auto _ : state) {
    GstBufferList* list = gst_buffer_list_new_sized(16);
    for (int i = 0; i < 16; ++i) {
      GstBuffer* buffer = NewPacket(seq++);
      gst_lidar_buffer_set_ecn(buffer, GST_LIDAR_ECN_ECT1, GST_CLOCK_TIME_NONE);
      gst_buffer_list_add(list, buffer);
    }
    gst_pad_push_list(src, list);
  }
  Report(state, media.packets);
  state.counters["reports"] = static_cast<double>(reports.packets);
  gst_element_set_state(rx.get(), GST_STATE_NULL);
  for (auto* r : {&media, &reports}) {
    gst_pad_set_active(r->pad, FALSE);
    gst_object_unref(r->pad);
    gst_object_unref(r->rtcp);
  }
  gst_pad_set_active(src, FALSE);
  gst_object_unref(src);
}
BENCHMARK(ScreamRx)->MeasureProcessCPUTime()->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace lidar

int main(int argc, char** argv) {
  gst_init(&argc, &argv);
  gst_lidar_init();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
