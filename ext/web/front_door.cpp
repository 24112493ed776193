// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/web/front_door.h"

#include <netinet/in.h>
#include <netinet/tcp.h>

#include <algorithm>

namespace lidar::web {
namespace {

/// The longest time for a request. Requests of the page take less time, even over a slow link.
constexpr gint64 kLongest_us = 60 * gint64{G_USEC_PER_SEC};
constexpr int kBacklog = 128;
/// The limit of unsent data in the kernel. Such data cannot be dropped, so they would become too
/// old.
constexpr gint kUnsentBytes = 128 * 1024;

std::string AddressOf(GSocketAddress* peer) {
  if (!G_IS_INET_SOCKET_ADDRESS(peer)) return "";
  gchar* text =
      g_inet_address_to_string(g_inet_socket_address_get_address(G_INET_SOCKET_ADDRESS(peer)));
  std::string copy = text;
  g_free(text);
  return copy;
}

}  // namespace

FrontDoor::FrontDoor(SoupServer* server, Certificate* certificate, Limits limits)
    : server_(server),
      certificate_(certificate),
      limits_(limits),
      handshakes_([this](auto* connection, auto* secure) { Enter(connection, secure); }),
      service_(g_socket_service_new()) {
  g_socket_service_stop(service_.get());
  g_socket_listener_set_backlog(G_SOCKET_LISTENER(service_.get()), kBacklog);
  g_signal_connect(service_.get(), "incoming", G_CALLBACK(OnIncoming), this);
}

FrontDoor::~FrontDoor() {
  g_signal_handlers_disconnect_by_data(service_.get(), this);
  g_socket_service_stop(service_.get());
  g_socket_listener_close(G_SOCKET_LISTENER(service_.get()));
  for (Visitor& visitor : waiting_)
    g_object_weak_unref(G_OBJECT(visitor.connection), OnGone, &visitor);
}

guint16 FrontDoor::Listen(GInetAddress* address, guint16 port, std::string* error) {
  const ObjectPtr<GSocketAddress> wanted(g_inet_socket_address_new(address, port));
  GSocketAddress* effective = nullptr;
  GError* raw_error = nullptr;
  const bool listens = g_socket_listener_add_address(
      G_SOCKET_LISTENER(service_.get()), wanted.get(), G_SOCKET_TYPE_STREAM, G_SOCKET_PROTOCOL_TCP,
      nullptr, &effective, &raw_error);
  const GErrorPtr owner(raw_error);
  if (!listens) {
    *error = raw_error->message;
    return 0;
  }
  const ObjectPtr<GSocketAddress> bound(effective);
  g_socket_service_start(service_.get());
  return g_inet_socket_address_get_port(G_INET_SOCKET_ADDRESS(bound.get()));
}

gboolean FrontDoor::OnIncoming(GSocketService*, GSocketConnection* connection, GObject*,
                               gpointer self) {
  static_cast<FrontDoor*>(self)->Accept(connection);
  return TRUE;
}

void FrontDoor::OnGone(gpointer data, GObject*) {
  auto* visitor = static_cast<Visitor*>(data);
  visitor->door->waiting_.remove_if([visitor](const Visitor& v) { return &v == visitor; });
}

void FrontDoor::Accept(GSocketConnection* connection) {
  GSocketAddress* remote = g_socket_connection_get_remote_address(connection, nullptr);
  ObjectPtr<GSocketAddress> peer(remote);
  if (remote == nullptr) return;  // the peer has closed the connection already
  GSocket* socket = g_socket_connection_get_socket(connection);
  g_socket_set_option(socket, IPPROTO_TCP, TCP_NODELAY, 1, nullptr);
  g_socket_set_option(socket, IPPROTO_TCP, TCP_NOTSENT_LOWAT, kUnsentBytes, nullptr);
  std::string address = AddressOf(remote);
  MakeRoom(address);
  waiting_.push_back(
      {this, connection, std::move(peer), std::move(address), g_get_monotonic_time()});
  g_object_weak_ref(G_OBJECT(connection), OnGone, &waiting_.back());
  if (certificate_ != nullptr)
    handshakes_.Begin(Ref(connection), certificate_->get());
  else
    Enter(connection, G_IO_STREAM(connection));
}

/// Closes the oldest connection of `address` if it has too many connections. Otherwise closes the
/// oldest of all connections if there are too many in total.
void FrontDoor::MakeRoom(const std::string& address) {
  const auto is_his = [&address](const Visitor& v) { return v.address == address; };
  const auto his =
      static_cast<std::size_t>(std::count_if(waiting_.begin(), waiting_.end(), is_his));
  if (his >= limits_.of_an_address)
    Evict(&*std::find_if(waiting_.begin(), waiting_.end(), is_his));
  else if (waiting_.size() >= limits_.all)
    Evict(&waiting_.front());
}

/// Makes the SoupServer read requests from `stream`.
void FrontDoor::Enter(GSocketConnection* connection, GIOStream* stream) {
  const auto visitor =
      std::find_if(waiting_.begin(), waiting_.end(),
                   [connection](const Visitor& v) { return v.connection == connection; });
  if (visitor == waiting_.end()) return;
  const ObjectPtr<GSocketAddress> local(g_socket_connection_get_local_address(connection, nullptr));
  if (!local) return;  // the peer has closed the connection already
  GError* error = nullptr;
  soup_server_accept_iostream(server_, stream, local.get(), visitor->peer.get(), &error);
  const GErrorPtr owner(error);
}

/// Shuts the connection down. The SoupServer then sees the end of the stream and drops the
/// connection.
void FrontDoor::Evict(Visitor* visitor) {
  GSocketConnection* connection = visitor->connection;
  g_object_weak_unref(G_OBJECT(connection), OnGone, visitor);
  g_socket_shutdown(g_socket_connection_get_socket(connection), TRUE, TRUE, nullptr);
  waiting_.remove_if([visitor](const Visitor& v) { return &v == visitor; });
  handshakes_.Forget(connection);
  ++evicted_;
}

void FrontDoor::Promote(SoupServerMessage* request) {
  GSocketAddress* peer = soup_server_message_get_remote_address(request);
  const auto found = std::find_if(waiting_.begin(), waiting_.end(),
                                  [peer](const Visitor& v) { return v.peer.get() == peer; });
  if (found == waiting_.end()) return;
  g_object_weak_unref(G_OBJECT(found->connection), OnGone, &*found);
  waiting_.erase(found);
}

void FrontDoor::Tick(gint64 now_us) {
  handshakes_.Tick(now_us);
  while (!waiting_.empty() && now_us - waiting_.front().since_us > kLongest_us)
    Evict(&waiting_.front());
}

}  // namespace lidar::web
