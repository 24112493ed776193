// SPDX-License-Identifier: LGPL-2.1-or-later
// Agrees on SRTP keys by DTLS over the sockets and links that carry the media (RFC 5764).
#pragma once
#include <gst/gst.h>

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "gst/common/certificates.h"
#include "gst/common/refs.h"
#include "gst/net/udp_socket.h"
#include "gst/scream/srtp/handshake.h"
#include "gst/scream/srtp/key.h"
#include "src/base/allowance.h"
#include "src/base/time.h"

namespace lidar::gst {

struct DtlsCounts {
  std::uint64_t handshakes = 0;  // that resulted in a key
  std::uint64_t refused = 0;     // because the peer's certificate was not the trusted one
  std::uint64_t dropped = 0;     // datagrams that arrived while too many waited
  std::uint64_t unkeyed = 0;     // media packets that were dropped, because there was no key yet
};

/// The number of packets that were protected, and the number of received packets that passed.
struct SrtpTraffic {
  std::uint64_t sent = 0;
  std::uint64_t passed = 0;
};

/// Negotiates the SRTP keys. The end that sends media is the client. It sends its hello over all
/// links, and repeats it until there is a key. If its media get no answer later, for example
/// because the other end was restarted, it begins a new handshake. The server answers each address
/// that has sent the same hello, so one working link is enough. DTLS tolerates repeated datagrams.
/// Slow work runs in a separate thread.
class DtlsKeys {
 public:
  static constexpr std::size_t kMaxHandshakes = 4;  // of a server at a time
  static constexpr int kHellosPerSecond = 5;        // for which a server begins a handshake
  static constexpr std::size_t kMaxAddresses = 4;   // of the peer in a handshake
  static constexpr std::size_t kMaxWaiting = 64;    // datagrams that wait to be processed

  using Addresses = std::vector<SocketAddressPtr>;
  struct Calls {
    /// Sends a datagram to the addresses. If this end is a client, there are no addresses, and the
    /// datagram is sent over all links.
    std::function<void(GstBuffer*, const Addresses&)> send;
    std::function<void(const SrtpKey&)> on_key;
    std::function<SrtpTraffic()> traffic;
    /// Posts a warning: what is wrong, and what to do about it.
    std::function<void(const char* what, const char* to_do)> warn;
  };

  DtlsKeys(const Certificates& certificates, bool is_client, Calls calls);
  ~DtlsKeys();
  DtlsKeys(const DtlsKeys&) = delete;
  DtlsKeys& operator=(const DtlsKeys&) = delete;

  /// Starts the thread, which runs handshakes until Stop(). A client begins a handshake at once. A
  /// server begins one when a hello arrives.
  void Start();
  /// Ends the thread, and drops unfinished handshakes.
  void Stop();
  /// Queues a received datagram, which must have its source address attached. Any thread may call
  /// it.
  void Take(GstBuffer* datagram);
  DtlsCounts counts() const { return {handshakes_, refused_, dropped_, 0}; }

 private:
  /// The data that threads of dtlsenc use: the addresses of the peer if this end is a server, or
  /// the first part of the hello if this end is a client.
  struct Route {
    std::mutex mutex;
    Addresses addresses;
    BufferPtr hello;
  };
  struct Session {
    std::string hello;  // the peer's hello, if this end is a server
    std::shared_ptr<Route> route;
    std::unique_ptr<DtlsHandshake> handshake;
    Time began{};
    bool has_key = false;
  };

  void Run();
  void Process(GstBuffer* datagram);
  void TakeKey(Session* session);
  Session* SessionOf(const std::string& hello, GSocketAddress* from);
  Session* Begin(Time now, std::string hello);
  void Send(Route* route, GstBuffer* datagram);
  void BeginAsClient(Time now);
  void Settle(Time now);
  bool GoesOn(Time now, Session* session);
  void WarnOnce(bool* warned, const char* what, const char* to_do);

  Certificates certificates_;
  bool is_client_;
  Calls calls_;

  std::mutex mutex_;  // guards the next three
  std::condition_variable wake_;
  std::deque<BufferPtr> waiting_;
  bool stop_ = false;

  // Used by the thread, and by other threads only while it does not run:
  std::deque<Session> sessions_;  // oldest first
  Allowance hellos_{kHellosPerSecond, Duration(std::chrono::seconds(1)) / kHellosPerSecond};
  // Time of the last sign of the other end; none before the first key.
  std::optional<Time> heard_at_;
  Time paused_until_{};
  SrtpTraffic seen_;
  bool told_of_stranger_ = false;
  bool told_of_silence_ = false;

  std::atomic<std::uint64_t> handshakes_{0};
  std::atomic<std::uint64_t> refused_{0};
  std::atomic<std::uint64_t> dropped_{0};
  GThread* thread_ = nullptr;
};

}  // namespace lidar::gst
