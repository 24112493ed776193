// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-mcapsrc
 *
 * Plays MCAP files. Each topic has its own pad.
 *
 * |[
 * gst-launch-1.0 mcapsrc location=drive.mcap ! lidardec ! scanassembler ! fakesink
 * ]|
 */
#include <gst/gst.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "ext/mcap/play_messages.h"
#include "ext/mcap/play_task.h"
#include "ext/mcap/seeking.h"
#include "ext/mcap/stream_group.h"
#include "gst/common/element_class.h"
#include "gst/common/properties.h"
#include "gst/common/stats.h"
#include "src/mcap/playback.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_mcap_src_debug);
#define GST_CAT_DEFAULT gst_lidar_mcap_src_debug

G_DECLARE_FINAL_TYPE(GstLidarMcapSrc, gst_lidar_mcap_src, GST, LIDAR_MCAP_SRC, GstElement)

namespace {

using namespace lidar::gst;

struct Settings {
  std::string location;
  std::string topic;
};

struct Counters {
  guint64 messages = 0;
  guint64 messages_dropped = 0;
  guint64 chunks_damaged = 0;
  guint64 files_unclosed = 0;
  guint64 files_unreadable = 0;
};
const std::array<Stat<Counters>, 5> kStats = {{
    {"messages", &Counters::messages},
    {"messages-dropped", &Counters::messages_dropped},
    {"chunks-damaged", &Counters::chunks_damaged},
    {"files-unclosed", &Counters::files_unclosed},
    {"files-unreadable", &Counters::files_unreadable},
}};

/// The recording that is played, and its pads. Only the streaming thread may use them. While the
/// task is stopped or paused, a thread that holds the task's lock may use them, too.
struct Run {
  std::unique_ptr<lidar::mcap::Playback> playback;
  std::unique_ptr<StreamGroup> streams;
};

struct State {
  explicit State(GstLidarMcapSrc* self);

  std::mutex mutex;  // guards the members up to `last_seek`; not locked while pushing or posting
  Settings settings;
  Counters counters;
  GstSegment segment{};  // the segment that the task plays, and its position
  bool is_open = false;
  guint32 last_seek = GST_SEQNUM_INVALID;

  std::atomic<bool> end_wanted{false};
  std::atomic<bool> stopping{false};  // if true, no further chunk is read
  PlayTask task;
  Run run;
};

}  // namespace

struct _GstLidarMcapSrc {
  GstElement parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarMcapSrc, gst_lidar_mcap_src, GST_TYPE_ELEMENT)
GST_ELEMENT_REGISTER_DEFINE(mcapsrc, "mcapsrc", GST_RANK_NONE, gst_lidar_mcap_src_get_type())

static GstStaticPadTemplate src_template =
    GST_STATIC_PAD_TEMPLATE("src_%u", GST_PAD_SRC, GST_PAD_SOMETIMES, GST_STATIC_CAPS_ANY);

static gboolean SrcEvent(GstPad* pad, GstObject* parent, GstEvent* event);

static StructurePtr Stats(GObject* object) {
  State& state = *GST_LIDAR_MCAP_SRC(object)->state;
  std::lock_guard lock(state.mutex);
  return ToStructure("mcap-src-stats", kStats, state.counters);
}

static const std::array<Property<Settings>, 3> kProperties = {{
    {"location", "File to play; with a number in it (rec-%05d.mcap), all files of a recording",
     &Settings::location},
    {"topic", "Play this topic only; NULL: all", &Settings::topic},
    {"stats",
     "messages, messages-dropped, chunks-damaged, files-unclosed (which are played up to their "
     "end),"
     " files-unreadable",
     Stats},
}};

static bool IsWanted(const Settings& settings, const std::string& topic) {
  return settings.topic.empty() || settings.topic == topic;
}

static gboolean SrcQuery(GstPad* pad, GstObject* parent, GstQuery* query) {
  State& state = *GST_LIDAR_MCAP_SRC(parent)->state;
  {
    std::lock_guard lock(state.mutex);
    if (AnswerBySegment(state.segment, query)) return TRUE;
  }
  return gst_pad_query_default(pad, parent, query);
}

static GstPad* NewPad(const std::string& name) {
  GstPad* pad = gst_pad_new_from_static_template(&src_template, name.c_str());
  gst_pad_use_fixed_caps(pad);
  gst_pad_set_event_function(pad, SrcEvent);
  gst_pad_set_query_function(pad, SrcQuery);
  return pad;
}

