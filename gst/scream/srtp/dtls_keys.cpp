// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/srtp/dtls_keys.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "gst/common/buffer_map.h"
#include "gst/common/monotonic_time.h"
#include "gst/scream/rtp_packet.h"
#include "gst/scream/srtp/dtls_hello.h"

namespace lidar::gst {
namespace {

constexpr std::chrono::milliseconds kDtlsTick{100};
// A client ends an unanswered handshake after this time and begins another, because DTLS doubles
// the pause before each repetition. A client that has a key begins a new handshake if its media get
// no answer for this time.
constexpr std::chrono::seconds kDtlsPatience{5};
constexpr std::chrono::seconds kDtlsPause{1};  // least time between two handshakes of a client
// A server keeps a handshake for this time, because its last datagram may be lost and must then be
// repeated.
constexpr std::chrono::seconds kServerKeeps{10};

}  // namespace

DtlsKeys::DtlsKeys(const Certificates& certificates, bool is_client, Calls calls)
    : certificates_(certificates), is_client_(is_client), calls_(std::move(calls)) {}

DtlsKeys::~DtlsKeys() { Stop(); }

void DtlsKeys::Start() {
  if (thread_ != nullptr) return;
  stop_ = false;
  if (heard_at_) heard_at_ = MonotonicTime();
  thread_ = g_thread_new(
      "dtls",
      [](gpointer self) -> gpointer {
        static_cast<DtlsKeys*>(self)->Run();
        return nullptr;
      },
      this);
}

void DtlsKeys::Stop() {
  if (thread_ == nullptr) return;
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
    wake_.notify_one();
  }
  g_thread_join(std::exchange(thread_, nullptr));
  sessions_.clear();
}

void DtlsKeys::Take(GstBuffer* datagram) {
  const std::lock_guard lock(mutex_);
  if (waiting_.size() >= kMaxWaiting) {
    ++dropped_;
    return;
  }
  waiting_.emplace_back(gst_buffer_ref(datagram));
  wake_.notify_one();
}

void DtlsKeys::Run() {
  std::unique_lock lock(mutex_);
  while (!stop_) {
    std::deque<BufferPtr> taken = std::exchange(waiting_, {});
    lock.unlock();
    for (const BufferPtr& datagram : taken) {
      Process(datagram.get());
      Settle(MonotonicTime());
    }
    if (is_client_) BeginAsClient(MonotonicTime());
    Settle(MonotonicTime());
    lock.lock();
    const auto has_work = [this] { return stop_ || !waiting_.empty(); };
    if (is_client_ || !sessions_.empty())
      wake_.wait_for(lock, kDtlsTick, has_work);
    else
      wake_.wait(lock, has_work);
  }
}

void DtlsKeys::Process(GstBuffer* datagram) {
  GSocketAddress* from = SourceOf(datagram);
  if (from == nullptr) return;
  Session* session = nullptr;
  if (is_client_) {
    session = sessions_.empty() ? nullptr : &sessions_.back();
  } else {
    session = SessionOf(HelloIn(BufferMap(datagram, GST_MAP_READ).view()), from);
  }
  if (session == nullptr) return;
  // While this thread holds the lock, the last datagram of a server waits in Send(). The key is
  // therefore in use before the client gets this datagram and sends media.
  const std::lock_guard lock(session->route->mutex);
  session->handshake->Take(datagram);
  TakeKey(session);
}

void DtlsKeys::TakeKey(Session* session) {
  if (session->has_key || session->handshake->state() != DtlsHandshake::State::kDone) return;
  session->has_key = true;
  ++handshakes_;
  told_of_stranger_ = told_of_silence_ = false;
  calls_.on_key(session->handshake->key());
  heard_at_ = MonotonicTime();
  seen_ = calls_.traffic();
}

