// SPDX-License-Identifier: LGPL-2.1-or-later
// Measures natssink and natssrc with many streams in real time: the latency that they add, and the
// processor time per stream that the sinks, the sources and the server use.
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "ext/nats/jetstream.h"
#include "tests/elements/nats/nats_pipeline.h"
#include "tests/elements/nats/process_figures.h"
#include "tests/support/harness.h"

namespace lidar::test {
namespace {

constexpr int kSlicesPerSecond = 160;

guint64 NowNs() { return static_cast<guint64>(g_get_real_time()) * 1000; }

double CpuSeconds(int who) {
  rusage u{};
  getrusage(who, &u);
  return static_cast<double>(u.ru_utime.tv_sec + u.ru_stime.tv_sec) +
         static_cast<double>(u.ru_utime.tv_usec + u.ru_stime.tv_usec) * 1e-6;
}

/// Ten coded scans of an OS1-64.
struct Slices {
  gst::CapsPtr caps;
  std::vector<gst::BufferPtr> buffers;
  guint64 bytes = 0;
};

Slices Encode() {
  Slices slices;
  const gst::ElementPtr pipeline(gst_parse_launch(
      "lidartestsrc model=os1-64 mode=1024x10 num-buffers=160 ! lidarenc ! fakesink name=see "
      "signal-handoffs=true",
      nullptr));
  const gst::ElementPtr see(gst_bin_get_by_name(GST_BIN(pipeline.get()), "see"));
  g_signal_connect(see.get(), "handoff",
                   G_CALLBACK(+[](GstElement*, GstBuffer* buffer, GstPad* pad, gpointer data) {
                     auto* out = static_cast<Slices*>(data);
                     if (!out->caps) out->caps.reset(gst_pad_get_current_caps(pad));
                     out->buffers.emplace_back(gst_buffer_copy_deep(buffer));
                     out->bytes += gst_buffer_get_size(buffer);
                   }),
                   &slices);
  gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
  GstBus* bus = gst_element_get_bus(pipeline.get());
  const gst::MessagePtr end(gst_bus_timed_pop_filtered(bus, GST_CLOCK_TIME_NONE, GST_MESSAGE_EOS));
  gst_object_unref(bus);
  gst_element_set_state(pipeline.get(), GST_STATE_NULL);
  return slices;
}

struct Options {
  int streams = 1;
  int seconds = 10;
  std::string stored;  // further properties of both elements
  std::string url;
  std::string Subject(int stream) const {
    return " url=" + url + " subject=bench.s" + std::to_string(stream) + " " + stored;
  }
};

gst::ElementPtr Launch(const std::string& description) {
  gst::ElementPtr pipeline(gst_parse_launch(description.c_str(), nullptr));
  if (!pipeline) std::abort();
  return pipeline;
}

/// Receives the streams and prints the latency and the processor time. Runs in a process of its
/// own.
void Receive(const Options& o, std::size_t expected, int ready_fd) {
  struct Latencies {
    std::mutex mutex;
    guint64 count_from = 0;  // only messages that were sent at this time or later count
    std::size_t received = 0;
    std::vector<double> ms;
  } latencies;
  std::vector<gst::ElementPtr> pipelines;
  for (int i = 0; i < o.streams; ++i) {
    pipelines.push_back(Launch("natssrc name=n start-time=0" + o.Subject(i) +
                               " ! fakesink name=see sync=false signal-handoffs=true"));
    const gst::ElementPtr see(gst_bin_get_by_name(GST_BIN(pipelines.back().get()), "see"));
    g_signal_connect(see.get(), "handoff",
                     G_CALLBACK(+[](GstElement*, GstBuffer* buffer, GstPad*, gpointer data) {
                       auto* out = static_cast<Latencies*>(data);
                       const guint64 sent = gst_lidar_buffer_get_capture_time(buffer);
                       const auto late = static_cast<gint64>(NowNs() - sent);
                       const std::lock_guard lock(out->mutex);
                       ++out->received;
                       if (out->count_from == 0) out->count_from = sent + 2 * GST_SECOND;
                       if (sent >= out->count_from)
                         out->ms.push_back(static_cast<double>(late) * 1e-6);
                     }),
                     &latencies);
    gst_element_set_state(pipelines.back().get(), GST_STATE_PLAYING);
  }
  const double before = CpuSeconds(RUSAGE_SELF);
  if (write(ready_fd, "r", 1) != 1) std::abort();
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(o.seconds + 10);
  const auto all = [&] {
    const std::lock_guard lock(latencies.mutex);
    return latencies.received >= expected;
  };
  while (!all() && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const double cpu = CpuSeconds(RUSAGE_SELF) - before;
  for (const auto& pipeline : pipelines) gst_element_set_state(pipeline.get(), GST_STATE_NULL);
  auto& ms = latencies.ms;
  std::sort(ms.begin(), ms.end());
  const auto at = [&](double q) {
    return ms.empty() ? 0.0 : ms[static_cast<std::size_t>(q * static_cast<double>(ms.size() - 1))];
  };
  std::printf("received %zu of %zu; latency p50 %.2f ms, p99 %.2f ms, most %.2f ms\n",
              latencies.received, expected, at(0.5), at(0.99), at(1));
  std::printf("natssrc   %.2f %% of a core for each stream\n", 100 * cpu / o.seconds / o.streams);
  std::fflush(stdout);
}

/// Pushes each slice of each stream at its time.
void Send(const Options& o, const Slices& slices) {
  std::vector<Harness> sinks;
  const gst::StringPtr caps(gst_caps_to_string(slices.caps.get()));
  for (int i = 0; i < o.streams; ++i) {
    sinks.emplace_back(gst_harness_new_parse(("natssink sync=false" + o.Subject(i)).c_str()));
    gst_harness_set_src_caps_str(sinks.back().get(), caps.get());
  }
  const double before = CpuSeconds(RUSAGE_SELF);
  auto due = std::chrono::steady_clock::now();
  for (int n = 0; n < o.seconds * kSlicesPerSecond; ++n) {
    std::this_thread::sleep_until(due += std::chrono::microseconds(1'000'000 / kSlicesPerSecond));
    for (const Harness& sink : sinks) {
      const auto& slice = slices.buffers[static_cast<std::size_t>(n) % slices.buffers.size()];
      GstBuffer* buffer = gst_buffer_copy(slice.get());
      gst_lidar_buffer_set_capture_time(buffer, NowNs());
      gst_harness_push(sink.get(), buffer);
    }
  }
  const double cpu = CpuSeconds(RUSAGE_SELF) - before;
  for (const Harness& sink : sinks) gst_harness_push_event(sink.get(), gst_event_new_eos());
  std::printf("natssink  %.2f %% of a core for each stream\n", 100 * cpu / o.seconds / o.streams);
}

/// Makes one JetStream stream for all senders, as lidar-edge does.
bool MakeStream(const std::string& url) {
  natsConnection* nc = nullptr;
  if (natsConnection_ConnectTo(&nc, url.c_str()) != NATS_OK) return false;
  auto js = nats::OpenJetStream(nc);
  std::string why;
  const nats::StreamSettings settings{"bench", std::chrono::hours(1), std::uint64_t{4} << 30, 1,
                                      ""};
  const bool made = nats::EnsureStream(js.get(), settings, {"bench.>"}, &why);
  js.reset();
  natsConnection_Destroy(nc);
  return made;
}

/// Starts the receiver in a process of its own. This must happen before this process has threads.
int Measure(Options o, const NatsServer& server) {
  const auto expected = static_cast<std::size_t>(o.streams * o.seconds * kSlicesPerSecond);
  int ready[2];
  if (pipe(ready) != 0) return 1;
  const pid_t receiver = fork();
  gst_init(nullptr, nullptr);
  gst_lidar_init();
  if (receiver == 0) {
    Receive(o, expected, ready[1]);
    _exit(0);
  }
  if (!o.stored.empty() && !MakeStream(o.url)) return 1;
  const Slices slices = Encode();
  char byte = 0;
  if (read(ready[0], &byte, 1) != 1) return 1;
  const double before = CpuOf(server.pid());
  Send(o, slices);
  const double cpu = CpuOf(server.pid()) - before;
  waitpid(receiver, nullptr, 0);
  const double mean =
      static_cast<double>(slices.bytes) / static_cast<double>(slices.buffers.size());
  std::printf("server    %.2f %% of a core for each stream, %.0f MB\n",
              100 * cpu / o.seconds / o.streams, MegabytesOf(server.pid()));
  std::printf("%d streams of %d slices/s, %.0f bytes each\n", o.streams, kSlicesPerSecond, mean);
  return 0;
}

}  // namespace
}  // namespace lidar::test

int main(int argc, char** argv) {
  lidar::test::Options options;
  if (argc > 1) options.streams = std::atoi(argv[1]);
  if (argc > 2) options.seconds = std::atoi(argv[2]);
  if (argc > 3) options.stored = "jetstream=bench";
  if (lidar::test::NatsServer::Program().empty() || options.streams < 1 || options.seconds < 1) {
    std::fprintf(stderr, "usage: nats-bench STREAMS SECONDS [jetstream]; it needs nats-server\n");
    return 2;
  }
  lidar::test::NatsServer server;
  server.Start();
  options.url = server.url();
  return lidar::test::Measure(options, server);
}
