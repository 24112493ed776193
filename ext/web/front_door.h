// SPDX-License-Identifier: LGPL-2.1-or-later
// Accepts connections for a SoupServer, and keeps few of those that say nothing.
#pragma once
#include <libsoup/soup.h>

#include <list>
#include <string>

#include "ext/web/glib_ptr.h"

namespace lidar::web {

/// Lives in the server's thread.
class FrontDoor {
 public:
  /// At most `max_waiting` connections that are no WebSocket stay open; the oldest give way.
  FrontDoor(SoupServer* server, std::size_t max_waiting);
  ~FrontDoor();
  FrontDoor(const FrontDoor&) = delete;
  FrontDoor& operator=(const FrontDoor&) = delete;

  /// The port, or 0 and why not.
  guint16 Listen(GInetAddress* address, guint16 port, std::string* error);
  /// The connection of this request is a WebSocket from now on.
  void Promote(SoupServerMessage* request);
  /// Once a second: ends what took too long.
  void Tick(gint64 now_us);
  guint64 evicted() const { return evicted_; }

 private:
  struct Visitor {
    FrontDoor* door = nullptr;
    GSocketConnection* connection = nullptr;  // not owned: a weak reference
    ObjectPtr<GSocketAddress> peer;
    gint64 since_us = 0;
  };
  static gboolean OnIncoming(GSocketService*, GSocketConnection*, GObject*, gpointer self);
  static void OnGone(gpointer visitor, GObject*);
  void Accept(GSocketConnection* connection);
  void Evict(Visitor* visitor);

  SoupServer* const server_;
  const std::size_t max_waiting_;
  ObjectPtr<GSocketService> service_;
  std::list<Visitor> waiting_;  // the oldest first
  guint64 evicted_ = 0;
};

}  // namespace lidar::web
