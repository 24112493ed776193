// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-mcapsink
 *
 * Records coded slices, clouds, IMU samples and odometry into MCAP files.
 *
 * |[
 * gst-launch-1.0 -e lidartestsrc num-buffers=80 ! lidarenc ! mcapsink location=drive.mcap
 * ]|
 */
#include "ext/mcap/gstmcapsink.h"

#include <algorithm>
#include <memory>
#include <mutex>
#include <set>
#include <utility>
#include <vector>

#include "ext/mcap/gstmcapstream.h"
#include "ext/mcap/recorder.h"
#include "ext/mcap/timeline.h"
#include "gst/common/element_class.h"
#include "gst/common/enum_type.h"
#include "gst/common/properties.h"
#include "gst/common/stats.h"
#include "gst/lidar/gstlidar.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_mcap_sink_debug);
#define GST_CAT_DEFAULT gst_lidar_mcap_sink_debug

namespace {

using namespace lidar::gst;
using lidar::mcap::Compression;

struct Settings {
  std::string location;
  RecorderSettings recorder;
  Compression compression = Compression::kZstd;
  lidar::DataSize chunk_size = lidar::DataSize::Bytes(1 << 20);
};

using lidar::mcap::WriterSettings;

GType CompressionType() {
  static const GEnumValue values[] = {
      {Int(Compression::kNone), "Chunks as they are", "none"},
      {Int(Compression::kLz4), "The least CPU time", "lz4"},
      {Int(Compression::kZstd), "The smallest files", "zstd"},
      {0, nullptr, nullptr},
  };
  static const GType type = RegisterEnum("GstLidarMcapCompression", values);
  return type;
}

struct Counters {
  guint64 messages = 0;
  guint64 bytes = 0;
  guint64 files = 0;
  guint64 chunks = 0;
};
const std::array<Stat<Counters>, 4> kStats = {{
    {"messages", &Counters::messages},
    {"bytes", &Counters::bytes},
    {"files", &Counters::files},
    {"chunks", &Counters::chunks},
}};

struct State {
  // Guards the settings and the counters. It is not locked while writing, because a disk may hang.
  std::mutex mutex;
  Settings settings;
  Counters counters;

  // Guards the next seven members. It is locked before `mutex`, and never while messages are
  // posted.
  std::mutex recording;
  std::unique_ptr<Recorder> recorder;
  Timeline timeline;
  std::set<std::string> topics;
  std::vector<NewMessage> messages;
  bool has_slices = false;
  bool failed = false;
  Counters counted;  // copied to `counters`

  guint next_pad = 0;  // guarded by the lock of the element
};

}  // namespace

struct _GstLidarMcapSink {
  GstBin parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarMcapSink, gst_lidar_mcap_sink, GST_TYPE_BIN)
GST_ELEMENT_REGISTER_DEFINE(mcapsink, "mcapsink", GST_RANK_NONE, GST_TYPE_LIDAR_MCAP_SINK)

static StructurePtr Stats(GObject* object) {
  State& state = *GST_LIDAR_MCAP_SINK(object)->state;
  std::lock_guard lock(state.mutex);
  return ToStructure("mcap-sink-stats", kStats, state.counters);
}

static const std::array<Property<Settings>, 9> kProperties = {{
    {"location", "File to write; with a number in it (rec-%05d.mcap), one file after the other",
     &Settings::location},
    {"compression", "Compression of chunks; a chunk that would not get smaller is not compressed",
     EnumField<Settings, Compression>{&Settings::compression, CompressionType}},
    {"chunk-size", "A chunk is written once it is larger [bytes]", &Settings::chunk_size, 1024,
     1 << 26},
    {"chunk-duration",
     "A chunk is also written once it lasts longer; a crash loses at most this time [ns]",
     At<&Settings::recorder, &RecorderSettings::writer, &WriterSettings::chunk_duration>, 1,
     3600e9},
    {"max-file-size", "A file ends with the scan that reaches this; 0: no limit [bytes]",
     At<&Settings::recorder, &RecorderSettings::max_file_size>},
    {"max-file-duration", "A file ends with the scan that reaches this; 0: no limit [ns]",
     At<&Settings::recorder, &RecorderSettings::max_file_duration>},
    {"max-files", "Most files to keep: the oldest file is removed first; 0: no limit",
     At<&Settings::recorder, &RecorderSettings::max_files>},
    {"sync-to-disk", "Wait until each chunk is on the disk before the next begins",
     At<&Settings::recorder, &RecorderSettings::sync>},
    {"stats", "messages, bytes, files, chunks", Stats},
}};

