// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs TLS handshakes. Only a few run at the same time, because each occupies a thread of GIO until
// its peer answers. The next handshake is one of the address with the fewest connections. A
// thousand stalled connections of one address therefore delay only that address.
#pragma once
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <string>

#include "ext/web/glib_ptr.h"

namespace lidar::web {

/// Lives in the server's thread, and its sources run in that thread's default context.
class Handshakes {
 public:
  using Done = std::function<void(GSocketConnection*, GIOStream* secure)>;
  /// Calls `done` for each connection whose handshake succeeds. Closes the other connections.
  explicit Handshakes(Done done) : done_(std::move(done)) {}
  ~Handshakes();
  Handshakes(const Handshakes&) = delete;
  Handshakes& operator=(const Handshakes&) = delete;

  /// Queues a handshake. It starts after the first byte of the peer has arrived, when not too many
  /// other handshakes are running.
  void Begin(ObjectPtr<GSocketConnection> connection, GTlsCertificate* certificate);
  /// Removes a connection that was closed.
  void Forget(GSocketConnection* connection);
  /// Must be called once a second. Ends handshakes that take too long.
  void Tick(gint64 now_us);

 private:
  /// The numbers of connections of an address.
  struct Count {
    int all = 0;
    int running = 0;
  };
  using Counts = std::map<std::string, Count>;
  struct Entry {
    Handshakes* owner = nullptr;  // null if the owner was deleted
    ObjectPtr<GSocketConnection> connection;
    ObjectPtr<GTlsCertificate> certificate;
    ObjectPtr<GIOStream> secure;  // null until the handshake starts
    ObjectPtr<GCancellable> cancel;
    SourcePtr readable;
    Counts::iterator address;
    bool is_ready = false;
    gint64 since_us = 0;  // time at which the handshake started
  };
  using EntryPtr = std::shared_ptr<Entry>;
  static gboolean OnReadable(GSocket*, GIOCondition, gpointer entry);
  static void OnShaken(GObject* stream, GAsyncResult* result, gpointer entry);
  void StartMore();
  /// Returns the entry whose handshake starts next, or null if no entry is ready.
  EntryPtr Next() const;
  void Start(const EntryPtr& entry);
  void Remove(const EntryPtr& entry);
  void Finish(const EntryPtr& entry, bool is_secure);

  const Done done_;
  std::list<EntryPtr> entries_;  // the oldest first
  Counts counts_;                // by address of entries_
};

}  // namespace lidar::web
