// SPDX-License-Identifier: LGPL-2.1-or-later
// Measures the processor time, latency and loss of ros2src and ros2sink, with a peer in another
// process. This program is run by hand; docs/results/ecosystem.md has the figures.
#include <gst/gst.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "tests/elements/ros2/ros2_support.h"

namespace lidar::test {
namespace {

constexpr std::uint32_t kDomain = 98;
constexpr std::uint32_t kHeight = 128;
constexpr std::chrono::milliseconds kPeriod{100};

struct Arguments {
  bool src = false;
  bool fast = false;
  bool reliable = false;
  std::uint32_t width = 1024;
  unsigned count = 50;
};

std::int64_t NowNs() { return g_get_real_time() * 1000; }

double CpuSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6;
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// The counts and latencies of one receiving process.
struct Report {
  unsigned taken = 0;
  unsigned wrong = 0;
  double latency_sum_ms = 0;
  double latency_max_ms = 0;
  double begin_cpu = CpuSeconds();
  std::int64_t begin_ns = NowNs();

  void OnCloud(std::int64_t stamp_ns, const std::uint8_t* data, std::size_t size,
               const PeerCloud& sent) {
    const double ms = static_cast<double>(NowNs() - stamp_ns) * 1e-6;
    if (taken++ == 0) begin_cpu = CpuSeconds(), begin_ns = NowNs();
    latency_sum_ms += ms;
    latency_max_ms = std::max(latency_max_ms, ms);
    if (size != sent.data.size() || std::memcmp(data, sent.data.data(), size) != 0) ++wrong;
  }
  void Print(const char* who, unsigned sent) const {
    const double elapsed = static_cast<double>(NowNs() - begin_ns) * 1e-9;
    std::printf("%s: %.1f %% of a core", who, 100 * (CpuSeconds() - begin_cpu) / elapsed);
    if (taken > 0)
      std::printf("; %u of %u clouds, %u not intact; latency %.1f ms, at most %.1f ms", taken, sent,
                  wrong, latency_sum_ms / taken, latency_max_ms);
    std::printf("\n");
    std::fflush(stdout);
  }
};

std::string Properties(const Arguments& a, const char* element) {
  return std::string(element) + " name=ros topic=/bench domain-id=" + std::to_string(kDomain) +
         " qos=" + (a.reliable ? "reliable" : "sensor-data");
}

/// Receives clouds until no more clouds arrive.
void Receive(const Arguments& a, bool fast, const PeerCloud& sent, const char* who) {
  Report report;
  if (fast) {
    FastPeer peer(kDomain);
    peer.Subscribe<PeerCloud>("rt/bench", kCloudType,
                              a.reliable ? FastPeer::Qos::kReliable : FastPeer::Qos::kBestEffort);
    PeerCloud cloud;
    while (peer.Take(&cloud, std::chrono::milliseconds(report.taken > 0 ? 1500 : 15'000)))
      report.OnCloud(std::int64_t{cloud.header.sec} * 1'000'000'000 + cloud.header.nanosec,
                     cloud.data.data(), cloud.data.size(), sent);
  } else {
    Harness h(gst_harness_new_parse(Properties(a, "ros2src").c_str()));
    SetPlaying(h.get());
    std::int64_t last = NowNs() + 14'000'000'000;
    while (NowNs() - last < 1'500'000'000) {
      const gst::BufferPtr buffer(gst_harness_try_pull(h.get()));
      if (!buffer) {
        std::this_thread::sleep_for(std::chrono::microseconds(500));
        continue;
      }
      const gst::BufferMap map(buffer.get(), GST_MAP_READ);
      report.OnCloud(static_cast<std::int64_t>(gst_lidar_buffer_get_capture_time(buffer.get())),
                     map.data(), map.size(), sent);
      last = NowNs();
    }
  }
  report.Print(who, a.count);
}

template <class Send>
void SendAll(const Arguments& a, PeerCloud cloud, const char* who, Send send) {
  std::this_thread::sleep_for(std::chrono::seconds(1));
  Report report;
  auto next = std::chrono::steady_clock::now();
  for (unsigned i = 0; i < a.count; ++i) {
    const std::int64_t now = NowNs();
    cloud.header.sec = static_cast<std::int32_t>(now / 1'000'000'000);
    cloud.header.nanosec = static_cast<std::uint32_t>(now % 1'000'000'000);
    send(cloud);
    next += kPeriod;
    std::this_thread::sleep_until(next);
  }
  report.Print(who, a.count);
  std::this_thread::sleep_for(std::chrono::seconds(1));
}

void Send(const Arguments& a, bool fast, const PeerCloud& cloud, const char* who) {
  if (fast) {
    FastPeer peer(kDomain);
    peer.Advertise<PeerCloud>("rt/bench", kCloudType,
                              a.reliable ? FastPeer::Qos::kReliable : FastPeer::Qos::kBestEffort);
    peer.WaitForMatch(kPatience);
    SendAll(a, cloud, who, [&](const PeerCloud& c) { peer.Publish(c); });
  } else {
    Harness h(gst_harness_new_parse((Properties(a, "ros2sink") + " sync=false").c_str()));
    gst_harness_set_src_caps(h.get(), CloudCaps(cloud).release());
    SendAll(a, cloud, who, [&](const PeerCloud& c) { gst_harness_push(h.get(), CloudBuffer(c)); });
  }
}

int Run(const Arguments& a) {
  const PeerCloud cloud = TestCloud(a.width, kHeight);
  const pid_t child = fork();
  if (child < 0) return 1;
  gst_init(nullptr, nullptr);
  const bool fast = a.fast && child == 0;
  const bool sends = a.src == (child == 0);
  const char* who = child == 0 ? "peer" : a.src ? "ros2src" : "ros2sink";
  if (sends)
    Send(a, fast, cloud, who);
  else
    Receive(a, fast, cloud, who);
  if (child == 0) _exit(0);
  waitpid(child, nullptr, 0);
  return 0;
}

}  // namespace
}  // namespace lidar::test

int main(int argc, char** argv) {
  if (argc != 6) {
    std::fprintf(stderr, "ros2-bench src|sink fast|cyclone reliable|sensor-data WIDTH COUNT\n");
    return 2;
  }
  lidar::test::Arguments a;
  a.src = std::strcmp(argv[1], "src") == 0;
  a.fast = std::strcmp(argv[2], "fast") == 0;
  a.reliable = std::strcmp(argv[3], "reliable") == 0;
  a.width = static_cast<std::uint32_t>(std::atoi(argv[4]));
  a.count = static_cast<unsigned>(std::atoi(argv[5]));
  return lidar::test::Run(a);
}
