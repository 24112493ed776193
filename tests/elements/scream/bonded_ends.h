// SPDX-License-Identifier: LGPL-2.1-or-later
// A sender that sends audio over several links, and the receiver of the audio.
#pragma once
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <functional>
#include <numeric>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/elements/scream/pipeline.h"
#include "tests/elements/scream/rtp_support.h"

namespace lidar::test {

inline const std::string kBondedAudio =
    "audiotestsrc name=src num-buffers=150 samplesperbuffer=441 is-live=true ! "
    "audio/x-raw,rate=44100,channels=1,format=S16BE ! rtpL16pay ! ";

/// Returns the port to which the screamsrc `in` is bound.
inline std::string BoundPort(Pipeline& pipeline) {
  GSocket* socket = nullptr;
  g_object_get(pipeline.Get("in").get(), "used-socket", &socket, nullptr);
  GSocketAddress* address = g_socket_get_local_address(socket, nullptr);
  const auto port = g_inet_socket_address_get_port(G_INET_SOCKET_ADDRESS(address));
  g_object_unref(address);
  g_object_unref(socket);
  return std::to_string(port);
}

/// A screamsrc that receives raw audio on a free port, and the number of buffers that it has
/// output.
struct BondReceiver {
  explicit BondReceiver(const std::string& options = "")
      : pipeline("screamsrc name=in port=0 " + options +
                 " caps=\"application/x-rtp,media=audio,encoding-name=L16,"
                 "clock-rate=44100,channels=1,payload=96\" ! fakesink name=out sync=false "
                 "signal-handoffs=true") {
    const ElementPtr out = pipeline.Get("out");
    g_signal_connect(
        out.get(), "handoff",
        G_CALLBACK(+[](GstElement*, GstBuffer*, GstPad*, std::atomic<guint>* n) { ++*n; }),
        &passed);
    pipeline.Play();
    port = BoundPort(pipeline);
  }
  std::atomic<guint> passed{0};
  Pipeline pipeline;
  std::string port;
};

inline std::string Bonded(const std::string& addresses, const std::string& more = "") {
  return kBondedAudio + "screamsink name=out bonding-addresses=\"" + addresses + "\" " + more;
}

/// Returns the values of `field` in all elements of the array `links`, which is in `stats`.
inline std::vector<guint64> OfLinks(GstElement* element, const char* field) {
  const gst::StructurePtr stats = StatsOf(element);
  std::vector<guint64> values;
  const GValue* links = gst_structure_get_value(stats.get(), "links");
  for (guint i = 0; links != nullptr && i < gst_value_array_get_size(links); ++i) {
    guint64 value = 0;
    const GValue* link = gst_value_array_get_value(links, i);
    EXPECT_TRUE(gst_structure_get_uint64(gst_value_get_structure(link), field, &value)) << field;
    values.push_back(value);
  }
  return values;
}

/// Returns the sum of the values of `field` over all links.
inline guint64 OfAllLinks(GstElement* element, const char* field) {
  const auto values = OfLinks(element, field);
  return std::accumulate(values.begin(), values.end(), guint64{0});
}
/// Returns the number of packets that were pushed into the bonded `sink`.
inline guint64 PacketsOf(GstElement* sink) { return OfAllLinks(sink, "packets-first"); }

/// Returns true if both links have received more than ten reports.
inline bool BothHear(GstElement* sink) {
  const auto accepted = OfLinks(sink, "feedback-accepted");
  return accepted.size() == 2 && accepted[0] > 10 && accepted[1] > 10;
}

/// Plays the sender until `enough` returns true, then ends both pipelines.
inline void Stream(Pipeline& sender, BondReceiver& receiver, const std::function<bool()>& enough) {
  g_object_set(sender.Get("src").get(), "num-buffers", -1, nullptr);
  sender.Play();
  EXPECT_TRUE(Eventually(enough));
  sender.SendEos();
  EXPECT_TRUE(sender.Ends());
  EXPECT_TRUE(receiver.pipeline.Ends());
}

/// Returns the number of packets that links dropped because they were too old. This happens on a
/// busy machine.
inline guint64 TooOld(GstElement* sink) {
  return OfAllLinks(sink, "packets-dropped") - OfAllLinks(sink, "copies-cancelled");
}
/// Expects that all of the `count` packets have arrived, except a few that were too old.
inline void ExpectAllPassed(const BondReceiver& receiver, Pipeline& sender, guint64 count) {
  const guint64 too_old = TooOld(sender.Get("out").get());
  EXPECT_LE(too_old, count / 10);
  EXPECT_LE(receiver.passed, count);
  EXPECT_GE(receiver.passed + too_old, count);
}

/// A router between the two links of a sender and one receiver. The router has a port for each
/// link, to which the sender sends. It forwards the packets of each link from a different address.
class Router {
 public:
  static constexpr int kLinks = 2;