/// Returns true if the recording has a topic that can be played. Does not read any message.
static bool HasTopic(const lidar::mcap::Playback& playback, const Settings& settings) {
  return std::any_of(playback.topics().begin(), playback.topics().end(), [&](const auto& topic) {
    return IsWanted(settings, topic.channel.topic) &&
           MessageReader::Make(topic.schema, topic.channel) != nullptr;
  });
}

static bool Open(GstLidarMcapSrc* self) {
  State& state = *self->state;
  Settings settings;
  {
    std::lock_guard lock(state.mutex);
    settings = state.settings;
    state.counters = {};
  }
  std::string why = "location is not set";
  state.stopping = false;
  auto playback = settings.location.empty()
                      ? nullptr
                      : lidar::mcap::Playback::Open(settings.location, &state.stopping, &why);
  if (!playback) {
    GST_ELEMENT_ERROR(self, RESOURCE, OPEN_READ,
                      ("Cannot play \"%s\": %s.", settings.location.c_str(), why.c_str()),
                      (nullptr));
    return false;
  }
  if (!HasTopic(*playback, settings)) {
    PostNothingToPlay(GST_ELEMENT(self), *playback, settings.location, settings.topic);
    return false;
  }
  if (playback->unclosed_files() > 0) WarnOfUnclosed(GST_ELEMENT(self), playback->unclosed_files());
  if (playback->unreadable_files() > 0)
    WarnOfUnreadable(GST_ELEMENT(self), playback->unreadable_files(), why);
  const guint64 span = playback->end_time() - playback->start_time();
  std::lock_guard lock(state.mutex);
  state.counters.files_unclosed = playback->unclosed_files();
  state.counters.files_unreadable = playback->unreadable_files();
  gst_segment_init(&state.segment, GST_FORMAT_TIME);
  state.segment.duration = std::min<guint64>(span, G_MAXINT64);
  state.is_open = true;
  state.run.streams = std::make_unique<StreamGroup>(GST_ELEMENT(self), NewPad, state.segment);
  state.run.playback = std::move(playback);
  return true;
}

/// Posts SEGMENT_DONE. Stores the position, because a seek without a flush continues there.
static void PostSegmentDone(GstLidarMcapSrc* self, gint64 position) {
  const guint32 seqnum = self->state->run.streams->seqnum();
  {
    std::lock_guard lock(self->state->mutex);
    self->state->segment.position = static_cast<guint64>(position);
  }
  GstMessage* message = gst_message_new_segment_done(GST_OBJECT(self), GST_FORMAT_TIME, position);
  if (seqnum != GST_SEQNUM_INVALID) gst_message_set_seqnum(message, seqnum);
  gst_element_post_message(GST_ELEMENT(self), message);
}

/// Posts an error or a warning if a part of the recording is missing.
static void TellOfDamage(GstLidarMcapSrc* self) {
  State& state = *self->state;
  Counters counters;
  {
    std::lock_guard lock(state.mutex);
    // A damaged last chunk is counted only here, because no message follows it.
    state.counters.chunks_damaged = state.run.playback->damaged_chunks();
    counters = state.counters;
  }
  if (state.end_wanted || state.stopping) return;
  PostDamage(GST_ELEMENT(self), {counters.messages, counters.messages_dropped,
                                 counters.chunks_damaged, state.run.streams->has_pads()});
}

static void Finish(GstLidarMcapSrc* self) {
  StreamGroup& streams = *self->state->run.streams;
  streams.EndPads();
  TellOfDamage(self);
  const GstSegment& segment = streams.segment();
  if ((segment.flags & GST_SEGMENT_FLAG_SEGMENT) == 0) return streams.End(gst_event_new_eos());
  const auto position =
      static_cast<gint64>(GST_CLOCK_TIME_IS_VALID(segment.stop) ? segment.stop : segment.duration);
  PostSegmentDone(self, position);
  streams.End(gst_event_new_segment_done(GST_FORMAT_TIME, position));
}

/// Pauses the task. Ends the streams after EOS and after an error, which it posts.
static void Stop(GstLidarMcapSrc* self, GstFlowReturn flow) {
  GST_DEBUG_OBJECT(self, "stops: %s", gst_flow_get_name(flow));
  // Pauses the task before EOS is posted. An application may answer EOS by a seek, which starts the
  // task again.
  self->state->task.Pause();
  if (flow == GST_FLOW_EOS) return Finish(self);
  if (flow != GST_FLOW_NOT_LINKED && flow > GST_FLOW_EOS) return;
  if (flow == GST_FLOW_NOT_LINKED)
    PostNotTaken(GST_ELEMENT(self));
  else
    GST_ELEMENT_FLOW_ERROR(self, flow);
  self->state->run.streams->End(gst_event_new_eos());
}

