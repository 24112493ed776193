// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/nats/subscriber.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "ext/nats/message.h"

namespace lidar::nats {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kRenewInterval{500};
constexpr milliseconds kAskInterval{200};
constexpr milliseconds kDoneInterval{200};
constexpr milliseconds kConfigWait{10};
constexpr int kMaxPendingMessages = 65'536;
constexpr int kMaxPendingConfigs = 64;
constexpr int kMaxPendingConfigBytes = 1 << 20;
constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::int64_t kAckWaitNs = 2 * kSecondNs;
constexpr std::int64_t kMaxUnacknowledged = 32;  // messages; more might wait longer than kAckWaitNs
constexpr int kMaxPendingUnacknowledged = 256;   // messages, if another client made the consumer

/// Rounds `time` down to a whole second if its fraction is below 0.1 s. libnats 3.4 writes such a
/// fraction wrongly: .012 s becomes .12 s.
std::int64_t SafeTime(std::uint64_t time) {
  const auto ns = static_cast<std::int64_t>(time);
  const std::int64_t fraction = ns % kSecondNs;
  return fraction < kSecondNs / 10 ? ns - fraction : ns;
}

}  // namespace

std::unique_ptr<Subscriber> Subscriber::Open(const SubscriberSettings& settings,
                                             Connection::Changed changed, std::string* why) {
  std::unique_ptr<Subscriber> self(new Subscriber(settings, std::move(changed)));
  return self->Connect(why) ? std::move(self) : nullptr;
}

bool Subscriber::Connect(std::string* why) {
  auto connection = Connection::Open(settings_.connection, changed_, why);
  if (!connection) return false;
  connection_ = std::move(connection);
  natsStatus status = NATS_OK;
  if (stored()) {
    js_ = OpenJetStream(connection_->get());
    if (!js_) status = NATS_NO_MEMORY;
  } else {
    status = SubscribeLive();
    // Waits until the server has the subscriptions, so that they get all messages that are
    // published after Connect() returns.
    if (connection_->state().connected())
      natsConnection_FlushTimeout(connection_->get(), Connection::kConnectTimeoutMs);
  }
  // A closed connection is not an error here, because Next() reports it or connects again.
  if (status == NATS_OK || natsConnection_IsClosed(connection_->get())) return true;
  *why = ErrorText(status);
  return false;
}

Subscriber::~Subscriber() {
  // Waits until the server has all acknowledgements. They could be lost if the socket were closed
  // while it has unread messages.
  if (connection_ && acknowledges() && connection_->state().connected())
    natsConnection_FlushTimeout(connection_->get(), Connection::kConnectTimeoutMs);
  if (connection_) connection_->Close();
}

/// Subscribes to live messages and formats. libnats renews these subscriptions after a reconnect.
natsStatus Subscriber::SubscribeLive() {
  natsSubscription* raw = nullptr;
  const std::string configs = ConfigSubject(settings_.subject, "*");
  natsStatus s = natsConnection_SubscribeSync(&raw, connection_->get(), configs.c_str());
  configs_ = Own(raw);
  if (s == NATS_OK)
    s = natsSubscription_SetPendingLimits(raw, kMaxPendingConfigs, kMaxPendingConfigBytes);
  raw = nullptr;
  if (s == NATS_OK)
    s = settings_.queue_group.empty()
            ? natsConnection_SubscribeSync(&raw, connection_->get(), settings_.subject.c_str())
            : natsConnection_QueueSubscribeSync(&raw, connection_->get(), settings_.subject.c_str(),
                                                settings_.queue_group.c_str());
  messages_ = Own(raw);
  if (s == NATS_OK)
    s = natsSubscription_SetPendingLimits(raw, kMaxPendingMessages, settings_.max_pending);
  return s;
}

void Subscriber::SetStart(jsConsumerConfig* config) const {
  const std::uint64_t first = next_ > 0 ? next_ : settings_.start_sequence;
  if (first > 0) {
    config->OptStartSeq = first;
    config->DeliverPolicy = js_DeliverByStartSequence;
  } else if (!settings_.start_time) {
    config->DeliverPolicy = js_DeliverNew;
  } else if (*settings_.start_time == 0) {
    config->DeliverPolicy = js_DeliverAll;
  } else {
    config->OptStartTime = SafeTime(*settings_.start_time);
  }
}

