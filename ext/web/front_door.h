// SPDX-License-Identifier: LGPL-2.1-or-later
// Accepts connections for a SoupServer, with TLS if there is a certificate. Limits the number of
// connections that are not WebSockets.
#pragma once
#include <libsoup/soup.h>

#include <list>
#include <string>

#include "ext/web/certificate.h"
#include "ext/web/glib_ptr.h"
#include "ext/web/handshakes.h"

namespace lidar::web {

/// Accepts connections. It may be used only in the server's thread.
class FrontDoor {
 public:
  /// The largest numbers of connections that are not WebSockets. If there are more, the oldest
  /// connection is closed.
  struct Limits {
    std::size_t all = 1000;
    std::size_t of_an_address = 32;  // a browser opens at most six
  };
  /// `certificate` may be null. If not, it must outlive this object.
  FrontDoor(SoupServer* server, Certificate* certificate, Limits limits);
  ~FrontDoor();
  FrontDoor(const FrontDoor&) = delete;
  FrontDoor& operator=(const FrontDoor&) = delete;

  /// Starts to listen. Returns the port. If listening fails, returns 0 and sets `error`.
  guint16 Listen(GInetAddress* address, guint16 port, std::string* error);
  /// Notes that the connection of this request is a WebSocket from now on, so the limits no longer
  /// apply to it.
  void Promote(SoupServerMessage* request);
  /// Must be called once a second. Closes connections that take too long.
  void Tick(gint64 now_us);
  guint64 evicted() const { return evicted_; }

 private:
  struct Visitor {
    FrontDoor* door = nullptr;
    GSocketConnection* connection = nullptr;  // a weak reference
    ObjectPtr<GSocketAddress> peer;
    std::string address;
    gint64 since_us = 0;
  };
  static gboolean OnIncoming(GSocketService*, GSocketConnection*, GObject*, gpointer self);
  static void OnGone(gpointer visitor, GObject*);
  void Accept(GSocketConnection* connection);
  void Enter(GSocketConnection* connection, GIOStream* stream);
  void MakeRoom(const std::string& address);
  void Evict(Visitor* visitor);

  SoupServer* const server_;
  Certificate* const certificate_;
  const Limits limits_;
  Handshakes handshakes_;
  ObjectPtr<GSocketService> service_;
  std::list<Visitor> waiting_;  // the oldest first
  guint64 evicted_ = 0;
};

}  // namespace lidar::web
