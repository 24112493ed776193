// SPDX-License-Identifier: LGPL-2.1-or-later
// TLS handshakes, few at a time, because each occupies a thread of GIO while its peer is slow. The
// address with the fewest connections is next, so a thousand stalled connections of one address
// delay only that address.
#pragma once
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <string>

#include "ext/web/glib_ptr.h"

namespace lidar::web {

/// Lives in the server's thread, and uses that thread's default context.
class Handshakes {
 public:
  using Done = std::function<void(GSocketConnection*, GIOStream* secure)>;
  /// `done` gets each connection whose handshake succeeds. The others are closed.
  explicit Handshakes(Done done) : done_(std::move(done)) {}
  ~Handshakes();
  Handshakes(const Handshakes&) = delete;
  Handshakes& operator=(const Handshakes&) = delete;

  /// Waits for the first byte of the peer, and for its turn.
  void Begin(ObjectPtr<GSocketConnection> connection, GTlsCertificate* certificate);
  /// Drops a connection that was closed.
  void Forget(GSocketConnection* connection);
  /// Call it once a second: ends handshakes that take too long.
  void Tick(gint64 now_us);

 private:
  /// Connections of an address.
  struct Count {
    int all = 0;
    int running = 0;
  };
  using Counts = std::map<std::string, Count>;
  struct Entry {
    Handshakes* owner = nullptr;  // null: it was deleted
    ObjectPtr<GSocketConnection> connection;
    ObjectPtr<GTlsCertificate> certificate;
    ObjectPtr<GIOStream> secure;  // null until the handshake starts
    ObjectPtr<GCancellable> cancel;
    SourcePtr readable;
    Counts::iterator address;
    bool is_ready = false;
    gint64 since_us = 0;  // start of the handshake
  };
  using EntryPtr = std::shared_ptr<Entry>;
  static gboolean OnReadable(GSocket*, GIOCondition, gpointer entry);
  static void OnShaken(GObject* stream, GAsyncResult* result, gpointer entry);
  void StartMore();
  /// The entry whose turn it is; null if the queue is empty.
  EntryPtr Next() const;
  void Start(const EntryPtr& entry);
  void Remove(const EntryPtr& entry);
  void Finish(const EntryPtr& entry, bool is_secure);

  const Done done_;
  std::list<EntryPtr> entries_;  // the oldest first
  Counts counts_;                // of the addresses of entries_
};

}  // namespace lidar::web