static void PostFault(GstLidarMcapSink* self, const RecorderFault& fault) {
  const gchar* reason = g_strerror(fault.error);
  if (fault.error == ENOSPC || fault.error == EDQUOT)
    GST_ELEMENT_ERROR(self, RESOURCE, NO_SPACE_LEFT,
                      ("No space is left for \"%s\".", fault.path.c_str()),
                      ("%s. The recording up to this point is complete.", reason));
  else if (fault.complete)
    GST_ELEMENT_ERROR(self, RESOURCE, OPEN_WRITE,
                      ("\"%s\" is complete and is not overwritten. Put a number into location, as "
                       "in rec-%%05d.mcap, to record further files.",
                       fault.path.c_str()),
                      (nullptr));
  else if (fault.opening)
    GST_ELEMENT_ERROR(self, RESOURCE, OPEN_WRITE,
                      ("Cannot write \"%s\": %s.", fault.path.c_str(), reason), (nullptr));
  else
    GST_ELEMENT_ERROR(self, RESOURCE, WRITE,
                      ("Writing \"%s\" failed: %s.", fault.path.c_str(), reason),
                      ("The recording up to this point is complete."));
}

/// Posts a message for each complete file.
static void PostFinished(GstLidarMcapSink* self, const std::vector<RecordedFile>& files) {
  for (const auto& file : files) {
    const auto& s = file.statistics;
    GST_INFO_OBJECT(self, "%s is complete", file.path.c_str());
    gst_element_post_message(
        GST_ELEMENT(self),
        gst_message_new_element(
            GST_OBJECT(self),
            gst_structure_new("mcap-file-complete", "location", G_TYPE_STRING, file.path.c_str(),
                              "messages", G_TYPE_UINT64, guint64{s.messages}, "size", G_TYPE_UINT64,
                              guint64{file.size}, "start-time", G_TYPE_UINT64,
                              guint64{s.start_time}, "end-time", G_TYPE_UINT64, guint64{s.end_time},
                              nullptr)));
  }
}

/// Copies the counters, so that `stats` shows them. The caller has locked `recording`.
static void TellCounters(State* state) {
  if (state->recorder) state->counted.chunks = state->recorder->chunks();
  std::lock_guard lock(state->mutex);
  state->counters = state->counted;
}

/// Locks the recorder and calls `work`. Posts the resulting messages after the lock is released.
/// Returns false if the recording has already ended, or if `work` fails.
template <class Work>
static bool WithRecorder(GstLidarMcapSink* self, Work work) {
  State& state = *self->state;
  std::optional<RecorderFault> fault;
  std::vector<RecordedFile> finished;
  {
    std::lock_guard lock(state.recording);
    if (!state.recorder || state.failed) return false;
    fault = work(&state);
    finished = state.recorder->TakeFinished();
    state.counted.files += finished.size();
    state.failed = fault.has_value();
    TellCounters(&state);
  }
  PostFinished(self, finished);
  if (fault) PostFault(self, *fault);
  return !fault;
}

/// Creates a recorder from the settings. If that fails, posts an error message and returns false.
static bool Start(GstLidarMcapSink* self) {
  State& state = *self->state;
  std::string why = "it is not set";
  std::optional<RecorderFault> fault;
  {
    std::lock_guard lock(state.recording);
    Settings s = Snapshot(state);
    s.recorder.writer.compression = s.compression;
    s.recorder.writer.chunk_size = static_cast<std::size_t>(s.chunk_size.bytes());
    const bool limited = s.recorder.max_file_size > 0 || s.recorder.max_files > 0 ||
                         s.recorder.max_file_duration > lidar::Duration{};
    auto names =
        s.location.empty() ? std::nullopt : lidar::mcap::FileNames::Parse(s.location, &why);
    if (names && limited && !names->is_numbered()) {
      why = "several files need a number in it, as in rec-%05d.mcap";
      names.reset();
    }
    state.timeline = {};
    state.counted = {};
    state.topics.clear();
    state.has_slices = state.failed = false;
    state.recorder.reset();
    TellCounters(&state);
    if (names) {
      state.recorder = std::make_unique<Recorder>(s.recorder, *std::move(names));
      fault = state.recorder->Check();
      if (!fault) return true;
    }
  }
  if (fault)
    PostFault(self, *fault);
  else
    GST_ELEMENT_ERROR(self, RESOURCE, SETTINGS,
                      ("The property location is wrong: %s.", why.c_str()), (nullptr));
  return false;
}

