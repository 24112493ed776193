// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-natssink
 *
 * Publishes coded slices, clouds, IMU samples or odometry on a subject of NATS, each buffer as a
 * message. JetStream keeps them if `jetstream` names a stream.
 *
 * |[
 * gst-launch-1.0 lidartestsrc is-live=true ! lidarenc ! natssink subject=fleet.r7.lidar.front
 * ]|
 */
#include <gst/base/gstbasesink.h>

#include <memory>
#include <mutex>
#include <utility>

#include "ext/nats/nats_settings.h"
#include "ext/nats/publisher.h"
#include "gst/common/element_class.h"
#include "gst/common/refused_caps.h"
#include "gst/common/stats.h"
#include "gst/lidar/gstlidar.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_nats_sink_debug);
#define GST_CAT_DEFAULT gst_lidar_nats_sink_debug

namespace {

using namespace lidar::gst;
using lidar::Duration;
using lidar::nats::Publisher;
using lidar::nats::PublisherCounters;
using lidar::nats::StreamFormat;

struct NatsSinkSettings {
  NatsSettings nats;
  Duration max_age = std::chrono::hours(1);
  guint64 max_bytes = guint64{4} << 30;
  guint replicas = 1;
  std::string stream_subjects;
  bool keep_trying = false;
  guint buffer_size = 8U << 20;
  Duration drain_timeout = std::chrono::seconds(2);
};

const std::array<Stat<PublisherCounters>, 12> kStats = {{
    {"messages", &PublisherCounters::messages},
    {"bytes", &PublisherCounters::bytes},
    {"messages-acknowledged", &PublisherCounters::acknowledged},
    {"messages-resent", &PublisherCounters::resent},
    {"messages-dropped", &PublisherCounters::dropped},
    {"messages-too-large", &PublisherCounters::too_large},
    {"messages-waiting", &PublisherCounters::waiting},
    {"bytes-waiting", &PublisherCounters::buffered},
    {"server-errors", &PublisherCounters::server_errors},
    {"refusals", &PublisherCounters::refusals},
    {"reconnects", &PublisherCounters::reconnects},
    {"connected", &PublisherCounters::connected},
}};

struct State {
  std::mutex mutex;  // guards `settings` to `refused`; not locked while the sink waits or posts
  NatsSinkSettings settings;
  std::shared_ptr<Publisher> publisher;  // exists from start to stop
  PublisherCounters last;                // counters of the last publisher
  guint64 refused = 0;

  // Only Start(), Stop() and the streaming thread use the members below.
  std::shared_ptr<ConnectionWatch> watch;
  StreamFormat::Ptr format;
  RefusedCaps refused_caps;
  bool warned_refused = false;
};

}  // namespace

G_DECLARE_FINAL_TYPE(GstLidarNatsSink, gst_lidar_nats_sink, GST, LIDAR_NATS_SINK, GstBaseSink)
struct _GstLidarNatsSink {
  GstBaseSink parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarNatsSink, gst_lidar_nats_sink, GST_TYPE_BASE_SINK)
GST_ELEMENT_REGISTER_DEFINE(natssink, "natssink", GST_RANK_NONE, gst_lidar_nats_sink_get_type())

static State& StateOf(gpointer self) { return *GST_LIDAR_NATS_SINK(self)->state; }

static std::shared_ptr<Publisher> PublisherOf(gpointer self) {
  State& state = StateOf(self);
  const std::lock_guard lock(state.mutex);
  return state.publisher;
}

static StructurePtr Stats(GObject* object) {
  State& state = StateOf(object);
  const auto publisher = PublisherOf(object);
  const PublisherCounters now = publisher ? publisher->counters() : PublisherCounters();
  std::unique_lock lock(state.mutex);
  const PublisherCounters counters = publisher ? now : state.last;
  const guint64 refused = state.refused;
  lock.unlock();
  StructurePtr stats = ToStructure("application/x-natssink-stats", kStats, counters);
  gst_structure_set(stats.get(), "buffers-refused", G_TYPE_UINT64, refused, nullptr);
  return stats;
}

