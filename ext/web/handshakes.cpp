// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/web/handshakes.h"

#include <algorithm>

namespace lidar::web {
namespace {

/// The number of handshakes at the same time. Each of them occupies a thread, and GIO has ten
/// threads.
constexpr int kAtOnce = 8;
constexpr int kOfAnAddress = 3;
constexpr gint64 kLongestHandshake_us = 10 * gint64{G_USEC_PER_SEC};
/// The longest time for a handshake while other handshakes wait. It allows for a round trip over a
/// slow link.
constexpr gint64 kLongestWhileOthersWait_us = gint64{G_USEC_PER_SEC};

std::string AddressOf(GSocketConnection* connection) {
  const ObjectPtr<GSocketAddress> peer(g_socket_connection_get_remote_address(connection, nullptr));
  if (!peer || !G_IS_INET_SOCKET_ADDRESS(peer.get())) return "";
  gchar* text = g_inet_address_to_string(
      g_inet_socket_address_get_address(G_INET_SOCKET_ADDRESS(peer.get())));
  std::string copy = text;
  g_free(text);
  return copy;
}

/// Makes a connection as g_tls_server_connection_new() does, but without a database. No client
/// presents a certificate, and reading the system's certificate authorities would take milliseconds
/// per connection.
ObjectPtr<GIOStream> NewServerConnection(GSocketConnection* connection,
                                         GTlsCertificate* certificate) {
  const GType type = g_tls_backend_get_server_connection_type(g_tls_backend_get_default());
  return ObjectPtr<GIOStream>(static_cast<GIOStream*>(
      g_initable_new(type, nullptr, nullptr, "base-io-stream", connection, "certificate",
                     certificate, "database", nullptr, nullptr)));
}

}  // namespace

/// Cancels the running handshakes. They end later, without their owner.
Handshakes::~Handshakes() {
  for (const EntryPtr& entry : entries_) {
    entry->owner = nullptr;
    entry->readable.reset();
    g_cancellable_cancel(entry->cancel.get());
  }
}

void Handshakes::Begin(ObjectPtr<GSocketConnection> connection, GTlsCertificate* certificate) {
  auto entry = std::make_shared<Entry>();
  entry->owner = this;
  entry->address = counts_.try_emplace(AddressOf(connection.get())).first;
  ++entry->address->second.all;
  entry->connection = std::move(connection);
  entry->certificate = Ref(certificate);
  entry->cancel.reset(g_cancellable_new());
  entry->readable.reset(g_socket_create_source(
      g_socket_connection_get_socket(entry->connection.get()), G_IO_IN, nullptr));
  g_source_set_callback(entry->readable.get(), G_SOURCE_FUNC(OnReadable), entry.get(), nullptr);
  g_source_attach(entry->readable.get(), g_main_context_get_thread_default());
  entries_.push_back(std::move(entry));
}

gboolean Handshakes::OnReadable(GSocket*, GIOCondition, gpointer data) {
  auto* entry = static_cast<Entry*>(data);
  entry->is_ready = true;
  Handshakes* owner = entry->owner;
  entry->readable.reset();
  owner->StartMore();
  return G_SOURCE_REMOVE;
}

Handshakes::EntryPtr Handshakes::Next() const {
  EntryPtr next;
  for (const EntryPtr& entry : entries_) {
    const Count& count = entry->address->second;
    if (!entry->is_ready || entry->secure || count.running >= kOfAnAddress) continue;
    if (!next || count.all < next->address->second.all) next = entry;
  }
  return next;
}

void Handshakes::StartMore() {
  const auto running = [this] {
    int sum = 0;
    for (const auto& [address, count] : counts_) sum += count.running;
    return sum;
  };
  while (running() < kAtOnce) {
    const EntryPtr next = Next();
    if (!next) return;
    Start(next);
  }
}

void Handshakes::Start(const EntryPtr& entry) {
  entry->since_us = g_get_monotonic_time();
  entry->secure = NewServerConnection(entry->connection.get(), entry->certificate.get());
  if (!entry->secure) return Finish(entry, false);
  ++entry->address->second.running;
  // Does not require a close notification, because browsers close connections without it.
  g_tls_connection_set_require_close_notify(G_TLS_CONNECTION(entry->secure.get()), FALSE);
  g_tls_connection_handshake_async(G_TLS_CONNECTION(entry->secure.get()), G_PRIORITY_DEFAULT,
                                   entry->cancel.get(), OnShaken, new EntryPtr(entry));
}

void Handshakes::OnShaken(GObject* stream, GAsyncResult* result, gpointer data) {
  const std::unique_ptr<EntryPtr> entry(static_cast<EntryPtr*>(data));
  const bool good = g_tls_connection_handshake_finish(G_TLS_CONNECTION(stream), result, nullptr);
  if ((*entry)->owner != nullptr) (*entry)->owner->Finish(*entry, good);
}

void Handshakes::Remove(const EntryPtr& entry) {
  Count& count = entry->address->second;
  if (entry->secure) --count.running;
  if (--count.all == 0) counts_.erase(entry->address);
  entries_.remove(entry);
}

void Handshakes::Finish(const EntryPtr& entry, bool is_secure) {
  const EntryPtr keep = entry;
  Remove(keep);
  if (is_secure)
    done_(keep->connection.get(), keep->secure.get());
  else
    g_socket_shutdown(g_socket_connection_get_socket(keep->connection.get()), TRUE, TRUE, nullptr);
  StartMore();
}

void Handshakes::Forget(GSocketConnection* connection) {
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const EntryPtr& entry) {
    return entry->connection.get() == connection;
  });
  if (found == entries_.end()) return;
  if ((*found)->secure)
    g_cancellable_cancel((*found)->cancel.get());
  else
    Remove(EntryPtr(*found));
}

void Handshakes::Tick(gint64 now_us) {
  const std::list<EntryPtr> all = entries_;
  const gint64 longest_us = Next() ? kLongestWhileOthersWait_us : kLongestHandshake_us;
  for (const EntryPtr& entry : all)
    if (entry->secure && now_us - entry->since_us > longest_us)
      g_cancellable_cancel(entry->cancel.get());
}

}  // namespace lidar::web
