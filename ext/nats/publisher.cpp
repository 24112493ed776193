// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/nats/publisher.h"

#include <algorithm>
#include <string_view>
#include <system_error>
#include <utility>

namespace lidar::nats {
namespace {

constexpr std::chrono::milliseconds kConfigInterval{1'000};
constexpr std::chrono::milliseconds kAskedInterval{20};  // interval between answers to requests
constexpr std::chrono::milliseconds kStreamRetry{500};   // longest pause before a new try
constexpr gint kMinStreamRetryMs = 50;
constexpr std::chrono::milliseconds kAckTimeout{5'000};
constexpr std::chrono::milliseconds kPatrol{500};  // interval of checks for unanswered messages
constexpr const char* kConfigReply = "config";     // used instead of a message's number
constexpr std::size_t kMaxInFlight = 256;          // messages

/// Returns a random pause, so that several sinks do not change a stream at the same time.
std::chrono::milliseconds StreamPause() {
  return std::chrono::milliseconds(
      g_random_int_range(kMinStreamRetryMs, static_cast<gint>(kStreamRetry.count())));
}

}  // namespace

Publisher::Publisher(PublisherSettings settings, PublisherEvents events)
    : settings_(std::move(settings)),
      events_(std::move(events)),
      run_((std::uint64_t{g_random_int()} << 32) | g_random_int()),
      answers_(AnswerSubjects::Make()),
      outbox_(settings_.max_buffered) {}

std::shared_ptr<Publisher> Publisher::Start(const PublisherSettings& settings,
                                            PublisherEvents events, std::string* why) {
  std::shared_ptr<Publisher> publisher(new Publisher(settings, std::move(events)));
  if (!publisher->answers_) *why = "out of memory";
  const bool open = publisher->answers_ && (settings.keep_trying || publisher->Open(why)) &&
                    publisher->StartThread(why);
  if (!open) publisher->Stop();
  return open ? publisher : nullptr;
}

bool Publisher::StartThread(std::string* why) {
  try {
    thread_ = std::thread([this] { Run(); });
  } catch (const std::system_error&) {
    *why = "cannot start a thread";
    return false;
  }
  return true;
}

bool Publisher::Open(std::string* why) {
  const std::weak_ptr<Publisher> weak = weak_from_this();
  connection_ = Connection::Open(
      settings_.connection,
      [weak](const ConnectionState& state) {
        const auto self = weak.lock();
        if (!self) return;
        {
          const std::lock_guard lock(self->mutex_);
          self->wake_.notify_all();
        }
        if (self->events_.connection) self->events_.connection(state);
      },
      why);
  if (!connection_ || !Subscribe(AskSubject(settings_.subject), &Publisher::OnAsk, &asks_, why))
    return false;
  if (!keeps()) return true;
  js_ = OpenJetStream(connection_->get());
  if (js_) return Subscribe(answers_->All(), &Publisher::OnAck, &acks_, why);
  *why = "out of memory";
  return false;
}

void Publisher::Close() {
  if (connection_) connection_->Close();
  asks_.reset();
  acks_.reset();
  js_.reset();
  connection_.reset();
}

bool Publisher::Subscribe(const std::string& subject, void (Publisher::*call)(natsMsg*),
                          SubscriptionPtr* out, std::string* why) {
  const auto on_message = [](natsConnection*, natsSubscription*, natsMsg* raw, void* closure) {
    const MessagePtr message(raw);
    const auto& target = *static_cast<Target*>(closure);
    const auto self = target.publisher.lock();
    if (self) (self.get()->*target.call)(raw);
  };
  auto target = std::make_unique<Target>(Target{weak_from_this(), call});
  natsSubscription* raw = nullptr;
  const natsStatus s =
      natsConnection_Subscribe(&raw, connection_->get(), subject.c_str(), on_message, target.get());
  *out = SubscriptionPtr(raw, {connection_->get()});
  if (s == NATS_CONNECTION_CLOSED) return true;  // state() has the reason
  if (s != NATS_OK) {
    *why = ErrorText(s);
    return false;
  }
  // The callback may still run after the subscription has ended. The target is therefore deleted by
  // the completion callback. libnats does not accept a completion callback if the server has closed
  // the connection. In this case the publisher keeps the target.
  const natsStatus told = natsSubscription_SetOnCompleteCB(
      raw, [](void* closure) { delete static_cast<Target*>(closure); }, target.get());
  if (told != NATS_OK) untold_.push_back(std::move(target));
  target.release();
  return true;
}

void Publisher::Stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    wake_.notify_all();
    drained_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
  Close();
  const std::lock_guard lock(mutex_);
  counters_.dropped += outbox_.Clear();
  counters_.connected = false;
}

void Publisher::Add(gst::BufferPtr buffer, const StreamFormat::Ptr& format) {
  const std::lock_guard lock(mutex_);
  format_ = format;
  counters_.dropped += outbox_.Push({next_number_++, std::move(buffer), format});
  wake_.notify_all();
}

Publisher::Drained Publisher::Drain(Duration timeout) {
  Lock lock(mutex_);
  draining_ = true;
  wake_.notify_all();
  const unsigned before = interrupts_;
  const auto interrupted = [&] { return interrupted_ || interrupts_ != before || stopping_; };
  drained_.wait_for(lock, timeout, [&] { return !draining_ || interrupted(); });
  if (!std::exchange(draining_, false)) return Drained::kAll;
  return interrupted() ? Drained::kInterrupted : Drained::kTimeout;
}

void Publisher::Interrupt(bool on) {
  const std::lock_guard lock(mutex_);
  interrupted_ = on;
  if (on) ++interrupts_;  // counted, because the flag may be reset before Drain() sees it
  drained_.notify_all();
}

PublisherCounters Publisher::counters() const {
  const std::lock_guard lock(mutex_);
  PublisherCounters counters = counters_;
  counters.waiting = outbox_.waiting() + outbox_.in_flight();
  counters.buffered = outbox_.bytes();
  return counters;
}

void Publisher::OnAsk(natsMsg*) {
  const std::lock_guard lock(mutex_);
  asked_ = true;
  wake_.notify_all();
}

void Publisher::OnAck(natsMsg* message) {
  const std::string_view word = answers_->WordOf(message);
  const auto number = ToNumber(word);
  const bool is_config = word == kConfigReply;
  if (!is_config && !number) return;
  const std::string error = ErrorOfAck(message);
  const bool too_large = !error.empty() && IsTooLarge(message);
  Lock lock(mutex_);
  if (too_large) return NoteTooLarge(&lock, number);
  if (error.empty()) {
    if (is_config) {
      config_unanswered_ = false;
    } else {
      if (outbox_.Remove(*number)) ++counters_.acknowledged;
      told_.clear();
    }
  } else {
    // Sends all messages in flight again, so that JetStream stores them in order.
    SendAllAgain();
    retry_at_ = Clock::now() + StreamPause();
  }
  wake_.notify_all();
  if (!error.empty()) Tell(&lock, error);
}

/// Gives up the message `number`, or the caps if there is no number. Sending them again would not
/// help, because they exceed the stream's max_msg_size.
void Publisher::NoteTooLarge(Lock* lock, std::optional<std::uint64_t> number) {
  if (!number)
    config_unanswered_ = false;
  else if (outbox_.Remove(*number))
    ++counters_.too_large;
  wake_.notify_all();
  Tell(lock, std::string(number ? "A message is" : "The caps are") +
                 " larger than the stream allows (max_msg_size)");
}

void Publisher::Tell(Lock* lock, const std::string& why) {
  if (why == told_) return;
  told_ = why;
  lock->unlock();
  if (events_.trouble) events_.trouble(why);
  lock->lock();
}

void Publisher::Run() {
  Lock lock(mutex_);
  while (!stopping_) Step(&lock);
  lock.unlock();
  nats_ReleaseThreadMemory();
}

void Publisher::Step(Lock* lock) {
  const ConnectionState state = connection_ ? connection_->state() : ConnectionState();
  NoteConnection(state);
  if (connection_ && !state.connected() && !state.refused() && Clock::now() - here_at_ > kAbsence)
    Tell(lock, "No NATS server answers at " + WithoutUser(settings_.connection.url));
  if (!connection_ || state.unanswered || (state.closed && settings_.keep_trying))
    return OpenAgain(lock);
  if (!state.connected()) {
    wake_.wait_for(*lock, kPatrol);
    return;
  }
  here_at_ = Clock::now();
  RetryAfterReconnect(lock);
  if (stopping_) return;
  const auto now = Clock::now();
  RetryUnanswered(now);
  if (keeps() && !stream_ready_)
    PrepareStream(lock);
  else if (ConfigDue(now))
    SendConfig(lock);
  else if (outbox_.waiting() > 0 && outbox_.in_flight() < kMaxInFlight)
    SendNext(lock);
  else if (draining_ && Done())
    FinishDrain(lock);
  else
    wake_.wait_for(*lock, kPatrol);
}

void Publisher::NoteConnection(const ConnectionState& state) {
  const unsigned connections = connections_before_ + state.connections;
  counters_.connected = state.connected();
  counters_.reconnects = connections > 0 ? connections - 1 : 0;
  counters_.server_errors = errors_before_ + state.errors;
  if (connections == connections_ || !state.connected()) return;
  connections_ = connections;
  refusals_.Reset();
  open_at_ = Clock::now() + refusals_.Next();
}

/// If libnats has reconnected, sends the messages in flight again, before the waiting messages, so
/// that JetStream stores all of them in order.
void Publisher::RetryAfterReconnect(Lock* lock) {
  lock->unlock();
  const bool again = connection_->TakeReconnect();  // may wait for a write
  lock->lock();
  if (again) SendAllAgain();
}

/// Opens a new connection, because libnats gives up a connection after two refusals, or if the
/// server does not answer.
void Publisher::OpenAgain(Lock* lock) {
  if (Clock::now() < open_at_) {
    wake_.wait_until(*lock, open_at_);
    return;
  }
  if (connection_) {
    const ConnectionState state = connection_->state();
    connections_before_ += state.connections;
    errors_before_ += state.errors;
    if (state.refused()) ++counters_.refusals;
  }
  lock->unlock();
  Close();
  std::string why;
  const bool open = Open(&why);
  if (!open) Close();
  lock->lock();
  open_at_ = Clock::now() + refusals_.Next();
  SendAllAgain();
  if (!open) Tell(lock, "NATS cannot be used: " + why);
}

void Publisher::SendAllAgain() {
  counters_.resent += outbox_.RetryAll();
  stream_ready_ = false;
  sent_format_.reset();        // also sends the caps again
  config_unanswered_ = false;  // earlier requests get no answer
}

void Publisher::RetryUnanswered(Clock::time_point now) {
  const auto oldest = outbox_.OldestInFlight();
  const bool message = oldest && now - *oldest > kAckTimeout;
  const bool config = config_unanswered_ && now - config_at_ > kAckTimeout;
  if (message || config) SendAllAgain();  // the server may have deleted the stream
}

std::vector<std::string> Publisher::KeptSubjects() const {
  if (!settings_.stream.subjects.empty()) return {settings_.stream.subjects};
  return {settings_.subject, ConfigSubject(settings_.subject, "*")};
}

void Publisher::PrepareStream(Lock* lock) {
  const auto now = Clock::now();
  if (now < retry_at_) {
    wake_.wait_until(*lock, retry_at_);
    return;
  }
  lock->unlock();
  std::string why;
  const bool ready = EnsureStream(js_.get(), settings_.stream, KeptSubjects(), &why);
  lock->lock();
  stream_ready_ = ready;
  retry_at_ = Clock::now() + StreamPause();
  if (!ready)
    Tell(lock, "The stream " + settings_.stream.name + " cannot be created or updated: " + why);
}

/// Returns the format of the oldest waiting message, or of the newest buffer if no message waits.
StreamFormat::Ptr Publisher::NextFormat() const {
  const StreamFormat::Ptr waiting = outbox_.NextFormat();
  return waiting ? waiting : format_;
}

bool Publisher::ConfigDue(Clock::time_point now) const {
  const StreamFormat::Ptr format = NextFormat();
  if (!format) return false;
  if (format != sent_format_) return true;
  // Answers requests for the caps. Answers less often if JetStream keeps messages, because
  // JetStream also stores each answer.
  if (asked_ && now - config_at_ >= (keeps() ? kConfigInterval / 2 : kAskedInterval)) return true;
  // If the stream is small, JetStream could drop the caps before the messages that need them. The
  // caps are therefore sent again after a quarter of the stream's size.
  const std::uint64_t max_bytes = settings_.stream.max_bytes;
  const bool box_turns = keeps() && max_bytes > 0 && bytes_since_config_ > max_bytes / 4;
  return outbox_.waiting() > 0 && (box_turns || now - config_at_ >= kConfigInterval);
}

void Publisher::SendConfig(Lock* lock) {
  const StreamFormat::Ptr format = NextFormat();
  asked_ = false;
  sent_format_ = format;
  config_at_ = Clock::now();
  config_unanswered_ = keeps();
  bytes_since_config_ = 0;
  lock->unlock();
  const std::string subject = ConfigSubject(settings_.subject, format->id());
  const std::string& text = format->text();
  const auto size = static_cast<int>(text.size());
  const natsStatus status =
      keeps() ? natsConnection_PublishRequest(connection_->get(), subject.c_str(),
                                              answers_->Of(kConfigReply).c_str(), text.data(), size)
              : natsConnection_Publish(connection_->get(), subject.c_str(), text.data(), size);
  lock->lock();
  if (status != NATS_MAX_PAYLOAD) return;
  config_unanswered_ = false;
  Tell(lock, "The caps are larger than the server allows (max_payload)");
}

void Publisher::SendNext(Lock* lock) {
  const auto item = outbox_.Take(Clock::now());
  lock->unlock();
  const std::string reply = keeps() ? answers_->Of(item->number) : "";
  const Place place{run_, item->number};
  const MessagePtr message = WriteMessage(settings_.subject, keeps() ? reply.c_str() : nullptr,
                                          item->format->id(), place, item->buffer.get());
  const natsStatus status =
      message ? natsConnection_PublishMsg(connection_->get(), message.get()) : NATS_NO_MEMORY;
  lock->lock();
  NoteSent(status, item->number, gst_buffer_get_size(item->buffer.get()));
  if (status == NATS_MAX_PAYLOAD)
    Tell(lock, "A buffer is larger than the server allows (max_payload)");
  else if (status != NATS_OK)
    wake_.wait_for(*lock, kStreamRetry);  // libnats is about to give up the connection
}

void Publisher::NoteSent(natsStatus status, std::uint64_t number, std::size_t bytes) {
  if (status == NATS_OK) {
    ++counters_.messages;
    counters_.bytes += bytes;
    bytes_since_config_ += bytes;
    if (keeps()) return;
    outbox_.Remove(number);
    told_.clear();
  } else if (status == NATS_MAX_PAYLOAD) {
    ++counters_.too_large;
    outbox_.Remove(number);
  } else {
    counters_.resent += outbox_.Retry(number);
  }
}

void Publisher::FinishDrain(Lock* lock) {
  lock->unlock();
  const natsStatus status = natsConnection_FlushTimeout(connection_->get(), kRequestTimeoutMs);
  lock->lock();
  if (status != NATS_OK) wake_.wait_for(*lock, kPatrol);
  if (status != NATS_OK || !Done()) return;
  draining_ = false;
  drained_.notify_all();
}

}  // namespace lidar::nats