/// Returns the session to which a datagram belongs, or null. A new hello begins a session. If a
/// hello is known but comes from another address, this address is another link of the same peer and
/// is added to the session.
DtlsKeys::Session* DtlsKeys::SessionOf(const std::string& hello, GSocketAddress* from) {
  const Time now = MonotonicTime();
  const auto is_of = [from](const Session& session) {
    const std::lock_guard lock(session.route->mutex);
    const Addresses& known = session.route->addresses;
    return std::any_of(known.begin(), known.end(),
                       [from](const auto& a) { return SameAddress(a.get(), from); });
  };
  Session* session = nullptr;
  for (Session& s : sessions_)
    if (hello.empty() ? is_of(s) : s.hello == hello) session = &s;
  if (hello.empty()) return session;
  if (session == nullptr && hellos_.Take(now)) session = Begin(now, hello);
  if (session == nullptr || is_of(*session)) return session;
  const std::lock_guard lock(session->route->mutex);
  if (session->route->addresses.size() >= kMaxAddresses) return nullptr;
  session->route->addresses.push_back(RefAddress(from));
  return session;
}

DtlsKeys::Session* DtlsKeys::Begin(Time now, std::string hello) {
  if (sessions_.size() >= kMaxHandshakes) sessions_.pop_front();
  Session session;
  session.hello = std::move(hello);
  session.route = std::make_shared<Route>();
  session.began = now;
  session.handshake = DtlsHandshake::Start(
      certificates_, is_client_,
      [this, route = session.route](GstBuffer* datagram) { Send(route.get(), datagram); });
  if (!session.handshake) return nullptr;
  sessions_.push_back(std::move(session));
  return &sessions_.back();
}

/// Sends a datagram. A client sends its hello again before each later datagram, because the server
/// identifies a link by the hello, which may have been lost on that link.
void DtlsKeys::Send(Route* route, GstBuffer* datagram) {
  const BufferMap map(datagram, GST_MAP_READ);
  const std::lock_guard lock(route->mutex);
  if (!HelloIn(map.view()).empty()) route->hello.reset(gst_buffer_ref(datagram));
  if (route->hello && !IsOfHello(map.view())) calls_.send(route->hello.get(), route->addresses);
  calls_.send(datagram, route->addresses);
}

void DtlsKeys::BeginAsClient(Time now) {
  const SrtpTraffic traffic = calls_.traffic();
  if (heard_at_ && (traffic.passed > seen_.passed || traffic.sent == seen_.sent)) {
    heard_at_ = now;
    seen_ = traffic;
    sessions_.clear();
  }
  const bool is_silent = !heard_at_ || now - *heard_at_ > kDtlsPatience;
  if (!is_silent || !sessions_.empty() || now < paused_until_) return;
  paused_until_ = now + kDtlsPause;
  Begin(now, "");
}

void DtlsKeys::Settle(Time now) {
  for (auto session = sessions_.begin(); session != sessions_.end();)
    session = GoesOn(now, &*session) ? std::next(session) : sessions_.erase(session);
}

/// Returns false once the session is over.
bool DtlsKeys::GoesOn(Time now, Session* session) {
  using State = DtlsHandshake::State;
  const State state = session->handshake->state();
  const bool is_old = now - session->began > (is_client_ ? kDtlsPatience : kServerKeeps);
  if (state == State::kRefused) {
    ++refused_;
    WarnOnce(&told_of_stranger_,
             "The other end is refused: its certificate is not the one to trust.",
             "dtls-peer-certificate names the one to trust");
  } else if (state == State::kOpen && is_client_ && is_old) {
    WarnOnce(&told_of_silence_,
             "The other end does not answer the DTLS handshake, which is tried again.",
             "is the other end running, with dtls-certificate, and does it trust our certificate?");
  }
  const bool is_of_use = state == State::kOpen || (state == State::kDone && !is_client_);
  return is_of_use && !is_old;
}

void DtlsKeys::WarnOnce(bool* warned, const char* what, const char* to_do) {
  if (!std::exchange(*warned, true)) calls_.warn(what, to_do);
}

}  // namespace lidar::gst
