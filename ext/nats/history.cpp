// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/nats/history.h"

#include <algorithm>
#include <utility>

#include "ext/nats/jetstream.h"
#include "ext/nats/message.h"
#include "gst/lidar/gstlidar.h"

namespace lidar::nats {
namespace {

constexpr int kMostMessages = 4'096;  // per answer

struct StreamNames {
  jsStreamNamesList* list = nullptr;
  ~StreamNames() { jsStreamNamesList_Destroy(list); }
};
struct Messages {
  natsMsgList list{};
  ~Messages() { natsMsgList_Destroy(&list); }
};

guint64 StoredAt(std::int64_t time) {
  return static_cast<guint64>(std::max<std::int64_t>(time, 0));
}

guint64 CapturedAt(GstBuffer* buffer, guint64 stored) {
  const GstClockTime captured = gst_lidar_buffer_get_capture_time(buffer);
  return GST_CLOCK_TIME_IS_VALID(captured) ? captured : stored;
}

jsConsumerConfig FromStart() {
  jsConsumerConfig config;
  jsConsumerConfig_Init(&config);
  config.DeliverPolicy = js_DeliverAll;
  return config;
}

jsConsumerConfig FromPosition(guint64 position) {
  jsConsumerConfig config = FromStart();
  if (position == 0) return config;
  config.DeliverPolicy = js_DeliverByStartSequence;
  config.OptStartSeq = position;
  return config;
}

/// Returns a consumer that starts at the time `stored`, rounded down to a whole second. libnats 3.4
/// writes a fraction below 0.1 s wrongly: .012 s becomes .12 s.
jsConsumerConfig FromTime(guint64 stored) {
  jsConsumerConfig config = FromStart();
  const guint64 seconds = stored / GST_SECOND;
  if (seconds == 0) return config;
  config.DeliverPolicy = js_DeliverByStartTime;
  config.OptStartTime = static_cast<std::int64_t>(seconds * GST_SECOND);
  return config;
}

}  // namespace

History::History(ConnectionSettings connection, std::string subject, std::string stream)
    : settings_(std::move(connection)), subject_(std::move(subject)), stream_(std::move(stream)) {}

std::optional<gst::HistoryAnswer> History::Answer(const gst::HistoryQuestion& question) {
  const std::lock_guard lock(mutex_);
  if (!Find()) return std::nullopt;
  gst::HistoryAnswer answer;
  const natsStatus status = Fill(question, &answer);
  answer.unanswered = status != NATS_OK && status != NATS_NOT_FOUND;
  return answer;
}

/// Returns NATS_NOT_FOUND if the stream has no such messages, and another error if the server does
/// not answer.
natsStatus History::Fill(const gst::HistoryQuestion& question, gst::HistoryAnswer* answer) {
  Stored first;
  Stored last;
  natsStatus s = First(&first);
  if (s == NATS_OK) s = Last(&last);
  if (s != NATS_OK) return s;
  answer->from = first.captured;
  answer->to = std::max(last.captured, first.captured);
  if (question.most_bytes == 0) return s;
  const bool has_time = GST_CLOCK_TIME_IS_VALID(question.time);
  // JetStream finds messages by the time at which the server stored them. A capture time may be
  // later than that time, because the robot's clock may be ahead of the server's clock.
  const guint64 ahead = last.captured - std::min(last.captured, last.stored);
  answer->position = has_time ? 0 : question.position;
  std::vector<MessagePtr> messages;
  s = Fetch(has_time ? FromTime(question.time - std::min(question.time, ahead))
                     : FromPosition(question.position),
            kMostMessages, question.most_bytes, &messages);
  Take(messages, answer);
  return s;
}

/// Connects to the server and finds the stream that keeps the subject, unless the stream's name is
/// set. Returns false if there is no connection or no such stream.
bool History::Find() {
  std::string why;
  if (!connection_ || connection_->state().unanswered) {
    js_.reset();
    connection_ = Connection::Open(settings_, nullptr, &why);
  }
  if (!connection_ || !connection_->state().connected()) return false;
  if (!js_) js_ = OpenJetStream(connection_->get());
  if (!js_ || !stream_.empty()) return js_ != nullptr;
  jsOptions options;
  jsOptions_Init(&options);
  options.Wait = kRequestTimeoutMs;
  options.Stream.Info.SubjectsFilter = subject_.c_str();
  jsErrCode code{};
  StreamNames names;
  if (js_StreamNames(&names.list, js_.get(), &options, &code) == NATS_OK && names.list->Count > 0)
    stream_ = names.list->List[0];
  return !stream_.empty();
}

natsStatus History::Last(Stored* last) {
  natsMsg* raw = nullptr;
  jsErrCode code{};
  const natsStatus s =
      js_GetLastMsg(&raw, js_.get(), stream_.c_str(), subject_.c_str(), nullptr, &code);
  const MessagePtr message(raw);
  if (s != NATS_OK) return s;
  const guint64 stored = StoredAt(natsMsg_GetTime(raw));
  const auto read = Read(raw);
  *last = {stored, read ? CapturedAt(read->buffer.get(), stored) : stored};
  return s;
}

natsStatus History::First(Stored* first) {
  std::vector<MessagePtr> messages;
  natsStatus s = Fetch(FromStart(), 1, 0, &messages);
  jsMsgMetaData* raw = nullptr;
  if (s == NATS_OK) s = natsMsg_GetMetaData(&raw, messages.front().get());
  const MetaDataPtr meta(raw);
  if (s != NATS_OK) return s;
  const guint64 stored = StoredAt(meta->Timestamp);
  const auto read = Read(messages.front().get());
  *first = {stored, read ? CapturedAt(read->buffer.get(), stored) : stored};
  return s;
}

/// Adds at most `most` messages with about `most_bytes` in total, but at least one message if it
/// returns NATS_OK. Returns NATS_NOT_FOUND if there is no message.
natsStatus History::Fetch(jsConsumerConfig start, int most, guint64 most_bytes,
                          std::vector<MessagePtr>* messages) {
  jsSubOptions options;
  jsSubOptions_Init(&options);
  options.Stream = stream_.c_str();
  options.Config = start;
  options.Config.AckPolicy = js_AckNone;
  options.Config.MemoryStorage = true;
  options.Config.Replicas = 1;
  jsErrCode code{};
  natsSubscription* raw = nullptr;
  natsStatus s =
      js_PullSubscribe(&raw, js_.get(), subject_.c_str(), nullptr, nullptr, &options, &code);
  if (s != NATS_OK) return s;
  const SubscriptionPtr subscription(raw, {connection_->get()});
  // A request for messages times out if there are none, and if the server is slow.
  jsConsumerInfo* raw_info = nullptr;
  s = natsSubscription_GetConsumerInfo(&raw_info, raw, nullptr, &code);
  const ConsumerInfoPtr info(raw_info);
  if (s != NATS_OK) return s;
  if (info->NumPending == 0) return NATS_NOT_FOUND;
  // The server would send nothing if the first message were larger than MaxBytes.
  const std::int64_t largest = 2 * natsConnection_GetMaxPayload(connection_->get());
  jsFetchRequest request;
  jsFetchRequest_Init(&request);
  request.Batch = most;
  request.MaxBytes = std::max(static_cast<std::int64_t>(most_bytes), largest);
  request.Expires = kRequestTimeoutMs * 1'000'000;
  request.NoWait = true;
  Messages got;
  s = natsSubscription_FetchRequest(&got.list, raw, &request);
  for (int i = 0; i < got.list.Count; ++i)
    messages->emplace_back(std::exchange(got.list.Msgs[i], nullptr));
  return s;
}

void History::Take(const std::vector<MessagePtr>& messages, gst::HistoryAnswer* answer) {
  for (const MessagePtr& message : messages) {
    jsMsgMetaData* raw = nullptr;
    if (natsMsg_GetMetaData(&raw, message.get()) != NATS_OK) continue;
    const MetaDataPtr meta(raw);
    answer->position = meta->Sequence.Stream + 1;
    answer->ended = meta->NumPending == 0;
    auto read = Read(message.get());
    const auto format = read ? FormatOf(read->format_id) : nullptr;
    if (!format || !format->Fits(gst_buffer_get_size(read->buffer.get()))) {
      ++answer->damaged;
      continue;
    }
    GstBuffer* buffer = read->buffer.get();
    GST_BUFFER_OFFSET(buffer) = meta->Sequence.Stream;
    gst_lidar_buffer_set_capture_time(buffer, CapturedAt(buffer, StoredAt(meta->Timestamp)));
    answer->samples.emplace_back(gst_sample_new(buffer, format->caps(), nullptr, nullptr));
  }
}

/// Returns the format with the id `id`, or null if neither `book_` nor the stream has it.
StreamFormat::Ptr History::FormatOf(const std::string& id) {
  if (auto known = book_.Find(id)) return known;
  return book_.Fetch(js_.get(), stream_, ConfigSubject(subject_, id));
}

}  // namespace lidar::nats
