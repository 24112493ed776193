// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-natssrc
 *
 * Receives the stream that a natssink publishes on a subject of NATS, live or from JetStream.
 * Elements downstream may query earlier buffers.
 *
 * |[
 * gst-launch-1.0 natssrc subject=fleet.r7.lidar.front ! lidardec ! fakesink
 * ]|
 */
#include <gst/base/gstpushsrc.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <utility>

#include "ext/nats/history.h"
#include "ext/nats/message.h"
#include "ext/nats/nats_settings.h"
#include "ext/nats/source_account.h"
#include "ext/nats/subscriber.h"
#include "gst/common/element_class.h"
#include "gst/common/stats.h"
#include "gst/lidar/gstlidar.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_nats_src_debug);
#define GST_CAT_DEFAULT gst_lidar_nats_src_debug

namespace {

using namespace lidar::gst;
using lidar::nats::Delivery;
using lidar::nats::History;
using lidar::nats::ReadMessage;
using lidar::nats::SourceCounters;
using lidar::nats::StreamFormat;
using lidar::nats::Subscriber;
using std::chrono::milliseconds;

constexpr milliseconds kPoll{100};          // limits the delay of a change of state
constexpr milliseconds kFormatWait{1'000};  // longest wait for the caps of a message
constexpr gint64 kFormatPauseUs = 5'000'000;

struct NatsSrcSettings {
  NatsSettings nats;
  guint64 start_time = GST_CLOCK_TIME_NONE;
  guint64 start_sequence = 0;
  bool eos_at_end = false;
  guint buffer_size = 8U << 20;
};

const std::array<Stat<SourceCounters>, 12> kStats = {{
    {"messages", &SourceCounters::messages},
    {"bytes", &SourceCounters::bytes},
    {"messages-damaged", &SourceCounters::damaged},
    {"messages-without-caps", &SourceCounters::without_caps},
    {"messages-not-accepted", &SourceCounters::not_accepted},
    {"messages-lost", &SourceCounters::lost},
    {"messages-again", &SourceCounters::again},
    {"messages-late", &SourceCounters::late},
    {"messages-overrun", &SourceCounters::overruns},
    {"formats-damaged", &SourceCounters::damaged_formats},
    {"reconnects", &SourceCounters::reconnects},
    {"connected", &SourceCounters::connected},
}};

struct State {
  std::mutex mutex;  // guards `settings` and `history`; not locked while waiting or posting
  NatsSrcSettings settings;
  std::shared_ptr<History> history;  // exists from start to stop
  lidar::nats::SourceAccount account;

  std::atomic<bool> flushing{false};

  // Only Start(), Stop() and the streaming thread use the members below.
  NatsSrcSettings now;  // the settings of this run
  std::unique_ptr<Subscriber> subscriber;
  std::shared_ptr<ConnectionWatch> watch;
  StreamFormat::Ptr format;
  std::string trouble;           // text of the last warning about JetStream
  Delivery delivery;             // the last pushed buffer's message, until it is acknowledged
  std::optional<guint64> first;  // time at which JetStream stored the first message
  gint64 no_wait_until_us = 0;   // before this time, no message waits for its caps
  gint64 here_at_us = 0;         // last time with a connection; initially the start
  bool warned_damaged = false;
  bool warned_of_caps = false;
  bool warned_absent = false;
  bool at_end = false;
  bool left_out = false;  // a message after the last buffer was dropped
};

}  // namespace

G_DECLARE_FINAL_TYPE(GstLidarNatsSrc, gst_lidar_nats_src, GST, LIDAR_NATS_SRC, GstPushSrc)
struct _GstLidarNatsSrc {
  GstPushSrc parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarNatsSrc, gst_lidar_nats_src, GST_TYPE_PUSH_SRC)
GST_ELEMENT_REGISTER_DEFINE(natssrc, "natssrc", GST_RANK_NONE, gst_lidar_nats_src_get_type())

static State& StateOf(gpointer self) { return *GST_LIDAR_NATS_SRC(self)->state; }

static StructurePtr Stats(GObject* object) {
  return ToStructure("application/x-natssrc-stats", kStats, StateOf(object).account.counters());
}

static const std::array<Property<NatsSrcSettings>, 15> kProperties = {{
    Within<&NatsSrcSettings::nats>(NatsRows(), "url"),
    Within<&NatsSrcSettings::nats>(NatsRows(), "subject"),
    {"queue-group",
     "Group of sources that share the messages: each message goes to one of them; NULL: no group",
     At<&NatsSrcSettings::nats, &NatsSettings::queue_group>},
    Within<&NatsSrcSettings::nats>(NatsRows(), "jetstream"),
    {"durable",
     "Durable consumer of JetStream, which continues after the last message taken; NULL: none",
     At<&NatsSrcSettings::nats, &NatsSettings::durable>},
    {"start-time",
     "Storage time in JetStream to start at; 0: all messages; default: new messages only [ns since "
     "1970]",
     &NatsSrcSettings::start_time},
    {"start-sequence",
     "Sequence number in JetStream's stream to start at, instead of start-time; 0: none",
     &NatsSrcSettings::start_sequence},
    {"eos-at-end", "Send EOS once JetStream has no more messages", &NatsSrcSettings::eos_at_end},
    {"buffer-size",
     "Most bytes that wait in the source, without JetStream; beyond it the newest are dropped "
     "[bytes]",
     &NatsSrcSettings::buffer_size, 65536, 1 << 30},
    Within<&NatsSrcSettings::nats>(NatsRows(), "credentials-file"),
    Within<&NatsSrcSettings::nats>(NatsRows(), "token"),
    Within<&NatsSrcSettings::nats>(NatsRows(), "tls-ca-file"),
    Within<&NatsSrcSettings::nats>(NatsRows(), "tls-cert-file"),
    Within<&NatsSrcSettings::nats>(NatsRows(), "tls-key-file"),
    {"stats",
     "messages, bytes [bytes], messages-damaged, messages-without-caps, "
     "messages-not-accepted, messages-lost, "
     "messages-again, messages-late, messages-overrun, formats-damaged, "
     "reconnects, connected",
     Stats},
}};

/// Makes the source live unless it reads from JetStream. A source of stored messages is not live,
/// because JetStream sends them as fast as downstream accepts them.
static void FollowSettings(GObject* object, GParamSpec*) {
  State& state = StateOf(object);
  std::unique_lock lock(state.mutex);
  const bool live = state.settings.nats.stream.empty();
  lock.unlock();
  gst_base_src_set_live(GST_BASE_SRC(object), live);
  gst_base_src_set_do_timestamp(GST_BASE_SRC(object), live);
}

static lidar::nats::SubscriberSettings ToSubscriber(const NatsSrcSettings& settings) {
  lidar::nats::SubscriberSettings s;
  s.connection = settings.nats.connection;
  s.subject = settings.nats.subject;
  s.queue_group = settings.nats.queue_group;
  s.stream = settings.nats.stream;
  s.durable = settings.nats.durable;
  if (GST_CLOCK_TIME_IS_VALID(settings.start_time)) s.start_time = settings.start_time;
  s.start_sequence = settings.start_sequence;
  s.max_pending = static_cast<int>(settings.buffer_size);
  s.seeks_end = settings.eos_at_end;
  return s;
}

/// Checks the settings. If they are wrong, posts an error message and returns false.
static bool CheckSettings(GstLidarNatsSrc* self, NatsSrcSettings* settings) {
  if (!CheckNatsSettings(GST_ELEMENT(self), &settings->nats)) return false;
  const NatsSettings& nats = settings->nats;
  const bool group_alone =
      !nats.stream.empty() && !nats.queue_group.empty() && nats.durable.empty();
  const bool durable_alone = nats.stream.empty() && !nats.durable.empty();
  if (!group_alone && !durable_alone) return true;
  GST_ELEMENT_ERROR(self, RESOURCE, SETTINGS,
                    ("%s.", durable_alone ? "durable needs jetstream"
                                          : "queue-group with jetstream needs durable"),
                    (nullptr));
  return false;
}

static void ForgetStream(State& state) {
  state.format.reset();
  state.trouble.clear();
  state.delivery = {};
  state.account.Reset();
  state.first.reset();
  state.no_wait_until_us = 0;
  state.here_at_us = g_get_monotonic_time();
  state.warned_damaged = state.warned_of_caps = state.warned_absent = false;
  state.at_end = state.left_out = false;
}

static gboolean Start(GstBaseSrc* base) {
  auto* self = GST_LIDAR_NATS_SRC(base);
  State& state = StateOf(self);
  {
    const std::lock_guard lock(state.mutex);
    state.now = state.settings;
  }
  ForgetStream(state);
  if (!CheckSettings(self, &state.now)) return FALSE;
  state.watch = std::make_shared<ConnectionWatch>(GST_ELEMENT(self), false);
  std::string why;
  state.subscriber = Subscriber::Open(
      ToSubscriber(state.now), [watch = state.watch](const auto& now) { watch->Note(now); }, &why);
  if (state.subscriber) {
    const std::lock_guard lock(state.mutex);
    state.history = std::make_shared<History>(state.now.nats.connection, state.now.nats.subject,
                                              state.now.nats.stream);
    return TRUE;
  }
  state.watch.reset();
  GST_ELEMENT_ERROR(self, RESOURCE, OPEN_READ, ("NATS cannot be used: %s.", why.c_str()),
                    (nullptr));
  return FALSE;
}

static gboolean Stop(GstBaseSrc* base) {
  State& state = StateOf(base);
  state.watch->Silence();
  {
    const std::lock_guard lock(state.mutex);
    state.history.reset();
  }
  state.delivery = {};
  state.subscriber.reset();
  state.watch.reset();
  state.account.NoteStop();
  return TRUE;
}

/// Counts a damaged message. Warns only once until the next good message, because a broken
/// publisher may send many damaged messages.
static void NoteDamaged(GstLidarNatsSrc* self) {
  State& state = StateOf(self);
  state.account.Count(&SourceCounters::damaged);
  if (!std::exchange(state.warned_damaged, true))
    GST_ELEMENT_WARNING(
        self, STREAM, DECODE,
        ("A message is damaged or not from natssink. Such messages are dropped and counted."),
        (nullptr));
}

/// Returns true if no server is connected, but libnats may still connect. Warns once if this lasts
/// longer than kAbsence.
static bool IsAway(State& state) {
  const lidar::nats::ConnectionState connection = state.subscriber->connection();
  const gint64 now = g_get_monotonic_time();
  if (connection.connected()) {
    state.here_at_us = now;
    state.warned_absent = false;
  } else if (!connection.refused() &&
             now - state.here_at_us > std::chrono::microseconds(lidar::nats::kAbsence).count() &&
             !std::exchange(state.warned_absent, true)) {
    state.watch->Warn("No NATS server answers at " +
                      lidar::nats::WithoutUser(state.now.nats.connection.url) +
                      "; natssrc keeps trying.");
  }
  return !connection.connected() && !connection.closed;
}

/// Returns the format with the id `id`. Waits for the format as long as no server is connected. If
/// the server is connected and the format does not arrive, counts a message without caps and
/// returns null. Also returns null if the source is flushing.
static StreamFormat::Ptr FormatOf(GstLidarNatsSrc* self, const std::string& id) {
  State& state = StateOf(self);
  if (state.format && state.format->id() == id) return state.format;
  while (!state.flushing) {
    const bool away = IsAway(state);
    const bool wait = away || g_get_monotonic_time() >= state.no_wait_until_us;
    StreamFormat::Ptr format = state.subscriber->Format(id, wait ? kFormatWait : milliseconds{});
    if (format) return format;
    if (away || IsAway(state)) continue;
    // Messages do not wait for an unknown format during kFormatPauseUs, because the messages behind
    // them may have known formats.
    if (wait) state.no_wait_until_us = g_get_monotonic_time() + kFormatPauseUs;
    state.account.Count(&SourceCounters::without_caps);
    return nullptr;
  }
  return nullptr;
}

static void SetStored(State& state, const Delivery& delivery, GstBuffer* buffer) {
  if (!delivery.stored) return;  // the base class sets the PTS to the time of arrival
  GST_BUFFER_OFFSET(buffer) = delivery.sequence;
  if (!state.first) state.first = *delivery.stored;
  GST_BUFFER_PTS(buffer) = *delivery.stored - std::min(*state.first, *delivery.stored);
}

/// Sets the caps of `format`. If downstream refuses the caps, counts the message, warns the first
/// time, and returns CUSTOM_SUCCESS. This is not an error, because another sender may publish the
/// stream of another coder on the same subject.
static GstFlowReturn SetFormat(GstLidarNatsSrc* self, const StreamFormat::Ptr& format) {
  State& state = StateOf(self);
  GstPad* pad = GST_BASE_SRC_PAD(self);
  if (gst_pad_peer_query_accept_caps(pad, format->caps()) &&
      gst_base_src_set_caps(GST_BASE_SRC(self), format->caps())) {
    state.format = format;
    return GST_FLOW_OK;
  }
  if (GST_PAD_IS_FLUSHING(pad)) return GST_FLOW_FLUSHING;
  state.account.Count(&SourceCounters::not_accepted);
  if (!std::exchange(state.warned_of_caps, true))
    GST_ELEMENT_WARNING(self, STREAM, WRONG_TYPE,
                        ("The subject carries %s, which the next element does not take. Such "
                         "messages are dropped and counted.",
                         gst_structure_get_name(gst_caps_get_structure(format->caps(), 0))),
                        ("caps are %" GST_PTR_FORMAT, static_cast<gpointer>(format->caps())));
  return GST_FLOW_CUSTOM_SUCCESS;
}

/// Notes a message that arrived but is dropped. The message does not count as lost, but the next
/// buffer is marked DISCONT.
static void NoteLeftOut(State& state, const ReadMessage& read) {
  state.account.NotePlace(read.place, !state.now.nats.queue_group.empty());
  state.left_out = true;
}

/// Converts the message of `delivery` to a buffer. Returns CUSTOM_SUCCESS if there is no buffer to
/// push.
static GstFlowReturn Take(GstLidarNatsSrc* self, const Delivery& delivery, GstBuffer** out) {
  State& state = StateOf(self);
  std::optional<ReadMessage> read = lidar::nats::Read(delivery.message.get());
  if (!read) {
    NoteDamaged(self);
    return GST_FLOW_CUSTOM_SUCCESS;
  }
  const StreamFormat::Ptr format = FormatOf(self, read->format_id);
  if (!format && state.flushing) return GST_FLOW_FLUSHING;
  if (!format) {
    NoteLeftOut(state, *read);
    return GST_FLOW_CUSTOM_SUCCESS;
  }
  const gsize size = gst_buffer_get_size(read->buffer.get());
  if (!format->Fits(size)) {
    NoteDamaged(self);
    return GST_FLOW_CUSTOM_SUCCESS;
  }
  if (format != state.format) {
    const GstFlowReturn flow = SetFormat(self, format);
    if (flow == GST_FLOW_CUSTOM_SUCCESS) NoteLeftOut(state, *read);
    if (flow != GST_FLOW_OK) return flow;
  }
  const auto verdict = state.account.NotePlace(read->place, !state.now.nats.queue_group.empty());
  if (verdict.again) return GST_FLOW_CUSTOM_SUCCESS;
  if (std::exchange(state.left_out, false) || verdict.gap)
    GST_BUFFER_FLAG_SET(read->buffer.get(), GST_BUFFER_FLAG_DISCONT);
  SetStored(state, delivery, read->buffer.get());
  state.warned_damaged = false;
  state.account.NoteTaken(size);
  *out = read->buffer.release();
  return GST_FLOW_OK;
}

static void Acknowledge(State& state) {
  if (state.delivery.message && state.subscriber->acknowledges())
    state.subscriber->Acknowledge(state.delivery.message.get());
  state.delivery = {};
}

static void NoteTrouble(GstLidarNatsSrc* self) {
  State& state = StateOf(self);
  const std::string& trouble = state.subscriber->trouble();
  if (trouble == state.trouble) return;
  state.trouble = trouble;
  state.watch->Warn("JetStream delivers no messages: " + trouble + "; natssrc keeps trying.");
}

static GstFlowReturn Handle(GstLidarNatsSrc* self, Subscriber::Event event, Delivery delivery,
                            GstBuffer** out) {
  State& state = StateOf(self);
  const bool eos_at_end = state.now.eos_at_end;
  switch (event) {
    case Subscriber::Event::kClosed:
      // Posts the error here. The watch may post it too late, after the less clear error of the
      // base class.
      state.watch->PostRefused(state.subscriber->connection());
      return GST_FLOW_ERROR;
    case Subscriber::Event::kEmpty:
      return eos_at_end ? GST_FLOW_EOS : GST_FLOW_CUSTOM_SUCCESS;
    case Subscriber::Event::kTrouble:
      NoteTrouble(self);
      return GST_FLOW_CUSTOM_SUCCESS;
    case Subscriber::Event::kNothing:
      return GST_FLOW_CUSTOM_SUCCESS;
    case Subscriber::Event::kMessage:
      break;
  }
  state.trouble.clear();
  const GstFlowReturn flow = Take(self, delivery, out);
  if (flow == GST_FLOW_FLUSHING) return flow;  // a durable consumer sends the message again
  // A durable consumer is never at the end here, because the server may send it earlier messages
  // again.
  state.at_end =
      eos_at_end && delivery.stored && delivery.to_come == 0 && !state.subscriber->acknowledges();
  state.delivery = std::move(delivery);
  if (flow != GST_FLOW_CUSTOM_SUCCESS) return flow;
  Acknowledge(state);
  return state.at_end ? GST_FLOW_EOS : flow;
}

static GstFlowReturn Create(GstPushSrc* push, GstBuffer** out) {
  auto* self = GST_LIDAR_NATS_SRC(push);
  State& state = StateOf(self);
  Acknowledge(state);  // the last buffer, whose push has returned
  if (state.at_end) return GST_FLOW_EOS;
  while (!state.flushing) {
    Delivery delivery;
    const Subscriber::Event event = state.subscriber->Next(kPoll, &delivery);
    state.account.NoteSubscriber(*state.subscriber);
    IsAway(state);
    const GstFlowReturn flow = Handle(self, event, std::move(delivery), out);
    if (flow != GST_FLOW_CUSTOM_SUCCESS) return flow;
  }
  return GST_FLOW_FLUSHING;
}

/// Answers queries for earlier buffers of the stream. Runs in the thread of the downstream element
/// that sends the query.
static gboolean Query(GstBaseSrc* base, GstQuery* query) {
  const auto question = ParseHistoryQuestion(query);
  if (!question) return GST_BASE_SRC_CLASS(gst_lidar_nats_src_parent_class)->query(base, query);
  State& state = StateOf(base);
  std::unique_lock lock(state.mutex);
  const std::shared_ptr<History> history = state.history;
  lock.unlock();
  const auto answer = history ? history->Answer(*question) : std::nullopt;
  if (answer) SetHistoryAnswer(query, *answer);
  return answer.has_value();
}

static gboolean Unlock(GstBaseSrc* base) {
  StateOf(base).flushing = true;
  return TRUE;
}

static gboolean UnlockStop(GstBaseSrc* base) {
  StateOf(base).flushing = false;
  return TRUE;
}

static void gst_lidar_nats_src_init(GstLidarNatsSrc* self) {
  self->state = new State;
  gst_base_src_set_format(GST_BASE_SRC(self), GST_FORMAT_TIME);
  FollowSettings(G_OBJECT(self), nullptr);
}

static void gst_lidar_nats_src_class_init(GstLidarNatsSrcClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_nats_src_debug, "natssrc", 0, "Subscription of NATS");
  ServeState<GstLidarNatsSrc, gst_lidar_nats_src_parent_class, kProperties, FollowSettings>(klass);
  Describe(klass, {"NATS source", "Source/Network", "Takes a stream from a subject of NATS"},
           {{"src", GST_PAD_SRC, "ANY"}});
  auto* src = GST_BASE_SRC_CLASS(klass);
  src->start = Start;
  src->stop = Stop;
  src->query = Query;
  src->unlock = Unlock;
  src->unlock_stop = UnlockStop;
  src->is_seekable = [](GstBaseSrc*) -> gboolean { return FALSE; };
  // Create() sets the caps before the first buffer.
  src->negotiate = [](GstBaseSrc*) -> gboolean { return TRUE; };
  GST_PUSH_SRC_CLASS(klass)->create = Create;
}
