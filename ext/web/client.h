// SPDX-License-Identifier: LGPL-2.1-or-later
// A WebSocket connection: reads requests, and writes its outbox as fast as the peer takes it.
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

/// Lives in the server's thread, whose default context it uses.
class Client {
 public:
  struct Handlers {
    std::function<void(Client*, const std::vector<std::uint8_t>& text)> on_text;
    std::function<void(Client*)> on_garbage;  // bytes that are not a message of the protocol
    std::function<void(Client*)> on_closed;   // the last call; the owner deletes the client later
  };
  struct Counters {
    std::uint64_t messages = 0;
    std::uint64_t bytes = 0;  // handed to the system
  };

  Client(ObjectPtr<GIOStream> stream, Handlers handlers,
         gint64 (*clock_us)() = g_get_monotonic_time);
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Queues a control text, in order. A client that lets too many wait is closed.
  void SendText(const std::string& text);
  /// Queues a message; at most `depth` of its channel wait. Returns how many of them were dropped,
  /// which may include the new one.
  std::size_t Send(Outbox::Item item, std::size_t depth);
  /// Notes that a message of the channel is not sent to this client.
  void Skip(std::uint32_t channel) { outbox_.Skip(channel); }
  /// Queues a slice, in order. The caller paces slices by the client's acknowledgements, so a
  /// client that lets too many wait broke the protocol and is closed. `replay` is the number of the
  /// replay to which the slice belongs, or 0 if it is live.
  void SendSlice(std::uint32_t channel, std::uint32_t subscription, SharedSliceMessage slice,
                 std::uint16_t replay = 0);
  /// Drops the messages and slices of the channel that wait.
  void Forget(std::uint32_t channel);
  /// Sends the close frame, if the peer takes it, and ends the connection.
  void Close(foxglove::CloseCode code);
  bool closed() const { return closed_; }

  /// Call it once a second: sends a ping, and closes the connection after too long without an
  /// answer or progress.
  void Tick();

  /// The grant of its token; kept by the owner.
  Grant grant;
  /// Subscription ids by channel; kept by the owner.
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
  /// Returns the bytes written; 0 if the peer takes no more, or after an error, which closes the
  /// connection.
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