static const std::array<Property<NatsSinkSettings>, 16> kProperties = {{
    Within<&NatsSinkSettings::nats>(NatsRows(), "url"),
    Within<&NatsSinkSettings::nats>(NatsRows(), "subject"),
    Within<&NatsSinkSettings::nats>(NatsRows(), "jetstream"),
    {"max-age", "Time that JetStream keeps messages; 0: no limit [ns]", &NatsSinkSettings::max_age},
    {"max-bytes",
     "Most bytes that JetStream keeps; beyond it the oldest are removed; 0: no limit [bytes]",
     &NatsSinkSettings::max_bytes, 0, 9e18},
    {"replicas",
     "Number of the cluster's servers that keep a copy, if this sink creates the stream",
     &NatsSinkSettings::replicas, 1, 5},
    {"jetstream-subjects",
     "Pattern of the subjects that JetStream's stream keeps, such as fleet.*.lidar.>; NULL: this "
     "sink's subject",
     &NatsSinkSettings::stream_subjects},
    {"buffer-size",
     "Most bytes that wait for the server or its acknowledgement; beyond it the oldest are dropped "
     "[bytes]",
     &NatsSinkSettings::buffer_size, 65536, 1 << 30},
    {"drain-timeout", "Longest time that EOS waits until the server has all messages [ns]",
     &NatsSinkSettings::drain_timeout, 0, 6e10, GST_PARAM_MUTABLE_PLAYING},
    {"keep-trying",
     "If the server refuses the connection, warn and try again after 1 s to 16 s, instead of an "
     "error",
     &NatsSinkSettings::keep_trying},
    Within<&NatsSinkSettings::nats>(NatsRows(), "credentials-file"),
    Within<&NatsSinkSettings::nats>(NatsRows(), "token"),
    Within<&NatsSinkSettings::nats>(NatsRows(), "tls-ca-file"),
    Within<&NatsSinkSettings::nats>(NatsRows(), "tls-cert-file"),
    Within<&NatsSinkSettings::nats>(NatsRows(), "tls-key-file"),
    {"stats",
     "messages, bytes [bytes], messages-acknowledged, messages-resent, messages-dropped, "
     "messages-too-large, messages-waiting, bytes-waiting [bytes], server-errors, refusals, "
     "reconnects, connected, buffers-refused",
     Stats},
}};

static lidar::nats::PublisherSettings ToPublisher(const NatsSinkSettings& settings) {
  lidar::nats::PublisherSettings p;
  p.connection = settings.nats.connection;
  p.subject = settings.nats.subject;
  p.stream = {settings.nats.stream, settings.max_age, settings.max_bytes, settings.replicas,
              settings.stream_subjects};
  p.max_buffered = settings.buffer_size;
  p.keep_trying = settings.keep_trying;
  return p;
}

/// Checks that `replicas` is set only together with `jetstream`. If not, posts an error message and
/// returns false.
static bool CheckReplicas(GstLidarNatsSink* self, const NatsSinkSettings& settings) {
  if (settings.replicas == 1 || !settings.nats.stream.empty()) return true;
  GST_ELEMENT_ERROR(self, RESOURCE, SETTINGS,
                    ("The property replicas needs the property jetstream."), (nullptr));
  return false;
}