/// Makes a temporary consumer, which begins after the last message that was received. The consumer
/// ends together with this subscriber.
natsStatus Subscriber::SubscribeOwn(jsErrCode* code) {
  jsSubOptions options;
  jsSubOptions_Init(&options);
  options.Stream = settings_.stream.c_str();
  options.Config.AckPolicy = js_AckNone;
  options.Config.FlowControl = true;
  options.Config.Heartbeat = kSecondNs;
  options.Config.MemoryStorage = true;
  options.Config.Replicas = 1;
  SetStart(&options.Config);
  natsSubscription* raw = nullptr;
  const natsStatus s =
      js_SubscribeSync(&raw, js_.get(), settings_.subject.c_str(), nullptr, &options, code);
  messages_ = Own(raw);
  return s;
}

natsStatus Subscriber::AddDurable(jsErrCode* code) {
  natsInbox* raw = nullptr;
  natsStatus s = natsInbox_Create(&raw);
  const InboxPtr inbox(raw);
  if (s != NATS_OK) return s;
  jsConsumerConfig config;
  jsConsumerConfig_Init(&config);
  config.Durable = settings_.durable.c_str();
  config.DeliverSubject = inbox.get();
  config.DeliverGroup = settings_.queue_group.empty() ? nullptr : settings_.queue_group.c_str();
  config.FilterSubject = settings_.subject.c_str();
  config.AckPolicy = js_AckExplicit;
  config.AckWait = kAckWaitNs;
  config.MaxAckPending = kMaxUnacknowledged;
  SetStart(&config);
  if (config.OptStartTime > 0) config.DeliverPolicy = js_DeliverByStartTime;
  return js_AddConsumer(nullptr, js_.get(), settings_.stream.c_str(), &config, nullptr, code);
}

/// Subscribes to the durable consumer, and makes the consumer if it does not exist. The consumer
/// stays on the server when the subscription ends.
natsStatus Subscriber::SubscribeDurable(jsErrCode* code) {
  jsConsumerInfo* raw_info = nullptr;
  natsStatus s = js_GetConsumerInfo(&raw_info, js_.get(), settings_.stream.c_str(),
                                    settings_.durable.c_str(), nullptr, code);
  const ConsumerInfoPtr info(raw_info);
  if (s == NATS_NOT_FOUND) s = AddDurable(code);
  if (s != NATS_OK) return s;
  jsSubOptions options;
  jsSubOptions_Init(&options);
  options.Stream = settings_.stream.c_str();
  options.Consumer = settings_.durable.c_str();
  options.Queue = settings_.queue_group.empty() ? nullptr : settings_.queue_group.c_str();
  options.ManualAck = true;
  natsSubscription* raw = nullptr;
  s = js_SubscribeSync(&raw, js_.get(), settings_.subject.c_str(), nullptr, &options, code);
  messages_ = Own(raw);
  if (s != NATS_OK) return s;
  // Messages beyond these limits are dropped here. The server sends them again, because they are
  // not acknowledged. The limits have room for the largest message.
  const std::int64_t largest = natsConnection_GetMaxPayload(connection_->get());
  const auto bytes = std::max<std::int64_t>(settings_.max_pending, 2 * largest);
  return natsSubscription_SetPendingLimits(
      raw, kMaxPendingUnacknowledged, static_cast<int>(std::min<std::int64_t>(bytes, G_MAXINT)));
}

natsStatus Subscriber::SubscribeStored(jsErrCode* code) {
  jsSubOptions options;
  jsSubOptions_Init(&options);
  options.Stream = settings_.stream.c_str();
  options.Config.AckPolicy = js_AckNone;
  options.Config.DeliverPolicy = js_DeliverLastPerSubject;
  options.Config.MemoryStorage = true;
  options.Config.Replicas = 1;
  natsSubscription* raw = nullptr;
  const std::string configs = ConfigSubject(settings_.subject, "*");
  const natsStatus s = js_SubscribeSync(&raw, js_.get(), configs.c_str(), nullptr, &options, code);
  configs_ = Own(raw);
  if (s != NATS_OK) return s;
  natsSubscription_SetPendingLimits(raw, kMaxPendingConfigs, kMaxPendingConfigBytes);
  return settings_.durable.empty() ? SubscribeOwn(code) : SubscribeDurable(code);
}

