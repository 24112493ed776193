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
  // If true, the publisher tries again after a refusal by the server or with wrong settings,
  // because both may be corrected later.
  bool keep_trying = false;
};

struct PublisherCounters {
  std::uint64_t messages = 0;      // sent to the server
  std::uint64_t bytes = 0;         // size of the buffers in `messages`
  std::uint64_t acknowledged = 0;  // stored by JetStream
  std::uint64_t resent = 0;
  std::uint64_t dropped = 0;    // for lack of memory, or not sent before stop
  std::uint64_t too_large = 0;  // larger than the server or its stream accepts
  std::uint64_t waiting = 0;    // to be sent or acknowledged
  std::uint64_t buffered = 0;   // bytes in the waiting messages
  std::uint64_t server_errors = 0;
  std::uint64_t refusals = 0;  // refused connections, if keep_trying is set
  unsigned reconnects = 0;
  bool connected = false;
};

/// Functions that threads of libnats and of the publisher call. The caller holds no lock.
struct PublisherEvents {
  Connection::Changed connection;
  /// Called when messages cannot be sent or stored, once for each reason.
  std::function<void(const std::string& why)> trouble;
};

class Publisher : public std::enable_shared_from_this<Publisher> {
 public:
  /// Starts a publisher. Returns null and sets `why` if the settings are wrong. If `keep_trying` is
  /// set, does not wait for the network.
  static std::shared_ptr<Publisher> Start(const PublisherSettings& settings, PublisherEvents events,
                                          std::string* why);
  /// Ends all threads. Messages that were not sent, or not acknowledged, count as dropped.
  void Stop();

  /// Adds a buffer to be sent, without waiting.
  void Add(gst::BufferPtr buffer, const StreamFormat::Ptr& format);
  enum class Drained { kAll, kTimeout, kInterrupted };
  /// Waits until all messages are sent and, with JetStream, acknowledged.
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
  /// The function that the callbacks of a subscription call.
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
  const std::optional<AnswerSubjects> answers_;  // missing if memory is short; Start() then fails
  // While the publisher's thread runs, only this thread uses the members from here to `untold_`.
  std::unique_ptr<Connection> connection_;  // null before the first connection, and after a refusal
  JetStreamPtr js_;
  SubscriptionPtr asks_;
  SubscriptionPtr acks_;
  std::vector<std::unique_ptr<Target>> untold_;  // targets without a completion callback
  std::thread thread_;

  mutable std::mutex mutex_;  // guards the members below; unlocked while sending or calling events_
  std::condition_variable wake_;
  std::condition_variable drained_;
  Outbox outbox_;
  PublisherCounters counters_;
  std::uint64_t next_number_ = 0;
  StreamFormat::Ptr format_;       // of the newest buffer
  StreamFormat::Ptr sent_format_;  // last published format
  Clock::time_point config_at_{};  // time when it was published
  std::uint64_t bytes_since_config_ = 0;
  Clock::time_point retry_at_{};              // earliest next try to make the stream
  Clock::time_point open_at_{};               // earliest next connect after a refusal
  Clock::time_point here_at_ = Clock::now();  // last time with a connection; initially the start
  Backoff refusals_{std::chrono::seconds(1), std::chrono::seconds(16)};
  unsigned connections_before_ = 0;  // connects of earlier Connection objects
  std::uint64_t errors_before_ = 0;
  unsigned connections_ = 0;  // number of connects at the last NoteConnection()
  std::string told_;          // last text that was given to events_.trouble
  bool asked_ = false;
  bool config_unanswered_ = false;
  bool stream_ready_ = false;
  bool stopping_ = false;
  bool draining_ = false;
  bool interrupted_ = false;
  unsigned interrupts_ = 0;
};

}  // namespace lidar::nats