static void Count(State* state, bool dropped, GstClockTime position) {
  std::lock_guard lock(state->mutex);
  ++state->counters.messages;
  if (dropped) ++state->counters.messages_dropped;
  state->counters.chunks_damaged = state->run.playback->damaged_chunks();
  state->segment.position = position;
}

static GstFlowReturn PlayItem(GstLidarMcapSrc* self, const lidar::mcap::Playback::Item& item,
                              GstClockTime pts) {
  StreamGroup& streams = *self->state->run.streams;
  StreamGroup::Played played = streams.Read(item, pts);
  Count(self->state, played.buffer == nullptr, pts);
  if (played.buffer) return streams.Push(std::move(played));
  GST_WARNING_OBJECT(self, "dropping a damaged message on the topic %s",
                     item.channel->topic.c_str());
  return GST_FLOW_OK;
}

/// Counts the files that could not be read when playback reached them. Posts a warning if there are
/// new ones.
static void NoteUnreadable(GstLidarMcapSrc* self) {
  State& state = *self->state;
  const lidar::mcap::Playback& playback = *state.run.playback;
  const guint64 files = playback.unreadable_files();
  {
    std::lock_guard lock(state.mutex);
    // If the task stops, a file may remain unread although it could be read. It does not count.
    if (state.stopping || state.counters.files_unreadable == files) return;
    state.counters.files_unreadable = files;
  }
  WarnOfUnreadable(GST_ELEMENT(self), files, playback.why_unreadable());
}

static void Loop(gpointer user_data) {
  auto* self = GST_LIDAR_MCAP_SRC(user_data);
  State& state = *self->state;
  Run& run = state.run;
  const Settings settings = Snapshot(state);
  if (run.streams->empty()) run.streams->ShowKnown(*run.playback, settings.topic);
  const auto item = state.end_wanted ? std::nullopt : run.playback->Next();
  NoteUnreadable(self);
  if (!item) return Stop(self, GST_FLOW_EOS);
  if (!IsWanted(settings, item->channel->topic) || !TypeOf(*item->schema, *item->channel)) return;
  const std::uint64_t start = run.playback->start_time();
  const std::uint64_t log_time = std::max(item->message.header.log_time, start);
  const GstClockTime pts = std::min<guint64>(log_time - start, G_MAXINT64);
  const GstFlowReturn flow = PlayItem(self, *item, pts);
  if (flow != GST_FLOW_OK) Stop(self, flow);
}

/// Pushes `event` on all pads. Gets the pads from the element, because the streams belong to the
/// task.
static void PushToAll(GstLidarMcapSrc* self, GstEvent* event) {
  GST_OBJECT_LOCK(self);
  GList* pads = g_list_copy_deep(
      GST_ELEMENT(self)->srcpads,
      [](gconstpointer p, gpointer) { return gst_object_ref(const_cast<gpointer>(p)); }, nullptr);
  GST_OBJECT_UNLOCK(self);
  for (GList* pad = pads; pad != nullptr; pad = pad->next)
    gst_pad_push_event(GST_PAD(pad->data), gst_event_ref(event));
  g_list_free_full(pads, gst_object_unref);
  gst_event_unref(event);
}

/// Continues the playback in another segment. The task is paused, and the caller holds its lock.
static void Restart(GstLidarMcapSrc* self, const Seek& seek, GstSegment segment) {
  State& state = *self->state;
  Run& run = state.run;
  {
    std::lock_guard lock(state.mutex);
    segment = state.segment = seek.Begun(segment, state.segment);
  }
  if (seek.flushes()) state.end_wanted = false;  // the flush also cancels a requested end
  const std::uint64_t start = run.playback->start_time();
  const bool ends = GST_CLOCK_TIME_IS_VALID(segment.stop) && segment.stop < UINT64_MAX - start;
  run.playback->Seek(start + segment.position, ends ? start + segment.stop : UINT64_MAX);
  run.streams->Restart(segment, seek.seqnum());
}

static void PushFlush(GstLidarMcapSrc* self, const Seek& seek, GstEvent* event) {
  gst_event_set_seqnum(event, seek.seqnum());
  PushToAll(self, event);
}