/// Checks if the stream was deleted and made again since the last call. If it was, the next message
/// is the first message of the new stream, because the numbers of the old stream are invalid.
natsStatus Subscriber::NoteStream() {
  jsStreamInfo* raw = nullptr;
  const natsStatus s =
      js_GetStreamInfo(&raw, js_.get(), settings_.stream.c_str(), nullptr, nullptr);
  const StreamInfoPtr info(raw);
  if (s != NATS_OK) return s;
  const std::int64_t before = std::exchange(created_, info->Created);
  if (before != 0 && before != created_) next_ = 1;
  return s;
}

/// Returns true if the server answers. If it does not answer, Renew() would otherwise wait for the
/// timeout of each request and of each subscription that it ends.
bool Subscriber::Answers() const {
  return natsConnection_FlushTimeout(connection_->get(), kRequestTimeoutMs) == NATS_OK;
}

/// Makes a new consumer of JetStream, because the server may have lost the last consumer. Runs
/// after each connect, and after a missed message or heartbeat.
Subscriber::Event Subscriber::Renew() {
  const auto now = steady_clock::now();
  if (now < renew_at_) {
    std::this_thread::sleep_for(
        std::min<steady_clock::duration>(renew_at_ - now, milliseconds(50)));
    return Event::kNothing;
  }
  renew_at_ = now + kRenewInterval;
  const ConnectionState state = connection_->state();
  if (!state.connected() || !Answers()) return Event::kNothing;
  messages_.reset();
  configs_.reset();
  last_number_ = 0;
  dropped_ = 0;
  jsErrCode code{};
  natsStatus status = acknowledges() ? NATS_OK : NoteStream();
  if (status != NATS_TIMEOUT) status = SubscribeStored(&code);
  if (status != NATS_OK) {
    messages_.reset();
    trouble_ = status == NATS_NO_RESPONDERS ? "the server has no JetStream" : ErrorText(status);
    return Event::kTrouble;
  }
  stale_ = false;
  connections_ = state.connections;
  missed_heartbeats_ = state.missed_heartbeats;
  if (std::exchange(began_, true) || acknowledges()) return Event::kNothing;
  jsConsumerInfo* raw = nullptr;
  natsSubscription_GetConsumerInfo(&raw, messages_.get(), nullptr, nullptr);
  const ConsumerInfoPtr info(raw);
  if (!info || info->Delivered.Consumer != 0) return Event::kNothing;
  // The next consumer begins at this number if the server loses this consumer before its first
  // message.
  next_ = info->Delivered.Stream + 1;
  return Event::kNothing;
}

void Subscriber::CountOverruns() {
  std::int64_t dropped = 0;
  if (natsSubscription_GetDropped(messages_.get(), &dropped) != NATS_OK || dropped <= dropped_)
    return;
  overruns_ += static_cast<std::uint64_t>(dropped - dropped_);
  dropped_ = dropped;
}

/// Fills in `delivery`. If a message before this one is missing, marks the consumer as stale, so
/// that a new consumer begins after the last good message.
Subscriber::Event Subscriber::NoteStored(Delivery* delivery) {
  jsMsgMetaData* raw = nullptr;
  if (natsMsg_GetMetaData(&raw, delivery->message.get()) != NATS_OK) return Event::kNothing;
  const MetaDataPtr meta(raw);
  if (!acknowledges()) {
    if (meta->Sequence.Consumer != last_number_ + 1) {
      stale_ = true;
      return Event::kNothing;
    }
    last_number_ = meta->Sequence.Consumer;
    next_ = meta->Sequence.Stream + 1;
    if (settings_.start_sequence == 0 && settings_.start_time &&
        meta->Timestamp < static_cast<std::int64_t>(*settings_.start_time))
      return Event::kNothing;  // see SafeTime()
  }
  delivery->stored = static_cast<std::uint64_t>(std::max<std::int64_t>(meta->Timestamp, 0));
  delivery->sequence = meta->Sequence.Stream;
  delivery->to_come = meta->NumPending;
  return Event::kMessage;
}