static void Finish(GstLidarMcapSink* self) {
  WithRecorder(self, [](State* state) { return state->recorder->Finish(); });
}

static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange transition) {
  auto* self = GST_LIDAR_MCAP_SINK(element);
  if (transition == GST_STATE_CHANGE_READY_TO_PAUSED && !Start(self))
    return GST_STATE_CHANGE_FAILURE;
  const auto result =
      GST_ELEMENT_CLASS(gst_lidar_mcap_sink_parent_class)->change_state(element, transition);
  if (transition == GST_STATE_CHANGE_PAUSED_TO_READY) Finish(self);
  return result;
}

static GstPad* RequestPad(GstElement* element, GstPadTemplate* pad_template, const gchar* wanted,
                          const GstCaps*) {
  auto* self = GST_LIDAR_MCAP_SINK(element);
  std::string name;
  do {
    GST_OBJECT_LOCK(self);
    const guint number = self->state->next_pad++;
    GST_OBJECT_UNLOCK(self);
    name = wanted != nullptr ? wanted : "sink_" + std::to_string(number);
    if (const PadPtr taken(gst_element_get_static_pad(element, name.c_str())); !taken) break;
  } while (wanted == nullptr);
  // The stream has the name of its pad, so that applications can set the stream's property as
  // sink_0::topic.
  GstElement* stream = gst_lidar_mcap_stream_new(self, name.c_str());
  if (!gst_bin_add(GST_BIN(self), stream)) return nullptr;
  const PadPtr target(gst_element_get_static_pad(stream, "sink"));
  GstPad* pad = gst_ghost_pad_new_from_template(name.c_str(), target.get(), pad_template);
  gst_pad_set_active(pad, TRUE);
  if (gst_element_add_pad(element, pad)) {
    gst_element_sync_state_with_parent(stream);
    return pad;
  }
  gst_bin_remove(GST_BIN(self), stream);
  return nullptr;
}

static void ReleasePad(GstElement* element, GstPad* pad) {
  const StringPtr name(gst_pad_get_name(pad));
  const ElementPtr stream(gst_bin_get_by_name(GST_BIN(element), name.get()));
  if (stream) {
    // Stops the stream first. This wakes a thread that waits in the stream and holds the lock of
    // the pad.
    gst_element_set_locked_state(stream.get(), TRUE);
    gst_element_set_state(stream.get(), GST_STATE_NULL);
  }
  gst_pad_set_active(pad, FALSE);
  gst_element_remove_pad(element, pad);
  if (stream) gst_bin_remove(GST_BIN(element), stream.get());
}

/// Returns the caps as text, without the fields that may change within a channel. The width of a
/// cloud may change, because each message contains it.
static std::string KindOf(lidar::ScalarCaps caps, MessageType type) {
  auto& fields = caps.fields;
  if (type == MessageType::kCloud)
    fields.erase(std::remove_if(fields.begin(), fields.end(),
                                [](const auto& field) { return field.name == "width"; }),
                 fields.end());
  return caps.ToText().value_or("");
}

/// Returns true if every stream has ended.
static bool HaveAllEnded(GstLidarMcapSink* self) {
  bool all = true;
  GST_OBJECT_LOCK(self);
  for (GList* child = GST_BIN_CHILDREN(self); child != nullptr; child = child->next)
    all = all && gst_lidar_mcap_stream_ended(GST_LIDAR_MCAP_STREAM(child->data));
  GST_OBJECT_UNLOCK(self);
  return all;
}

