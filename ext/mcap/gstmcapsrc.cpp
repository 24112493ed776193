// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-mcapsrc
 *
 * Plays MCAP files: a pad for each topic.
 *
 * |[
 * gst-launch-1.0 mcapsrc location=drive.mcap ! lidardec ! scanassembler ! fakesink
 * ]|
 */
#include "ext/mcap/gstmcapsrc.h"

#include <gst/base/gstflowcombiner.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "ext/mcap/playback.h"
#include "ext/mcap/played_stream.h"
#include "gst/common/properties.h"
#include "gst/common/stats.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_mcap_src_debug);
#define GST_CAT_DEFAULT gst_lidar_mcap_src_debug

namespace {

using lidar::gst::Playback;
using lidar::gst::PlaybackGroup;
using lidar::gst::PlayedStream;

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
const std::array<lidar::gst::Stat<Counters>, 5> kStats = {{
    {"messages", &Counters::messages},
    {"messages-dropped", &Counters::messages_dropped},
    {"chunks-damaged", &Counters::chunks_damaged},
    {"files-unclosed", &Counters::files_unclosed},
    {"files-unreadable", &Counters::files_unreadable},
}};

struct FreeCombiner {
  void operator()(GstFlowCombiner* p) const { gst_flow_combiner_free(p); }
};

/// Belongs to the streaming thread, and to who holds `task_lock` while that stands still.
struct Run {
  std::unique_ptr<Playback> playback;
  std::vector<std::unique_ptr<PlayedStream>> streams;
  std::unique_ptr<GstFlowCombiner, FreeCombiner> flows{gst_flow_combiner_new()};
  PlaybackGroup group;
  bool told_no_more_pads = false;
};

struct State {
  std::mutex mutex;  // guards what follows; never held while pushing or posting
  Settings settings;
  Counters counters;
  GstSegment segment{};  // as the task plays it, its position included
  GstClockTime duration = GST_CLOCK_TIME_NONE;
  bool is_open = false;
  bool may_run = false;  // the task; what is stopped stays so
  guint32 last_seek = GST_SEQNUM_INVALID;

  std::atomic<bool> end_wanted{false};
  GRecMutex task_lock;
  GstTask* task = nullptr;
  Run run;
};

lidar::gst::StructurePtr Stats(GObject* object);

const std::array<lidar::gst::Property<Settings>, 3> kProperties = {{
    {"location", "File to play; with a number (rec-%05d.mcap) all files of a recording",
     &Settings::location},
    {"topic", "Play this topic only; NULL: all", &Settings::topic},
    {"stats",
     "messages, messages-dropped, chunks-damaged, files-unclosed (which are played up to their "
     "end),"
     " files-unreadable",
     Stats},
}};

}  // namespace

struct _GstLidarMcapSrc {
  GstElement parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarMcapSrc, gst_lidar_mcap_src, GST_TYPE_ELEMENT)
GST_ELEMENT_REGISTER_DEFINE(mcapsrc, "mcapsrc", GST_RANK_NONE, GST_TYPE_LIDAR_MCAP_SRC)

static GstStaticPadTemplate src_template =
    GST_STATIC_PAD_TEMPLATE("src_%u", GST_PAD_SRC, GST_PAD_SOMETIMES, GST_STATIC_CAPS_ANY);