/// Checks that `jetstream-subjects` covers the subjects of this sink and does not begin with a
/// wildcard. If the check fails, posts an error message and returns false.
static bool CheckStreamSubjects(GstLidarNatsSink* self, const NatsSinkSettings& settings) {
  const std::string& pattern = settings.stream_subjects;
  const std::string& subject = settings.nats.subject;
  const bool covers =
      pattern.empty() || (lidar::nats::Covers(pattern, subject) &&
                          lidar::nats::Covers(pattern, lidar::nats::ConfigSubject(subject, "*")));
  // A stream of all subjects would also store the server's own requests, and answer them with
  // acknowledgements.
  const bool all = !pattern.empty() && (pattern.front() == '*' || pattern.front() == '>');
  if (covers && !all) return true;
  GST_ELEMENT_ERROR(self, RESOURCE, SETTINGS,
                    ("jetstream-subjects \"%s\" %s.", pattern.c_str(),
                     all ? "must not begin with a wildcard"
                         : ("must cover " + subject + " and " + subject + ".config.*").c_str()),
                    (nullptr));
  return false;
}

static gboolean Start(GstBaseSink* base) {
  auto* self = GST_LIDAR_NATS_SINK(base);
  State& state = StateOf(self);
  NatsSinkSettings settings = Snapshot(state);
  if (!CheckNatsSettings(GST_ELEMENT(self), &settings.nats) || !CheckReplicas(self, settings) ||
      !CheckStreamSubjects(self, settings))
    return FALSE;
  state.watch = std::make_shared<ConnectionWatch>(GST_ELEMENT(self), settings.keep_trying);
  state.format.reset();
  state.refused_caps.Reset();
  state.warned_refused = false;
  lidar::nats::PublisherEvents events;
  events.connection = [watch = state.watch](const auto& now) { watch->Note(now); };
  events.trouble = [watch = state.watch](const std::string& why) {
    watch->Warn(why + "; until this is solved, messages wait or are dropped and counted.");
  };
  std::string why;
  auto publisher = Publisher::Start(ToPublisher(settings), std::move(events), &why);
  if (!publisher) {
    GST_ELEMENT_ERROR(self, RESOURCE, OPEN_WRITE, ("NATS cannot be used: %s.", why.c_str()),
                      (nullptr));
    state.watch.reset();
    return FALSE;
  }
  const std::lock_guard lock(state.mutex);
  state.publisher = std::move(publisher);
  state.refused = 0;
  return TRUE;
}

static gboolean Stop(GstBaseSink* base) {
  State& state = StateOf(base);
  const auto publisher = PublisherOf(base);
  state.watch->Silence();
  publisher->Stop();
  state.watch.reset();
  const PublisherCounters last = publisher->counters();
  const std::lock_guard lock(state.mutex);
  state.last = last;
  state.publisher.reset();
  return TRUE;
}

static gboolean SetCaps(GstBaseSink* base, GstCaps* caps) {
  auto* self = GST_LIDAR_NATS_SINK(base);
  State& state = StateOf(self);
  std::string why;
  // Refused caps leave the format as it is, because GstBaseSink does not call SetCaps() again when
  // the earlier caps return.
  if (auto format = StreamFormat::FromCaps(caps, &why)) {
    state.refused_caps.Reset();
    state.format = std::move(format);
    return TRUE;
  }
  if (state.refused_caps.Note(caps))
    GST_ELEMENT_ERROR(self, STREAM, FORMAT, ("This stream cannot be published: %s.", why.c_str()),
                      ("caps are %" GST_PTR_FORMAT, static_cast<gpointer>(caps)));
  return FALSE;
}

static GstFlowReturn Render(GstBaseSink* base, GstBuffer* buffer) {
  State& state = StateOf(base);
  const auto publisher = PublisherOf(base);
  if (!publisher || !state.format) return GST_FLOW_NOT_NEGOTIATED;
  if (state.format->Fits(gst_buffer_get_size(buffer))) {
    publisher->Add(BufferPtr(gst_buffer_ref(buffer)), state.format);
    return GST_FLOW_OK;
  }
  {
    const std::lock_guard lock(state.mutex);
    ++state.refused;
  }
  if (!std::exchange(state.warned_refused, true))
    GST_ELEMENT_WARNING(base, STREAM, FORMAT,
                        ("A buffer does not match its caps; such buffers are dropped and counted."),
                        ("the buffer has %" G_GSIZE_FORMAT " bytes", gst_buffer_get_size(buffer)));
  return GST_FLOW_OK;
}