namespace lidar::gst {

std::string McapSinkFreeTopic(GstLidarMcapSink* sink, const std::string& wanted) {
  State& state = *sink->state;
  std::lock_guard lock(state.recording);
  std::string topic = wanted;
  for (int i = 1; !state.topics.insert(topic).second; ++i) topic = wanted + "_" + std::to_string(i);
  return topic;
}

bool McapSinkAddChannel(GstLidarMcapSink* sink, const BufferWriter& writer,
                        const std::string& topic, const ScalarCaps& caps, RecordedStream* stream) {
  State& state = *sink->state;
  std::unique_lock lock(state.recording);
  if (!state.recorder) return false;
  state.topics.insert(topic);
  state.has_slices = state.has_slices || writer.type() == MessageType::kSlice;
  // If the stream returns to earlier caps, it continues in the channel of these caps.
  const auto [known, is_new] = stream->channels.try_emplace(KindOf(caps, writer.type()));
  stream->channel_id = known->second;
  if (!is_new) return true;
  mcap::Catalogue& catalogue = state.recorder->catalogue();
  mcap::Channel channel;
  channel.schema_id = catalogue.AddSchema(SchemaOf(writer.type()));
  channel.topic = topic;
  channel.message_encoding = "cdr";
  channel.metadata = {{mcap::kCapsKey, caps.ToText().value_or("")}, {kQosKey, ""}};
  stream->channel_id = known->second = catalogue.AddChannel(std::move(channel));
  if (stream->channel_id != 0) return true;
  stream->channels.erase(known);
  lock.unlock();
  GST_ELEMENT_ERROR(sink, STREAM, FORMAT,
                    ("The caps of \"%s\" change too often for one recording.", topic.c_str()),
                    ("The recording up to this point is complete."));
  return false;
}

GstFlowReturn McapSinkTake(GstLidarMcapSink* sink, BufferWriter* writer, RecordedStream* stream,
                           GstBuffer* buffer, GstClockTime running_time) {
  const auto known = [](GstClockTime time) {
    return GST_CLOCK_TIME_IS_VALID(time) ? std::optional<std::uint64_t>(time) : std::nullopt;
  };
  bool understood = true;
  const bool recorded = WithRecorder(sink, [&](State* state) -> std::optional<RecorderFault> {
    const auto now = static_cast<std::uint64_t>(g_get_real_time()) * 1'000;
    const std::uint64_t log_time = state->timeline.LogTime(
        {known(running_time), known(gst_lidar_buffer_get_capture_time(buffer)), now});
    state->messages.clear();
    understood = writer->Write(buffer, log_time, &state->messages);
    GstLidarSlice slice{};
    gst_lidar_buffer_get_slice(buffer, &slice);
    const bool is_slice = writer->type() == MessageType::kSlice;
    const bool begins_scan = is_slice ? slice.slice_index == 0 : !state->has_slices;
    for (const NewMessage& message : state->messages) {
      const mcap::MessageHeader header{stream->channel_id, stream->sequence++,
                                       log_time + message.after, message.publish_time};
      const ByteView data{message.data.data(), message.data.size()};
      if (auto fault = state->recorder->Add(header, data, begins_scan)) return fault;
      ++state->counted.messages;
      state->counted.bytes += message.data.size();
    }
    return std::nullopt;
  });
  if (!understood)
    GST_ELEMENT_ERROR(sink, STREAM, FORMAT, ("A buffer does not match its caps."),
                      ("%" GST_PTR_FORMAT, static_cast<gpointer>(buffer)));
  return recorded && understood ? GST_FLOW_OK : GST_FLOW_ERROR;
}

void McapSinkStreamEnded(GstLidarMcapSink* sink) {
  if (HaveAllEnded(sink)) Finish(sink);
}

void McapSinkFlushed(GstLidarMcapSink* sink) {
  std::lock_guard lock(sink->state->recording);
  sink->state->timeline.Restart();
}

}  // namespace lidar::gst

static void gst_lidar_mcap_sink_init(GstLidarMcapSink* self) {
  self->state = new State;
  GST_OBJECT_FLAG_SET(self, GST_ELEMENT_FLAG_SINK);
}

static void gst_lidar_mcap_sink_class_init(GstLidarMcapSinkClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_mcap_sink_debug, "mcapsink", 0, "Recordings");
  ServeState<GstLidarMcapSink, gst_lidar_mcap_sink_parent_class, kProperties>(klass);
  auto* element = GST_ELEMENT_CLASS(klass);
  element->change_state = ChangeState;
  element->request_new_pad = RequestPad;
  element->release_pad = ReleasePad;
  Describe(klass,
           {"MCAP recorder", "Sink/File",
            "Records slices, clouds, IMU samples and odometry into MCAP files"},
           {{"sink_%u", GST_PAD_SINK, "ANY", GST_PAD_REQUEST}});
}