namespace {

gboolean SrcEvent(GstPad* pad, GstObject* parent, GstEvent* event);
gboolean SrcQuery(GstPad* pad, GstObject* parent, GstQuery* query);

lidar::gst::StructurePtr Stats(GObject* object) {
  State& state = *GST_LIDAR_MCAP_SRC(object)->state;
  std::lock_guard lock(state.mutex);
  return lidar::gst::ToStructure("mcap-src-stats", kStats, state.counters);
}

/// False where the task cannot do so. Once it is stopped, nobody wakes it but a change of state.
bool SetTaskState(State* state, GstTaskState wanted) {
  std::lock_guard lock(state->mutex);
  return state->may_run && gst_task_set_state(state->task, wanted) != FALSE;
}

bool StartTask(State* state) {
  std::lock_guard lock(state->mutex);
  state->may_run = true;
  return gst_task_set_state(state->task, GST_TASK_STARTED) != FALSE;
}

void StopTask(State* state) {
  std::lock_guard lock(state->mutex);
  state->may_run = false;
  gst_task_set_state(state->task, GST_TASK_STOPPED);
}

bool IsWanted(const Settings& settings, const std::string& topic) {
  return settings.topic.empty() || settings.topic == topic;
}

/// The stream of `topic`, which is made where it is missing.
PlayedStream* StreamOf(GstLidarMcapSrc* self, const std::string& topic) {
  Run& run = self->state->run;
  for (const auto& stream : run.streams)
    if (stream->topic() == topic) return stream.get();
  const std::string name = "src_" + std::to_string(run.streams.size());
  GstPad* pad = gst_pad_new_from_static_template(&src_template, name.c_str());
  gst_pad_use_fixed_caps(pad);
  gst_pad_set_event_function(pad, SrcEvent);
  gst_pad_set_query_function(pad, SrcQuery);
  gst_object_ref_sink(pad);
  run.streams.push_back(std::make_unique<PlayedStream>(GST_ELEMENT(self), pad, topic));
  gst_flow_combiner_add_pad(run.flows.get(), pad);
  return run.streams.back().get();
}

/// Shows the pads whose caps the recording's channels tell, so that they are there from the start.
void ShowKnownPads(GstLidarMcapSrc* self, const Settings& settings) {
  Run& run = self->state->run;
  bool all = true;
  for (const auto& [schema, channel] : run.playback->topics()) {
    if (!IsWanted(settings, channel.topic)) continue;
    if (!lidar::gst::MessageReader::Make(schema, channel)) continue;
    PlayedStream* stream = StreamOf(self, channel.topic);
    all = stream->Follow(schema, channel) && stream->Prepare(run.group) && all;
  }
  if (!all || std::exchange(run.told_no_more_pads, true)) return;
  gst_element_no_more_pads(GST_ELEMENT(self));
}

std::string TopicNames(const Playback& playback) {
  std::string names;
  for (const auto& topic : playback.topics())
    names += (names.empty() ? "" : ", ") + topic.channel.topic + " (" + topic.schema.name + ")";
  return names.empty() ? "none" : names;
}

/// True where there is something to play, as far as known before it is read.
bool HasTopic(const Playback& playback, const Settings& settings) {
  return std::any_of(playback.topics().begin(), playback.topics().end(), [&](const auto& topic) {
    return IsWanted(settings, topic.channel.topic) &&
           lidar::gst::MessageReader::Make(topic.schema, topic.channel) != nullptr;
  });
}

bool Open(GstLidarMcapSrc* self) {
  State& state = *self->state;
  Settings settings;
  {
    std::lock_guard lock(state.mutex);
    settings = state.settings;
    state.counters = {};
  }
  std::string why = "there is no location";
  auto playback = settings.location.empty() ? nullptr : Playback::Open(settings.location, &why);
  if (!playback) {
    GST_ELEMENT_ERROR(self, RESOURCE, OPEN_READ,
                      ("Cannot play \"%s\": %s.", settings.location.c_str(), why.c_str()),
                      (nullptr));
    return false;
  }
  if (!HasTopic(*playback, settings)) {
    GST_ELEMENT_ERROR(
        self, STREAM, WRONG_TYPE,
        ("\"%s\" holds nothing that can be played.", settings.location.c_str()),
        ("wanted: %s; topics: %s", settings.topic.empty() ? "any" : settings.topic.c_str(),
         TopicNames(*playback).c_str()));
    return false;
  }
  if (playback->unclosed_files() > 0)
    GST_INFO_OBJECT(self, "%" G_GUINT64_FORMAT " files were not closed",
                    playback->unclosed_files());
  if (playback->unreadable_files() > 0)
    GST_ELEMENT_WARNING(self, RESOURCE, READ,
                        ("%" G_GUINT64_FORMAT " files of the recording cannot be read.",
                         playback->unreadable_files()),
                        ("the last one: %s", why.c_str()));
  Run& run = state.run;
  gst_segment_init(&run.group.segment, GST_FORMAT_TIME);
  run.group.group_id = gst_util_group_id_next();
  const guint64 span = playback->end_time() - playback->start_time();
  run.group.segment.duration = std::min<guint64>(span, G_MAXINT64);
  std::lock_guard lock(state.mutex);
  state.counters.files_unclosed = playback->unclosed_files();
  state.counters.files_unreadable = playback->unreadable_files();
  state.segment = run.group.segment;
  state.duration = run.group.segment.duration;
  state.is_open = true;
  run.playback = std::move(playback);
  return true;
}

void EndAll(GstLidarMcapSrc* self, bool with_segment_done) {
  Run& run = self->state->run;
  const GstSegment& segment = run.group.segment;
  const auto position =
      static_cast<gint64>(GST_CLOCK_TIME_IS_VALID(segment.stop) ? segment.stop : segment.duration);
  if (with_segment_done) {
    {
      // A seek without a flush goes on from here.
      std::lock_guard lock(self->state->mutex);
      self->state->segment.position = static_cast<guint64>(position);
    }
    GstMessage* message = gst_message_new_segment_done(GST_OBJECT(self), GST_FORMAT_TIME, position);
    if (run.group.seqnum != GST_SEQNUM_INVALID) gst_message_set_seqnum(message, run.group.seqnum);
    gst_element_post_message(GST_ELEMENT(self), message);
  }
  for (const auto& stream : run.streams)
    stream->End(run.group, with_segment_done ? gst_event_new_segment_done(GST_FORMAT_TIME, position)
                                             : gst_event_new_eos());
}

void Finish(GstLidarMcapSrc* self) {
  Run& run = self->state->run;
  const bool shown = std::any_of(run.streams.begin(), run.streams.end(),
                                 [](const auto& stream) { return stream->is_added(); });
  if (!std::exchange(run.told_no_more_pads, true)) gst_element_no_more_pads(GST_ELEMENT(self));
  if (!shown && !self->state->end_wanted)
    GST_ELEMENT_ERROR(self, STREAM, DEMUX, ("No message of the recording can be read."), (nullptr));
  EndAll(self, (run.group.segment.flags & GST_SEGMENT_FLAG_SEGMENT) != 0);
}

/// Posts what is an error, and stops the task.
void Stop(GstLidarMcapSrc* self, GstFlowReturn flow) {
  GST_DEBUG_OBJECT(self, "stops: %s", gst_flow_get_name(flow));
  // First, so that a seek that answers the end starts it again.
  SetTaskState(self->state, GST_TASK_PAUSED);
  if (flow == GST_FLOW_EOS) return Finish(self);
  if (flow != GST_FLOW_NOT_LINKED && flow > GST_FLOW_EOS) return;
  GST_ELEMENT_FLOW_ERROR(self, flow);
  EndAll(self, false);
}

void Count(State* state, bool dropped, GstClockTime position) {
  std::lock_guard lock(state->mutex);
  ++state->counters.messages;
  if (dropped) ++state->counters.messages_dropped;
  state->counters.chunks_damaged = state->run.playback->damaged_chunks();
  state->segment.position = position;
}

/// The message as a buffer on its pad.
GstFlowReturn PlayItem(GstLidarMcapSrc* self, const Playback::Item& item, GstClockTime pts) {
  State& state = *self->state;
  Run& run = state.run;
  PlayedStream* stream = StreamOf(self, item.channel->topic);
  lidar::gst::BufferPtr buffer;
  if (stream->Follow(*item.schema, *item.channel)) buffer = stream->Read(item.message.data, pts);
  const bool usable = buffer != nullptr && stream->Prepare(run.group);
  Count(&state, !usable, pts);
  if (!usable) {
    GST_WARNING_OBJECT(self, "dropping a message on %s that is damaged", stream->topic().c_str());
    return GST_FLOW_OK;
  }
  for (const auto& other : run.streams)
    if (other.get() != stream) other->FillUpTo(pts, run.group);
  return gst_flow_combiner_update_pad_flow(run.flows.get(), stream->pad(),
                                           stream->Push(std::move(buffer)));
}

void Loop(gpointer user_data) {
  auto* self = GST_LIDAR_MCAP_SRC(user_data);
  State& state = *self->state;
  Run& run = state.run;
  Settings settings;
  {
    std::lock_guard lock(state.mutex);
    settings = state.settings;
  }
  if (run.streams.empty()) ShowKnownPads(self, settings);
  const auto item = state.end_wanted ? std::nullopt : run.playback->Next();
  if (!item) return Stop(self, GST_FLOW_EOS);
  if (!IsWanted(settings, item->channel->topic) || !lidar::gst::TypeOf(*item->schema)) return;
  const std::uint64_t start = run.playback->start_time();
  const std::uint64_t log_time = std::max(item->message.header.log_time, start);
  const GstClockTime pts = std::min<guint64>(log_time - start, G_MAXINT64);
  if (GST_CLOCK_TIME_IS_VALID(run.group.segment.stop) && pts >= run.group.segment.stop)
    return Stop(self, GST_FLOW_EOS);
  const GstFlowReturn flow = PlayItem(self, *item, pts);
  if (flow != GST_FLOW_OK) Stop(self, flow);
}

/// What a seek asks for, as far as we can do it.
struct Seek {
  gdouble rate = 1;
  GstFormat format = GST_FORMAT_UNDEFINED;
  GstSeekFlags flags = GST_SEEK_FLAG_NONE;
  GstSeekType start_type = GST_SEEK_TYPE_NONE;
  gint64 start = 0;
  GstSeekType stop_type = GST_SEEK_TYPE_NONE;
  gint64 stop = 0;
};

/// Pads of the element, so that they can be told without touching what the task owns.
void PushToAll(GstLidarMcapSrc* self, GstEvent* event) {
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

/// The task stands still and its lock is held.
void Restart(GstLidarMcapSrc* self, const Seek& seek, guint32 seqnum) {
  State& state = *self->state;
  Run& run = state.run;
  gboolean update = FALSE;
  GstSegment& segment = run.group.segment;
  {
    std::lock_guard lock(state.mutex);
    segment.position = state.segment.position;
    gst_segment_do_seek(&segment, seek.rate, seek.format, seek.flags, seek.start_type,
                        static_cast<guint64>(seek.start), seek.stop_type,
                        static_cast<guint64>(seek.stop), &update);
    state.segment = segment;
  }
  run.group.seqnum = seqnum;
  run.playback->Seek(run.playback->start_time() + segment.position);
  for (const auto& stream : run.streams) stream->Restart(segment.start);
  gst_flow_combiner_reset(run.flows.get());
}

bool DoSeek(GstLidarMcapSrc* self, GstEvent* event) {
  State& state = *self->state;
  Seek seek;
  gst_event_parse_seek(event, &seek.rate, &seek.format, &seek.flags, &seek.start_type, &seek.start,
                       &seek.stop_type, &seek.stop);
  const guint32 seqnum = gst_event_get_seqnum(event);
  {
    std::lock_guard lock(state.mutex);
    if (!state.is_open || seek.rate <= 0 || seek.format != GST_FORMAT_TIME) return false;
    // Each sink sends the same one upstream.
    if (std::exchange(state.last_seek, seqnum) == seqnum) return true;
  }
  const bool flush = (seek.flags & GST_SEEK_FLAG_FLUSH) != 0;
  if (flush) {
    GstEvent* start = gst_event_new_flush_start();
    gst_event_set_seqnum(start, seqnum);
    PushToAll(self, start);
  }
  SetTaskState(&state, GST_TASK_PAUSED);
  g_rec_mutex_lock(&state.task_lock);
  bool open = false;  // it may have been closed meanwhile
  {
    std::lock_guard lock(state.mutex);
    open = state.is_open;
  }
  if (open) Restart(self, seek, seqnum);
  if (flush) {
    GstEvent* stop = gst_event_new_flush_stop(TRUE);
    gst_event_set_seqnum(stop, seqnum);
    PushToAll(self, stop);
  }
  if (open) SetTaskState(&state, GST_TASK_STARTED);
  g_rec_mutex_unlock(&state.task_lock);
  return open;
}

gboolean SrcEvent(GstPad* pad, GstObject* parent, GstEvent* event) {
  if (GST_EVENT_TYPE(event) != GST_EVENT_SEEK) return gst_pad_event_default(pad, parent, event);
  const lidar::gst::EventPtr owner(event);
  return DoSeek(GST_LIDAR_MCAP_SRC(parent), event);
}

gboolean SendEvent(GstElement* element, GstEvent* event) {
  auto* self = GST_LIDAR_MCAP_SRC(element);
  const lidar::gst::EventPtr owner(event);
  if (GST_EVENT_TYPE(event) == GST_EVENT_SEEK) return DoSeek(self, event);
  if (GST_EVENT_TYPE(event) != GST_EVENT_EOS) return FALSE;
  self->state->end_wanted = true;
  return TRUE;
}

bool AnswerSegment(const GstSegment& s, GstQuery* query) {
  const auto start = gst_segment_to_stream_time(&s, GST_FORMAT_TIME, s.start);
  const auto stop = GST_CLOCK_TIME_IS_VALID(s.stop)
                        ? gst_segment_to_stream_time(&s, GST_FORMAT_TIME, s.stop)
                        : s.duration;
  gst_query_set_segment(query, s.rate, GST_FORMAT_TIME, static_cast<gint64>(start),
                        static_cast<gint64>(stop));
  return true;
}

/// False where another one has to answer.
bool Answer(State* state, GstQuery* query) {
  std::lock_guard lock(state->mutex);
  GstFormat format = GST_FORMAT_TIME;
  const auto duration = static_cast<gint64>(state->duration);
  switch (GST_QUERY_TYPE(query)) {
    case GST_QUERY_DURATION:
      gst_query_parse_duration(query, &format, nullptr);
      if (format != GST_FORMAT_TIME) return false;
      gst_query_set_duration(query, format, duration);
      return true;
    case GST_QUERY_POSITION:
      gst_query_parse_position(query, &format, nullptr);
      if (format != GST_FORMAT_TIME) return false;
      gst_query_set_position(query, format, static_cast<gint64>(state->segment.position));
      return true;
    case GST_QUERY_SEEKING:
      gst_query_parse_seeking(query, &format, nullptr, nullptr, nullptr);
      if (format != GST_FORMAT_TIME) return false;
      gst_query_set_seeking(query, format, TRUE, 0, duration);
      return true;
    case GST_QUERY_SEGMENT:
      return AnswerSegment(state->segment, query);
    default:
      return false;
  }
}

gboolean SrcQuery(GstPad* pad, GstObject* parent, GstQuery* query) {
  return Answer(GST_LIDAR_MCAP_SRC(parent)->state, query) ||
         gst_pad_query_default(pad, parent, query);
}

/// The task is gone and the pads are inactive.
void Close(GstLidarMcapSrc* self) {
  State& state = *self->state;
  {
    std::lock_guard lock(state.mutex);
    state.is_open = false;
    state.last_seek = GST_SEQNUM_INVALID;
  }
  // A seek may still be at work on it.
  g_rec_mutex_lock(&state.task_lock);
  const Run run = std::exchange(state.run, Run());
  g_rec_mutex_unlock(&state.task_lock);
  for (const auto& stream : run.streams) {
    if (stream->is_added()) gst_element_remove_pad(GST_ELEMENT(self), stream->pad());
    gst_object_unref(stream->pad());
  }
  state.end_wanted = false;
}

GstStateChangeReturn ChangeState(GstElement* element, GstStateChange transition) {
  auto* self = GST_LIDAR_MCAP_SRC(element);
  State& state = *self->state;
  if (transition == GST_STATE_CHANGE_READY_TO_PAUSED && !Open(self))
    return GST_STATE_CHANGE_FAILURE;
  if (transition == GST_STATE_CHANGE_PAUSED_TO_READY) StopTask(&state);
  const auto result =
      GST_ELEMENT_CLASS(gst_lidar_mcap_src_parent_class)->change_state(element, transition);
  if (transition == GST_STATE_CHANGE_READY_TO_PAUSED && result != GST_STATE_CHANGE_FAILURE) {
    if (StartTask(&state)) return result;
    GST_ELEMENT_ERROR(self, RESOURCE, FAILED, ("No thread can be started."), (nullptr));
    return GST_STATE_CHANGE_FAILURE;
  }
  if (transition == GST_STATE_CHANGE_PAUSED_TO_READY) {
    gst_task_join(state.task);
    Close(self);
  }
  return result;
}

void Finalize(GObject* object) {
  State* state = GST_LIDAR_MCAP_SRC(object)->state;
  gst_object_unref(state->task);
  g_rec_mutex_clear(&state->task_lock);
  delete state;
  G_OBJECT_CLASS(gst_lidar_mcap_src_parent_class)->finalize(object);
}

}  // namespace

static void gst_lidar_mcap_src_init(GstLidarMcapSrc* self) {
  self->state = new State;
  g_rec_mutex_init(&self->state->task_lock);
  self->state->task = gst_task_new(Loop, self, nullptr);
  gst_task_set_lock(self->state->task, &self->state->task_lock);
  GST_OBJECT_FLAG_SET(self, GST_ELEMENT_FLAG_SOURCE);
}

static void gst_lidar_mcap_src_class_init(GstLidarMcapSrcClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_mcap_src_debug, "mcapsrc", 0, "Recordings, played");
  auto* object = G_OBJECT_CLASS(klass);
  object->finalize = Finalize;
  lidar::gst::ServeProperties<GstLidarMcapSrc, kProperties>(object);
  auto* element = GST_ELEMENT_CLASS(klass);
  element->change_state = ChangeState;
  element->send_event = SendEvent;
  gst_element_class_add_static_pad_template(element, &src_template);
  gst_element_class_set_static_metadata(element, "MCAP player", "Source/File",
                                        "Plays slices, clouds, IMU samples and odometry from MCAP "
                                        "files",
                                        "gst-lidar");
}
