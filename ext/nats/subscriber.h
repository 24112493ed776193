// SPDX-License-Identifier: LGPL-2.1-or-later
// Takes messages of one stream from NATS: as they come, or as JetStream kept them.
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
  std::string queue_group;                  // empty: every message comes
  std::string stream;                       // of JetStream; empty: what is sent from now on
  std::string durable;                      // consumer; empty: one of this subscriber's own
  std::optional<std::uint64_t> start_time;  // [ns since 1970]; none: what is stored from now on
  std::uint64_t start_sequence = 0;         // of the first message, before start_time; 0: none
  int max_pending = 8 << 20;                // bytes that wait, without JetStream
};

/// A message, and what JetStream says of it.
struct Delivery {
  MessagePtr message;
  std::optional<std::uint64_t> stored;  // when [ns since 1970]
  std::uint64_t sequence = 0;           // in the stream; 0: not stored
  std::uint64_t to_come = 0;            // messages that are stored behind it
};

/// Used by one thread.
class Subscriber {
 public:
  /// Null, and `why`, where the settings are wrong.
  static std::unique_ptr<Subscriber> Open(const SubscriberSettings& settings,
                                          Connection::Changed changed, std::string* why);
  /// Waits until the server has the acknowledgements, for kConnectTimeoutMs at most.
  ~Subscriber();

  enum class Event {
    kMessage,
    kNothing,  // in this time
    kEmpty,    // JetStream has nothing, now that it was asked for the first time
    kTrouble,  // trouble(), which goes on
    kClosed,   // for good
  };
  Event Next(std::chrono::milliseconds timeout, Delivery* delivery);
  const std::string& trouble() const { return trouble_; }
  ConnectionState connection() const { return connection_->state(); }
  /// For a durable consumer: the message need not come again.
  void Acknowledge(natsMsg* message);
  bool acknowledges() const { return !settings_.durable.empty(); }

  /// The format of that id. Where it is not known, the sender is asked for it; null at a timeout.
  StreamFormat::Ptr Format(const std::string& id, std::chrono::milliseconds timeout);
  /// Messages that came faster than they were taken.
  std::uint64_t overruns() const { return overruns_; }
  /// Formats that are none of natssink's, or damaged.
  std::uint64_t damaged_formats() const { return book_.damaged(); }

 private:
  explicit Subscriber(SubscriberSettings settings) : settings_(std::move(settings)) {}
  bool stored() const { return !settings_.stream.empty(); }

  Event Renew();
  natsStatus SubscribeLive();
  natsStatus SubscribeStored(jsErrCode* code);
  natsStatus SubscribeOwn(jsErrCode* code);
  natsStatus SubscribeDurable(jsErrCode* code);
  natsStatus AddDurable(jsErrCode* code);
  void SetStart(jsConsumerConfig* config) const;
  Event NoteStored(Delivery* delivery);
  void CountOverruns();
  void TakeFormats(std::chrono::milliseconds wait);
  void AskForFormat();

  const SubscriberSettings settings_;
  std::unique_ptr<Connection> connection_;
  JetStreamPtr js_;
  SubscriptionPtr messages_;  // after those that they need
  SubscriptionPtr configs_;
  FormatBook book_;
  std::string trouble_;
  std::chrono::steady_clock::time_point renew_at_{};  // not before
  unsigned connections_ = 0;                          // as the subscriptions know them
  unsigned missed_heartbeats_ = 0;
  bool stale_ = false;             // the consumer missed something
  std::uint64_t last_stored_ = 0;  // number in the stream of what came last
  std::uint64_t last_number_ = 0;  // of the consumer
  bool began_ = false;
  std::uint64_t overruns_ = 0;
  std::int64_t dropped_ = 0;  // by the subscription there is
};

}  // namespace lidar::nats