  explicit Router(const std::string& receiver_port)
      : receiver_(Loopback(std::stoi(receiver_port))) {
    for (int i = 0; i < kLinks; ++i) {
      doors_[i] = Bind();
      backs_[i] = Bind();
    }
    thread_ = std::thread([this] { Run(); });
  }
  ~Router() {
    stop_ = true;
    thread_.join();
    for (const int fd : doors_) close(fd);
    for (const int fd : backs_) close(fd);
  }
  Router(const Router&) = delete;
  Router& operator=(const Router&) = delete;

  /// Returns both links in the format of the property bonding-addresses.
  std::string Addresses() const {
    return "127.0.0.1:" + PortOf(doors_[0]) + "@127.0.0.1,127.0.0.1:" + PortOf(doors_[1]) +
           "@127.0.0.2";
  }

  /// The number of datagrams after which link 1 dies. Datagrams of both directions count.
  std::atomic<int> left{1 << 30};
  /// If true, neither link carries any datagrams.
  std::atomic<bool> dark{false};
  /// If true, the feedback of each link is sent to the other link.
  std::atomic<bool> swaps{false};
  /// If true, link 1 loses all datagrams of the sender.
  std::atomic<bool> loses{false};
  /// If true, link 1 loses all datagrams of the receiver.
  std::atomic<bool> mutes{false};
  /// The time after which the receiver sees a new address of link 1, again and again [ms]; 0:
  /// never.
  std::atomic<int> moves_each_ms{0};
  std::atomic<int> moves{0};

 private:
  static sockaddr_in Loopback(int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
  }
  static int Bind() {
    const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    const sockaddr_in local = Loopback(0);
    EXPECT_EQ(bind(fd, reinterpret_cast<const sockaddr*>(&local), sizeof local), 0);
    return fd;
  }
  static std::string PortOf(int fd) {
    sockaddr_in local{};
    socklen_t size = sizeof local;
    getsockname(fd, reinterpret_cast<sockaddr*>(&local), &size);
    return std::to_string(ntohs(local.sin_port));
  }
  static void Send(int fd, const char* bytes, ssize_t size, const sockaddr_in& to) {
    sendto(fd, bytes, static_cast<std::size_t>(size), 0, reinterpret_cast<const sockaddr*>(&to),
           sizeof to);
  }
  void Run() {
    gint64 moved_at = g_get_monotonic_time();
    while (!stop_) {
      pollfd fds[2 * kLinks];
      for (int i = 0; i < kLinks; ++i) {
        fds[i] = {doors_[i], POLLIN, 0};
        fds[kLinks + i] = {backs_[i], POLLIN, 0};
      }
      poll(fds, 2 * kLinks, 10);
      for (int i = 0; i < kLinks; ++i) {
        if ((fds[i].revents & POLLIN) != 0) PassMedia(i);
        if ((fds[kLinks + i].revents & POLLIN) != 0) PassFeedback(i);
      }
      const gint64 now = g_get_monotonic_time();
      if (moves_each_ms == 0 || now - moved_at < moves_each_ms * 1000) continue;
      moved_at = now;
      ++moves;
      close(std::exchange(backs_[1], Bind()));
    }
  }
  bool Lives(int link) { return !dark && (link != 1 || left-- > 0); }
  void PassMedia(int link) {
    char bytes[2'000];
    socklen_t size = sizeof senders_[link];
    const ssize_t n = recvfrom(doors_[link], bytes, sizeof bytes, 0,
                               reinterpret_cast<sockaddr*>(&senders_[link]), &size);
    if (n > 0 && !(loses && link == 1) && Lives(link)) Send(backs_[link], bytes, n, receiver_);
  }
  void PassFeedback(int link) {
    char bytes[2'000];
    const ssize_t n = recv(backs_[link], bytes, sizeof bytes, 0);
    const int to = swaps ? 1 - link : link;
    if (n > 0 && !(mutes && link == 1) && Lives(link) && senders_[to].sin_port != 0)
      Send(doors_[to], bytes, n, senders_[to]);
  }

  const sockaddr_in receiver_;
  int doors_[kLinks] = {};
  int backs_[kLinks] = {};
  sockaddr_in senders_[kLinks] = {};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace lidar::test
