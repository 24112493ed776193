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
  std::uint64_t handshakes = 0;  // that brought a key
  std::uint64_t refused = 0;     // with another certificate than the one to trust
  std::uint64_t dropped = 0;     // datagrams that came while too many waited
  std::uint64_t unkeyed = 0;  // packets of media that came before there was a key, and were dropped
};

/// Number of packets that were protected, and number of packets that passed.
struct SrtpTraffic {
  std::uint64_t sent = 0;
  std::uint64_t passed = 0;
};

/// The end that sends media is the client: it sends its hello over all links, repeats it until
/// there is a key, and begins anew if its media stay unanswered, as after a restart of the other
/// end. The server answers each address that sent the same hello, so one live link is enough.
/// Repeated datagrams do no harm in DTLS. Slow work runs in a thread of its own.
class DtlsKeys {
 public:
  static constexpr std::size_t kMaxHandshakes = 4;  // of a server at a time
  static constexpr int kHellosPerSecond = 5;        // that begin a handshake of a server
  static constexpr std::size_t kMaxAddresses = 4;   // of a handshake
  static constexpr std::size_t kMaxWaiting = 64;    // datagrams of handshakes

  using Addresses = std::vector<SocketAddressPtr>;
  struct Calls {
    /// Sends a datagram to the addresses. A client's datagram has no addresses, and goes over all
    /// links.
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

  /// Shakes hands until Stop(): a client at once, a server as hellos come.
  void Start();
  /// Ends the thread, and forgets open handshakes.
  void Stop();
  /// Takes a datagram that has its source's address; any thread.
  void Take(GstBuffer* datagram);
  DtlsCounts counts() const { return {handshakes_, refused_, dropped_, 0}; }

 private:
  /// Data for the threads of dtlsenc: the addresses of a server's peer, or the first part of a
  /// client's hello.
  struct Route {
    std::mutex mutex;
    Addresses addresses;
    BufferPtr hello;
  };
  struct Session {
    std::string hello;  // of a server's peer
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
  std::optional<Time> heard_at_;  // last sign of the other end; none before the first key
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