static bool DoSeek(GstLidarMcapSrc* self, GstEvent* event) {
  State& state = *self->state;
  const Seek seek(event);
  std::optional<GstSegment> segment;
  {
    std::lock_guard lock(state.mutex);
    if (state.is_open) segment = seek.AppliedTo(state.segment);
    if (!segment) return false;
    // Each sink sends the same seek. Only the first of these events is handled.
    if (std::exchange(state.last_seek, seek.seqnum()) == seek.seqnum()) return true;
  }
  if (seek.flushes()) PushFlush(self, seek, gst_event_new_flush_start());
  state.task.Pause();
  g_rec_mutex_lock(state.task.lock());
  bool open = false;  // the recording may have been closed since the check above
  {
    std::lock_guard lock(state.mutex);
    open = state.is_open;
  }
  if (open) Restart(self, seek, *segment);
  if (seek.flushes()) PushFlush(self, seek, gst_event_new_flush_stop(TRUE));
  if (open) state.task.GoOn();
  g_rec_mutex_unlock(state.task.lock());
  return open;
}

static gboolean SrcEvent(GstPad* pad, GstObject* parent, GstEvent* event) {
  if (GST_EVENT_TYPE(event) != GST_EVENT_SEEK) return gst_pad_event_default(pad, parent, event);
  const EventPtr owner(event);
  return DoSeek(GST_LIDAR_MCAP_SRC(parent), event);
}

static gboolean SendEvent(GstElement* element, GstEvent* event) {
  auto* self = GST_LIDAR_MCAP_SRC(element);
  const EventPtr owner(event);
  if (GST_EVENT_TYPE(event) == GST_EVENT_SEEK) return DoSeek(self, event);
  if (GST_EVENT_TYPE(event) != GST_EVENT_EOS) return FALSE;
  self->state->end_wanted = true;
  return TRUE;
}

/// Closes the recording. The task must have ended, and the pads must be inactive.
static void Close(GstLidarMcapSrc* self) {
  State& state = *self->state;
  {
    std::lock_guard lock(state.mutex);
    state.is_open = false;
    state.last_seek = GST_SEQNUM_INVALID;
  }
  // Takes the lock, because a seek in another thread may still use `run`.
  g_rec_mutex_lock(state.task.lock());
  Run run = std::exchange(state.run, Run());
  g_rec_mutex_unlock(state.task.lock());
  run = {};  // removes the pads, without the lock
  state.end_wanted = false;
}

static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange transition) {
  auto* self = GST_LIDAR_MCAP_SRC(element);
  State& state = *self->state;
  if (transition == GST_STATE_CHANGE_READY_TO_PAUSED && !Open(self))
    return GST_STATE_CHANGE_FAILURE;
  if (transition == GST_STATE_CHANGE_PAUSED_TO_READY) {
    state.stopping = true;
    state.task.Stop();
  }
  const auto result =
      GST_ELEMENT_CLASS(gst_lidar_mcap_src_parent_class)->change_state(element, transition);
  if (transition == GST_STATE_CHANGE_READY_TO_PAUSED && result != GST_STATE_CHANGE_FAILURE) {
    if (state.task.Start()) return result;
    GST_ELEMENT_ERROR(self, RESOURCE, FAILED, ("Cannot start the thread that plays the recording."),
                      (nullptr));
    return GST_STATE_CHANGE_FAILURE;
  }
  if (transition == GST_STATE_CHANGE_PAUSED_TO_READY) {
    state.task.Join();
    Close(self);
  }
  return result;
}

State::State(GstLidarMcapSrc* self) : task(Loop, self) {
  gst_segment_init(&segment, GST_FORMAT_TIME);
}

static void gst_lidar_mcap_src_init(GstLidarMcapSrc* self) {
  self->state = new State(self);
  GST_OBJECT_FLAG_SET(self, GST_ELEMENT_FLAG_SOURCE);
}

static void gst_lidar_mcap_src_class_init(GstLidarMcapSrcClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_mcap_src_debug, "mcapsrc", 0, "Recordings, played");
  ServeState<GstLidarMcapSrc, gst_lidar_mcap_src_parent_class, kProperties>(klass);
  auto* element = GST_ELEMENT_CLASS(klass);
  element->change_state = ChangeState;
  element->send_event = SendEvent;
  gst_element_class_add_static_pad_template(element, &src_template);
  Describe(klass, {"MCAP player", "Source/File",
                   "Plays slices, clouds, IMU samples and odometry from MCAP files"});
}
