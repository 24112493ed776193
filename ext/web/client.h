// SPDX-License-Identifier: LGPL-2.1-or-later
// A WebSocket connection: reads requests, and writes messages as fast as the peer receives them.
#pragma once
#include <deque>
#include <functional>
#include <map>
#include <optional>

#include "ext/web/glib_ptr.h"
#include "ext/web/grant.h"
#include "ext/web/outbox.h"
#include "src/foxglove/websocket.h"

namespace lidar::web {

/// A client of the server. It may be used only in the server's thread, and its sources run in that
/// thread's default context.
class Client {
 public:
  struct Handlers {
    std::function<void(Client*, const std::vector<std::uint8_t>& text)> on_text;
    std::function<void(Client*)> on_garbage;  // bytes that are not a message of the protocol
    std::function<void(Client*)> on_closed;   // called last; the owner deletes the client later
  };
  struct Counters {
    std::uint64_t messages = 0;
    std::uint64_t bytes = 0;  // written to the socket
  };

  Client(ObjectPtr<GIOStream> stream, Handlers handlers,
         gint64 (*clock_us)() = g_get_monotonic_time);
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Queues a control text. Texts are sent in order. The connection is closed if too many texts are
  /// waiting.
  void SendText(const std::string& text);
  /// Queues a message. At most `depth` messages of its channel may wait. Returns the number of
  /// dropped messages, which may include the new one.
  std::size_t Send(Outbox::Item item, std::size_t depth);
  /// Notes that a message of the channel is not sent to this client. Messages that continue it are
  /// then dropped.
  void Skip(std::uint32_t channel) { outbox_.Skip(channel); }
  /// Queues a slice. Slices are sent in order. The caller sends slices only as the client
  /// acknowledges them. A client with too many waiting slices has therefore broken the protocol,
  /// and its connection is closed. `replay` is the number of the replay to which the slice belongs,
  /// or 0 for a live slice.
  void SendSlice(std::uint32_t channel, std::uint32_t subscription, SharedSliceMessage slice,
                 std::uint16_t replay = 0);
  /// Drops the waiting messages and slices of the channel.
  void Forget(std::uint32_t channel);
  /// Sends a close frame if the socket accepts it now, and ends the connection.
  void Close(foxglove::CloseCode code);
  bool closed() const { return closed_; }

  /// Must be called once a second. Sends a ping to a silent client. Closes the connection if there
  /// is no answer or no progress for too long.
  void Tick();

  /// The rights of the client's token. The owner of the client sets them.
  Grant grant;
  /// The subscription ids by channel. The owner of the client keeps them up to date.
  std::map<std::uint32_t, std::uint32_t> subscriptions;
  const Counters& counters() const { return counters_; }

 private:
  struct Outgoing {
    std::vector<std::uint8_t> head;
    std::shared_ptr<const std::vector<std::uint8_t>> body;  // null for a control frame
    std::size_t sent = 0;
    std::size_t Size() const { return head.size() + (body ? body->size() : 0); }
  };
  struct WaitingSlice {
    std::uint32_t channel = 0;
    std::uint32_t subscription = 0;
    SharedSliceMessage slice;
    std::uint16_t replay = 0;
  };
  static gboolean OnReadable(GObject*, gpointer self);
  static gboolean OnWritable(GObject*, gpointer self);
  void Read();
  void Handle(const foxglove::ClientMessage& message);
  void SendFrame(std::vector<std::uint8_t> frame);
  void Write();
  bool TakeNext();
  bool TakeControl();
  bool TakeSlice();
  bool TakeMessage();
  void Begin(const foxglove::MessageHead& head, ByteView more,
             std::shared_ptr<const std::vector<std::uint8_t>> body);
  /// Returns the number of bytes that were written. Returns 0 if the socket's buffer is full. Also
  /// returns 0 after an error, which closes the connection.
  std::size_t WriteSome(const Outgoing& out);
  void WaitForRoom();
  void End();

  const ObjectPtr<GIOStream> stream_;
  const Handlers handlers_;
  gint64 (*const clock_us_)();
  SourcePtr readable_;
  SourcePtr writable_;
  foxglove::MessageReader reader_;
  std::deque<std::vector<std::uint8_t>> controls_;
  std::optional<std::vector<std::uint8_t>> pong_;  // only the newest ping needs an answer
  std::deque<WaitingSlice> slices_;
  Outbox outbox_;
  std::optional<Outgoing> current_;
  Counters counters_;
  gint64 heard_us_;
  gint64 asked_us_ = 0;
  gint64 progress_us_;
  bool closed_ = false;
};

}  // namespace lidar::web
