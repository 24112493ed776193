// SPDX-License-Identifier: LGPL-2.1-or-later
// Receives messages of one stream from NATS, live or kept by JetStream.
#pragma once
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "ext/nats/connection.h"
#include "ext/nats/format_book.h"
#include "ext/nats/jetstream.h"

namespace lidar::nats {

struct SubscriberSettings {
  ConnectionSettings connection;
  std::string subject;
  std::string queue_group;                  // empty: no group
  std::string stream;                       // JetStream's stream; empty: live
  std::string durable;                      // consumer; empty: a temporary one
  std::optional<std::uint64_t> start_time;  // [ns since 1970]; missing: now
  std::uint64_t start_sequence = 0;         // if not 0, used instead of start_time
  int max_pending = 8 << 20;                // most bytes that may wait, if live
  // If true, Next() returns kEmpty when the stream has no more messages. All messages must also be
  // acknowledged if the consumer is durable.
  bool seeks_end = false;
};

/// A message and its position in JetStream's stream.
struct Delivery {
  MessagePtr message;
  std::optional<std::uint64_t> stored;  // time of storage [ns since 1970]
  std::uint64_t sequence = 0;           // number in the stream; 0: not stored
  std::uint64_t to_come = 0;            // number of later messages in the stream
};

/// A subscription to one stream. Only one thread may use it.
class Subscriber {
 public:
  /// Opens a subscription. Returns null and sets `why` if the settings are wrong.
  static std::unique_ptr<Subscriber> Open(const SubscriberSettings& settings,
                                          Connection::Changed changed, std::string* why);
  /// Waits until the server has the acknowledgements, for kConnectTimeoutMs at most.
  ~Subscriber();

  enum class Event {
    kMessage,
    kNothing,  // no message arrived before the timeout
    kEmpty,    // see seeks_end
    kTrouble,  // trouble() describes it; the subscriber continues
    kClosed,   // libnats does not connect again
  };
  Event Next(std::chrono::milliseconds timeout, Delivery* delivery);
  const std::string& trouble() const { return trouble_; }
  ConnectionState connection() const { return connection_->state(); }
  /// Acknowledges a message of a durable consumer, so that the server does not send the message
  /// again.
  void Acknowledge(natsMsg* message);
  bool acknowledges() const { return !settings_.durable.empty(); }

  /// Returns the format `id`. If the format is unknown, requests it from the sender. Returns null
  /// if it has not arrived after `timeout`.
  StreamFormat::Ptr Format(const std::string& id, std::chrono::milliseconds timeout);
  /// Returns the number of messages that were dropped because they arrived faster than Next()
  /// returned them.
  std::uint64_t overruns() const { return overruns_; }
  /// Returns the number of formats that are damaged or not from a natssink.
  std::uint64_t damaged_formats() const { return book_.damaged(); }

 private:
  Subscriber(SubscriberSettings settings, Connection::Changed changed)
      : settings_(std::move(settings)), changed_(std::move(changed)) {}
  bool stored() const { return !settings_.stream.empty(); }
  SubscriptionPtr Own(natsSubscription* raw) const {
    return SubscriptionPtr(raw, {connection_->get()});
  }

  bool Connect(std::string* why);
  Event ConnectAgain(std::chrono::milliseconds pause);
  Event Renew();
  natsStatus SubscribeLive();
  natsStatus SubscribeStored(jsErrCode* code);
  natsStatus SubscribeOwn(jsErrCode* code);
  natsStatus SubscribeDurable(jsErrCode* code);
  natsStatus AddDurable(jsErrCode* code);
  void SetStart(jsConsumerConfig* config) const;
  bool Answers() const;
  natsStatus NoteStream();
  Event NoteStored(Delivery* delivery);
  bool IsDone();
  void CountOverruns();
  void TakeFormats(std::chrono::milliseconds wait);
  void AskForFormat();

  const SubscriberSettings settings_;
  const Connection::Changed changed_;
  std::unique_ptr<Connection> connection_;
  JetStreamPtr js_;
  SubscriptionPtr messages_;  // declared after the connection, because it is destroyed first
  SubscriptionPtr configs_;
  FormatBook book_;
  std::string trouble_;
  std::chrono::steady_clock::time_point renew_at_{};    // earliest next renewal
  std::chrono::steady_clock::time_point is_done_at_{};  // earliest next request of IsDone()
  unsigned connections_ = 0;                            // number of connections at the last renewal
  unsigned missed_heartbeats_ = 0;
  bool stale_ = false;        // the consumer missed a message
  std::int64_t created_ = 0;  // time when the stream was made; 0: unknown
  std::uint64_t next_ = 0;    // least possible number of the next message in the stream; 0: unknown
  std::uint64_t last_number_ = 0;  // the consumer's number for the last message
  bool began_ = false;
  std::uint64_t overruns_ = 0;
  std::int64_t dropped_ = 0;  // messages that the present subscription dropped
};

}  // namespace lidar::nats