/// Returns true if the stream has no further messages. Asks the server, because only the server
/// knows of removed messages, of messages that it will send again, and of messages that other
/// members of the queue group have not acknowledged.
bool Subscriber::IsDone() {
  const auto now = steady_clock::now();
  if (!settings_.seeks_end || now < is_done_at_) return false;
  is_done_at_ = now + kDoneInterval;
  jsConsumerInfo* raw = nullptr;
  if (acknowledges())
    js_GetConsumerInfo(&raw, js_.get(), settings_.stream.c_str(), settings_.durable.c_str(),
                       nullptr, nullptr);
  else
    natsSubscription_GetConsumerInfo(&raw, messages_.get(), nullptr, nullptr);
  const ConsumerInfoPtr info(raw);
  return info && info->NumPending == 0 && info->NumAckPending == 0 &&
         (acknowledges() || info->Delivered.Consumer == last_number_);
}

Subscriber::Event Subscriber::ConnectAgain(milliseconds pause) {
  std::this_thread::sleep_for(pause);
  messages_.reset();
  configs_.reset();
  js_.reset();
  std::string why;
  return Connect(&why) ? Event::kNothing : Event::kClosed;
}

Subscriber::Event Subscriber::Next(milliseconds timeout, Delivery* delivery) {
  const ConnectionState state = connection_->state();
  if (state.unanswered) return ConnectAgain(timeout);
  if (state.closed) return Event::kClosed;
  if (stored() && (!messages_ || stale_ || state.connections != connections_ ||
                   state.missed_heartbeats != missed_heartbeats_))
    return Renew();
  if (!stored() && state.connections != connections_) {
    connections_ = state.connections;
    AskForFormat();
  }
  TakeFormats({});
  natsMsg* raw = nullptr;
  const natsStatus s = natsSubscription_NextMsg(&raw, messages_.get(), timeout.count());
  delivery->message.reset(raw);
  if (s == NATS_SLOW_CONSUMER) CountOverruns();
  if (s == NATS_MISMATCH) stale_ = true;
  // Waits a moment. The reason is in the state of the connection, which may be updated only later.
  if (!messages_ || s == NATS_CONNECTION_CLOSED) std::this_thread::sleep_for(timeout);
  if (s == NATS_TIMEOUT && stored() && state.connected() && IsDone()) return Event::kEmpty;
  if (s != NATS_OK || raw == nullptr) return Event::kNothing;
  return stored() ? NoteStored(delivery) : Event::kMessage;
}

void Subscriber::Acknowledge(natsMsg* message) { natsMsg_Ack(message, nullptr); }

void Subscriber::TakeFormats(milliseconds wait) {
  natsMsg* raw = nullptr;
  // Limits the number of formats per call, because a flood of formats would delay the messages.
  for (int left = kMaxPendingConfigs;
       left > 0 && configs_ &&
       natsSubscription_NextMsg(&raw, configs_.get(), wait.count()) == NATS_OK;
       --left) {
    const MessagePtr message(raw);
    wait = {};
    book_.Note(natsMsg_GetSubject(raw),
               {natsMsg_GetData(raw), static_cast<std::size_t>(natsMsg_GetDataLength(raw))});
  }
}

void Subscriber::AskForFormat() {
  const std::string subject = AskSubject(settings_.subject);
  natsConnection_Publish(connection_->get(), subject.c_str(), nullptr, 0);
}

StreamFormat::Ptr Subscriber::Format(const std::string& id, milliseconds timeout) {
  TakeFormats({});
  StreamFormat::Ptr format = book_.Find(id);
  const auto deadline = steady_clock::now() + timeout;
  // JetStream may keep more formats than `book_`.
  if (!format && stored() && timeout > milliseconds{})
    format = book_.Fetch(js_.get(), settings_.stream, ConfigSubject(settings_.subject, id));
  auto ask_at = steady_clock::now();
  while (!format && steady_clock::now() < deadline) {
    if (!stored() && steady_clock::now() >= ask_at) {
      AskForFormat();
      ask_at += kAskInterval;
    }
    TakeFormats(kConfigWait);
    format = book_.Find(id);
  }
  return format;
}

}  // namespace lidar::nats
