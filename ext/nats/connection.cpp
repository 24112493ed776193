// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/nats/connection.h"

#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

namespace lidar::nats {
namespace {

constexpr std::int64_t kReconnectWaitMs = 250;
constexpr std::int64_t kReconnectJitterMs = 250;  // spreads the reconnects of a fleet over time
constexpr std::int64_t kPingIntervalMs = 2'000;
constexpr int kMaxPingsOut = 2;
constexpr std::chrono::seconds kCloseTimeout{5};

std::vector<std::string> SplitUrls(const std::string& list) {
  std::vector<std::string> urls;
  std::istringstream in(list);
  for (std::string url; std::getline(in, url, ',');)
    if (!url.empty()) urls.push_back(url);
  return urls;
}

/// Checks the files and the secrets of the settings. Returns an error text, which is empty if there
/// is no error.
std::string CheckFiles(const ConnectionSettings& s) {
  for (const std::string* path :
       {&s.credentials_file, &s.tls_ca_file, &s.tls_cert_file, &s.tls_key_file})
    if (!path->empty() && access(path->c_str(), R_OK) != 0) return "cannot read " + *path;
  if (s.tls_cert_file.empty() != s.tls_key_file.empty())
    return "tls-cert-file and tls-key-file must be set together";
  if (!s.token.empty() && !s.credentials_file.empty())
    return "token and credentials-file cannot be set together";
  return "";
}

natsStatus SetSecurity(natsOptions* o, const ConnectionSettings& s) {
  natsStatus status = NATS_OK;
  if (!s.credentials_file.empty())
    status = natsOptions_SetUserCredentialsFromFiles(o, s.credentials_file.c_str(), nullptr);
  if (status == NATS_OK && !s.token.empty()) status = natsOptions_SetToken(o, s.token.c_str());
  if (status == NATS_OK && !s.tls_ca_file.empty())
    status = natsOptions_LoadCATrustedCertificates(o, s.tls_ca_file.c_str());
  if (status == NATS_OK && !s.tls_cert_file.empty())
    status = natsOptions_LoadCertificatesChain(o, s.tls_cert_file.c_str(), s.tls_key_file.c_str());
  // TLS is mandatory if certificates are set, so that nothing is sent to a server without TLS. TLS
  // is also mandatory if a URL begins with tls://, which libnats itself ignores.
  const bool tls = s.url.find("tls://") != std::string::npos || !s.tls_ca_file.empty() ||
                   !s.tls_cert_file.empty();
  if (status == NATS_OK && tls) status = natsOptions_SetSecure(o, true);
  return status;
}

natsStatus SetPace(natsOptions* o) {
  natsStatus s = natsOptions_SetTimeout(o, Connection::kConnectTimeoutMs);
  if (s == NATS_OK) s = natsOptions_SetAllowReconnect(o, true);
  if (s == NATS_OK) s = natsOptions_SetMaxReconnect(o, -1);
  if (s == NATS_OK) s = natsOptions_SetReconnectWait(o, kReconnectWaitMs);
  if (s == NATS_OK) s = natsOptions_SetReconnectJitter(o, kReconnectJitterMs, kReconnectJitterMs);
  if (s == NATS_OK) s = natsOptions_SetPingInterval(o, kPingIntervalMs);
  if (s == NATS_OK) s = natsOptions_SetMaxPingsOut(o, kMaxPingsOut);
  if (s == NATS_OK) s = natsOptions_SetWriteDeadline(o, Connection::kWriteTimeoutMs);
  // Sends each message at once. By default the flusher thread of libnats waits a millisecond for
  // more messages.
  if (s == NATS_OK) s = natsOptions_SetSendAsap(o, true);
  // Disables the buffer in which libnats keeps messages during a reconnect. JetStream would store
  // these messages before older messages that were lost with the connection and are sent again
  // later.
  if (s == NATS_OK) s = natsOptions_SetReconnectBufSize(o, 0);
  return s;
}

}  // namespace

struct Connection::Shared {
  std::mutex mutex;  // guards all members but `changed`; not locked while `changed` runs
  std::condition_variable ended;
  ConnectionState state;
  bool refused = false;  // a server refused the first connect
  bool over = false;     // OnClosed(), the last callback, has run
  Changed changed;

  void NoteFirst(natsStatus failure) {
    const std::lock_guard lock(mutex);
    refused = failure != NATS_NO_SERVER && failure != NATS_TIMEOUT && failure != NATS_IO_ERROR &&
              failure != NATS_CONNECTION_CLOSED;
    if (refused) state.last_error = ErrorText(failure);
  }

  template <class Change>
  void Update(Change change) {
    std::unique_lock lock(mutex);
    change(&state);
    const ConnectionState now = state;
    lock.unlock();
    if (changed) changed(now);
  }
};

namespace {

std::string LastError(natsConnection* nc, natsStatus otherwise) {
  const char* words = nullptr;
  const natsStatus last = natsConnection_GetLastError(nc, &words);
  const bool known = last != NATS_OK && words != nullptr && *words != '\0';
  return known ? words : natsStatus_GetText(otherwise);
}

/// The callbacks of libnats. `closure` points to a SharedPtr that belongs to the callbacks.
template <class SharedPtr>
struct Callbacks {
  static auto& Of(void* closure) { return **static_cast<SharedPtr*>(closure); }

