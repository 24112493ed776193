// SPDX-License-Identifier: LGPL-2.1-or-later
// Sends buffers to NATS in a thread of its own, so that no caller waits for the network.
#pragma once
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "ext/nats/answers.h"
#include "ext/nats/connection.h"
#include "ext/nats/jetstream.h"
#include "ext/nats/message.h"
#include "ext/nats/outbox.h"
#include "src/base/backoff.h"

namespace lidar::nats {

struct PublisherSettings {
  ConnectionSettings connection;
  std::string subject;
  StreamSettings stream;
  std::size_t max_buffered = 8U << 20;  // bytes
  // Tries again after refusals and wrong settings, which may be mended later.
  bool keep_trying = false;
};

struct PublisherCounters {
  std::uint64_t messages = 0;      // handed to the server
  std::uint64_t bytes = 0;         // of buffers in them
  std::uint64_t acknowledged = 0;  // stored by JetStream
  std::uint64_t resent = 0;
  std::uint64_t dropped = 0;    // dropped for lack of room or at stop
  std::uint64_t too_large = 0;  // for the server or its stream
  std::uint64_t waiting = 0;    // to be sent or acknowledged
  std::uint64_t buffered = 0;   // bytes in the waiting messages
  std::uint64_t server_errors = 0;
  std::uint64_t refusals = 0;  // by the server, with keep_trying
  unsigned reconnects = 0;
  bool connected = false;
};

/// Called without a lock, by threads of libnats and of the publisher.
struct PublisherEvents {
  Connection::Changed connection;
  /// Called once per reason while messages cannot be sent or stored.
  std::function<void(const std::string& why)> trouble;
};

class Publisher : public std::enable_shared_from_this<Publisher> {
 public:
  /// Returns null and sets `why` if the settings are wrong. With `keep_trying` it does not wait for
  /// the network.
  static std::shared_ptr<Publisher> Start(const PublisherSettings& settings, PublisherEvents events,
                                          std::string* why);
  /// Ends all threads; counts what was not sent as dropped.
  void Stop();

  /// Never waits.
  void Add(gst::BufferPtr buffer, const StreamFormat::Ptr& format);
  enum class Drained { kAll, kTimeout, kInterrupted };
  /// Waits until all is sent and, with JetStream, acknowledged.
  Drained Drain(Duration timeout);
  void Interrupt(bool on);

  PublisherCounters counters() const;

 private:
  using Lock = std::unique_lock<std::mutex>;
  using Clock = Outbox::Clock;

  Publisher(PublisherSettings settings, PublisherEvents events);
  bool Open(std::string* why);
  bool StartThread(std::string* why);
  void Close();
  /// The target of a subscription's callbacks.
  struct Target {
    std::weak_ptr<Publisher> publisher;
    void (Publisher::*call)(natsMsg*);
  };
  bool Subscribe(const std::string& subject, void (Publisher::*call)(natsMsg*),
                 SubscriptionPtr* out, std::string* why);
  void OnAsk(natsMsg* message);
  void OnAck(natsMsg* message);
  void NoteTooLarge(Lock* lock, std::optional<std::uint64_t> number);

  void Run();
  void Step(Lock* lock);
  void NoteConnection(const ConnectionState& state);
  void OpenAgain(Lock* lock);
  std::vector<std::string> KeptSubjects() const;
  void RetryAfterReconnect(Lock* lock);
  void PrepareStream(Lock* lock);
  void SendAllAgain();
  void RetryUnanswered(Clock::time_point now);
  StreamFormat::Ptr NextFormat() const;
  bool ConfigDue(Clock::time_point now) const;
  void SendConfig(Lock* lock);
  void SendNext(Lock* lock);
  void NoteSent(natsStatus status, std::uint64_t number, std::size_t bytes);
  void FinishDrain(Lock* lock);
  void Tell(Lock* lock, const std::string& why);
  bool Done() const {
    return outbox_.empty() && !config_unanswered_ && NextFormat() == sent_format_;
  }
  bool keeps() const { return !settings_.stream.name.empty(); }

  const PublisherSettings settings_;
  const PublisherEvents events_;
  const std::uint64_t run_;
  const std::optional<AnswerSubjects> answers_;  // missing if memory is short; then nothing starts
  // The publisher's thread owns these while it runs.
  std::unique_ptr<Connection> connection_;  // null before the first connection, and after a refusal
  JetStreamPtr js_;
  SubscriptionPtr asks_;
  SubscriptionPtr acks_;
  std::vector<std::unique_ptr<Target>> untold_;  // of subscriptions without a completion callback
  std::thread thread_;

  mutable std::mutex mutex_;  // guards what follows; never held while sending or calling events_
  std::condition_variable wake_;
  std::condition_variable drained_;
  Outbox outbox_;
  PublisherCounters counters_;
  std::uint64_t next_number_ = 0;
  StreamFormat::Ptr format_;       // of the newest buffer
  StreamFormat::Ptr sent_format_;  // last published format
  Clock::time_point config_at_{};  // time of its publication
  std::uint64_t bytes_since_config_ = 0;
  Clock::time_point retry_at_{};              // earliest next try to make the stream
  Clock::time_point open_at_{};               // earliest next connect after a refusal
  Clock::time_point here_at_ = Clock::now();  // last time with a server, initially the start
  Backoff refusals_{std::chrono::seconds(1), std::chrono::seconds(16)};
  unsigned connections_before_ = 0;  // of earlier Connection objects
  std::uint64_t errors_before_ = 0;
  unsigned connections_ = 0;  // number of connects at the last NoteConnection()
  std::string told_;          // last trouble that was reported
  bool asked_ = false;
  bool config_unanswered_ = false;
  bool stream_ready_ = false;
  bool stopping_ = false;
  bool draining_ = false;
  bool interrupted_ = false;
  unsigned interrupts_ = 0;
};

}  // namespace lidar::nats