/// Posts a warning with the number of messages that had not reached the server at the end of the
/// stream. If no message has reached it, posts an error instead, unless `keeps_trying` is set.
static void TellOfUnsent(GstBaseSink* base, const Publisher& publisher, bool keeps_trying) {
  const PublisherCounters counters = publisher.counters();
  const auto lost = guint64{counters.waiting + counters.dropped};
  if (counters.messages == 0 && !keeps_trying)
    GST_ELEMENT_ERROR(base, RESOURCE, WRITE,
                      ("None of %" G_GUINT64_FORMAT
                       " messages reached a NATS server. Start a server, or set url.",
                       lost),
                      (nullptr));
  else
    GST_ELEMENT_WARNING(base, RESOURCE, WRITE,
                        ("At the end of the stream the NATS server lacks %" G_GUINT64_FORMAT
                         " messages. Set a longer drain-timeout to wait for them.",
                         lost),
                        (nullptr));
}

/// Posts an error if no message reached the server because all of them were dropped or too large.
static void TellOfDropped(GstBaseSink* base, const Publisher& publisher,
                          const NatsSinkSettings& settings) {
  const PublisherCounters counters = publisher.counters();
  const auto lost = guint64{counters.dropped + counters.too_large};
  const bool kept = !settings.nats.stream.empty();
  const guint64 reached = kept ? counters.acknowledged : counters.messages;
  if (reached > 0 || lost == 0 || settings.keep_trying) return;
  GST_ELEMENT_ERROR(base, RESOURCE, WRITE,
                    ("None of %" G_GUINT64_FORMAT
                     " messages reached the NATS server: they exceed its max_payload, %s"
                     "or buffer-size.",
                     lost, kept ? "the stream's max_msg_size, " : ""),
                    (nullptr));
}

static gboolean OnEvent(GstBaseSink* base, GstEvent* event) {
  if (GST_EVENT_TYPE(event) == GST_EVENT_EOS) {
    const auto publisher = PublisherOf(base);
    const NatsSinkSettings settings = Snapshot(StateOf(base));
    const auto drained =
        publisher ? publisher->Drain(settings.drain_timeout) : Publisher::Drained::kInterrupted;
    if (drained == Publisher::Drained::kTimeout)
      TellOfUnsent(base, *publisher, settings.keep_trying);
    if (drained == Publisher::Drained::kAll) TellOfDropped(base, *publisher, settings);
  }
  return GST_BASE_SINK_CLASS(gst_lidar_nats_sink_parent_class)->event(base, event);
}

static gboolean Unlock(GstBaseSink* base) {
  if (const auto publisher = PublisherOf(base)) publisher->Interrupt(true);
  return TRUE;
}

static gboolean UnlockStop(GstBaseSink* base) {
  if (const auto publisher = PublisherOf(base)) publisher->Interrupt(false);
  return TRUE;
}

static void gst_lidar_nats_sink_init(GstLidarNatsSink* self) { self->state = new State; }

static void gst_lidar_nats_sink_class_init(GstLidarNatsSinkClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_nats_sink_debug, "natssink", 0, "Publisher of NATS");
  ServeState<GstLidarNatsSink, gst_lidar_nats_sink_parent_class, kProperties>(klass);
  Describe(klass, {"NATS sink", "Sink/Network", "Publishes a stream on a subject of NATS"},
           {{"sink", GST_PAD_SINK, "ANY"}});
  auto* base = GST_BASE_SINK_CLASS(klass);
  base->start = Start;
  base->stop = Stop;
  base->set_caps = SetCaps;
  base->render = Render;
  base->event = OnEvent;
  base->unlock = Unlock;
  base->unlock_stop = UnlockStop;
}