  static void OnConnected(natsConnection*, void* closure) {
    Of(closure).Update([](ConnectionState* s) { ++s->connections; });
  }
  static void OnDisconnected(natsConnection*, void* closure) {
    Of(closure).Update([](ConnectionState* s) { ++s->disconnections; });
  }
  static void OnError(natsConnection* nc, natsSubscription*, natsStatus error, void* closure) {
    // Subscriber handles these errors. Both mean that it missed messages.
    if (error == NATS_SLOW_CONSUMER || error == NATS_MISMATCH) return;
    if (error == NATS_MISSED_HEARTBEAT)
      return Of(closure).Update([](ConnectionState* s) { ++s->missed_heartbeats; });
    const std::string text = LastError(nc, error);
    Of(closure).Update([&](ConnectionState* s) {
      ++s->errors;
      s->last_error = text;
    });
  }
  /// Runs as the last callback of a connection, and deletes `closure`.
  static void OnClosed(natsConnection* nc, void* closure) {
    const std::unique_ptr<SharedPtr> mine(static_cast<SharedPtr*>(closure));
    auto& shared = **mine;
    const std::string text = LastError(nc, NATS_CONNECTION_CLOSED);
    shared.Update([&](ConnectionState* s) {
      s->closed = true;
      s->unanswered = s->connections == 0 && !shared.refused;
      if (s->last_error.empty()) s->last_error = text;
    });
    const std::lock_guard lock(shared.mutex);
    shared.over = true;
    shared.ended.notify_all();
  }
};

}  // namespace

std::string WithoutUser(const std::string& urls) {
  std::string text;
  for (const std::string& url : SplitUrls(urls)) {
    const auto scheme = url.find("://");
    const auto begin = scheme == url.npos ? 0 : scheme + 3;
    const auto user = url.rfind('@');
    if (!text.empty()) text += ", ";
    text += user == url.npos ? url : url.substr(0, begin) + url.substr(user + 1);
  }
  return text;
}

std::string ErrorText(natsStatus status) {
  natsStatus last = NATS_OK;
  const char* words = nats_GetLastError(&last);
  if (last != status || words == nullptr || *words == '\0') return natsStatus_GetText(status);
  const std::string_view text = words;  // begins with libnats' file and line, such as "(a.c:7): "
  const auto place = text.front() == '(' ? text.find("): ") : text.npos;
  return std::string(place == text.npos ? text : text.substr(place + 3));
}

natsStatus Connection::Connect(natsOptions* o) {
  using Call = Callbacks<SharedPtr>;
  auto closure = std::make_unique<SharedPtr>(shared_);
  natsStatus s = natsOptions_SetClosedCB(o, Call::OnClosed, closure.get());
  if (s == NATS_OK) s = natsOptions_SetDisconnectedCB(o, Call::OnDisconnected, closure.get());
  if (s == NATS_OK) s = natsOptions_SetReconnectedCB(o, Call::OnConnected, closure.get());
  if (s == NATS_OK) s = natsOptions_SetErrorHandler(o, Call::OnError, closure.get());
  if (s != NATS_OK) return s;
  const natsStatus first = natsConnection_Connect(&nc_, o);
  if (first != NATS_OK) {
    shared_->NoteFirst(first);
    // Enables retries only for this second try, because with retries libnats does not report why a
    // server refused the connection.
    s = natsOptions_SetRetryOnFailedConnect(o, true, Call::OnConnected, closure.get());
    if (s == NATS_OK) s = natsConnection_Connect(&nc_, o);
  }
  if (nc_ == nullptr) return s;
  closure.release();  // OnClosed() deletes it
  if (s == NATS_OK) shared_->Update([](ConnectionState* state) { ++state->connections; });
  return NATS_OK;
}

std::unique_ptr<Connection> Connection::Open(const ConnectionSettings& settings, Changed changed,
                                             std::string* why) {
  *why = CheckFiles(settings);
  std::vector<std::string> urls = SplitUrls(settings.url);
  // If there is no URL, libnats would connect to the local machine.
  if (why->empty() && urls.empty()) *why = "url names no server";
  if (!why->empty()) return nullptr;
  std::vector<const char*> servers;
  for (const std::string& url : urls) servers.push_back(url.c_str());
  natsOptions* raw = nullptr;
  natsStatus s = natsOptions_Create(&raw);
  const OptionsPtr options(raw);
  if (s == NATS_OK)
    s = natsOptions_SetServers(raw, servers.data(), static_cast<int>(servers.size()));
  if (s == NATS_OK && !settings.name.empty()) s = natsOptions_SetName(raw, settings.name.c_str());
  if (s == NATS_OK) s = SetPace(raw);
  if (s == NATS_OK) s = SetSecurity(raw, settings);
  auto shared = std::make_shared<Shared>();
  shared->changed = std::move(changed);
  std::unique_ptr<Connection> connection(new Connection(std::move(shared)));
  natsStatistics* statistics = nullptr;
  if (s == NATS_OK) s = natsStatistics_Create(&statistics);
  connection->statistics_.reset(statistics);
  if (s == NATS_OK) s = connection->Connect(raw);
  if (s == NATS_OK) return connection;
  *why = ErrorText(s);
  return nullptr;
}

Connection::~Connection() {
  if (nc_ == nullptr) return;
  natsConnection_Destroy(nc_);
  std::unique_lock lock(shared_->mutex);
  if (!shared_->ended.wait_for(lock, kCloseTimeout, [this] { return shared_->over; })) return;
  lock.unlock();
  // Frees `changed` here, because the thread that ran OnClosed() may own `shared_` a moment longer.
  shared_->changed = nullptr;
}

ConnectionState Connection::state() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->state;
}

bool Connection::TakeReconnect() {
  std::uint64_t reconnects = 0;
  if (natsConnection_GetStats(nc_, statistics_.get()) == NATS_OK)
    natsStatistics_GetCounts(statistics_.get(), nullptr, nullptr, nullptr, nullptr, &reconnects);
  return reconnects != std::exchange(reconnects_, reconnects);
}

}  // namespace lidar::nats
