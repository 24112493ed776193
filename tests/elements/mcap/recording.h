// SPDX-License-Identifier: LGPL-2.1-or-later
// Pipelines that record and play, which tests run to their end.
#pragma once
#include <gst/gst.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "gst/common/buffer_map.h"
#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"
#include "tests/support/element_bus.h"
#include "tests/support/element_stats.h"
#include "tests/support/files.h"
#include "tests/support/harness.h"
#include "tests/support/patience.h"

namespace lidar::test {

constexpr GstClockTime kCapture = GstClockTime{1'764'000'000} * GST_SECOND;

/// Returns an mcapsink with one stream. The harness starts the element, so the location is set
/// before.
inline Harness RecordingTo(const std::string& path) {
  const gst::ElementPtr sink(gst_element_factory_make("mcapsink", nullptr));
  g_object_set(sink.get(), "location", path.c_str(), nullptr);
  return Harness(gst_harness_new_with_element(sink.get(), "sink_0", nullptr));
}

/// The content of a buffer that a test stores.
struct Kept {
  std::string bytes;
  GstClockTime pts = 0;
  GstClockTime duration = 0;
  GstClockTime capture_time = 0;
  GstLidarSlice slice{};
  bool discont = false;

  bool SameAs(const Kept& o) const {
    return bytes == o.bytes && capture_time == o.capture_time && slice.scan_id == o.slice.scan_id &&
           slice.slice_index == o.slice.slice_index && slice.slice_count == o.slice.slice_count &&
           slice.first_column == o.slice.first_column;
  }
};

inline void PrintTo(const Kept& kept, std::ostream* out) {
  *out << kept.bytes.size() << " bytes, captured at " << kept.capture_time << ", scan "
       << kept.slice.scan_id << ", slice " << kept.slice.slice_index << " of "
       << kept.slice.slice_count << " from column " << kept.slice.first_column;
}

inline Kept Keep(GstBuffer* buffer) {
  Kept kept;
  const gst::BufferMap map(buffer, GST_MAP_READ);
  kept.bytes.assign(map.data(), map.data() + map.size());
  kept.pts = GST_BUFFER_PTS(buffer);
  kept.duration = GST_BUFFER_DURATION(buffer);
  kept.capture_time = gst_lidar_buffer_get_capture_time(buffer);
  gst_lidar_buffer_get_slice(buffer, &kept.slice);
  kept.discont = GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_DISCONT);
  return kept;
}

/// The content of mcapsink's message about a complete file.
struct CompleteFile {
  std::string location;
  guint64 messages = 0;
  guint64 size = 0;
  guint64 start_time = 0;
  guint64 end_time = 0;
};

/// Expects that exactly the written buffers were played, and that their times begin at 0.
inline void ExpectSame(const std::vector<Kept>& read, const std::vector<Kept>& written) {
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_TRUE(read[i].SameAs(written[i])) << i;
    EXPECT_EQ(read[i].pts, written[i].pts - written[0].pts) << i;
    EXPECT_EQ(read[i].duration, written[i].duration) << i;
  }
}

/// The results of a pipeline.
struct Outcome {
  std::map<std::string, std::vector<Kept>> buffers;  // by the name of the fakesink or identity
  std::map<std::string, std::string> caps;
  std::string error;  // empty after EOS
  std::string warning;
  std::map<std::string, std::vector<std::pair<GstClockTime, GstClockTime>>> gaps;  // [ms]
  gint64 segment_done = -1;
  std::vector<CompleteFile> complete;
  std::map<std::string, guint64> stats;  // statistics of mcapsrc or mcapsink
};

class Pipeline {
 public:
  /// Makes the pipeline. It stores the buffers of elements whose names begin with "see".
  explicit Pipeline(const std::string& description) {
    GError* raw = nullptr;
    pipeline_.reset(gst_parse_launch(description.c_str(), &raw));
    const gst::ErrorPtr error(raw);
    EXPECT_EQ(error ? error->message : std::string(), "") << description;
    GstIterator* elements = gst_bin_iterate_elements(GST_BIN(pipeline_.get()));
    gst_iterator_foreach(
        elements,
        [](const GValue* v, gpointer self) {
          static_cast<Pipeline*>(self)->Watch(GST_ELEMENT(g_value_get_object(v)));
        },
        this);
    gst_iterator_free(elements);
  }
  ~Pipeline() { gst_element_set_state(pipeline_.get(), GST_STATE_NULL); }

  GstElement* get() const { return pipeline_.get(); }
  gst::ElementPtr Find(const char* name) const {
    return gst::ElementPtr(gst_bin_get_by_name(GST_BIN(pipeline_.get()), name));
  }

  /// Plays until EOS, an error or a message of type `until`. Then stops the pipeline.
  Outcome Run(GstMessageType until = GST_MESSAGE_EOS) {
    gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING);
    Wait(until);
    TakeStats();
    gst_element_set_state(pipeline_.get(), GST_STATE_NULL);
    return outcome();
  }
  /// Waits until the statistic `name` is at least `least`. Returns false if that takes too long.
  bool AwaitStat(const char* name, guint64 least) {
    const gint64 end = g_get_monotonic_time() + kPatience_us;
    for (; outcome_.stats[name] < least && g_get_monotonic_time() < end; TakeStats())
      g_usleep(2000);
    return outcome_.stats[name] >= least;
  }
  /// Waits for a message of type `until`. Returns false if an error is posted first or if no
  /// message comes.
  bool Wait(GstMessageType until) {
    const ElementBus bus(pipeline_.get());
    bool good = false;
    for (bool ended = false; !ended;) {
      const gst::MessagePtr message = bus.Wait();
      if (!message) {
        ADD_FAILURE() << "nothing happens";
        break;
      }
      Note(message.get());
      good = (GST_MESSAGE_TYPE(message.get()) & until) != 0;
      ended = good || GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_ERROR;
    }
    return good;
  }
  Outcome outcome() const {
    const std::lock_guard lock(mutex_);
    return outcome_;
  }
  /// Forgets the buffers, gaps and errors so far.
  void Forget() {
    const std::lock_guard lock(mutex_);
    outcome_.buffers.clear();
    outcome_.gaps.clear();
    outcome_.error.clear();
  }

 private:
  static void OnBuffer(GstElement* element, GstBuffer* buffer, gpointer, gpointer self) {
    const gst::StringPtr name(gst_object_get_name(GST_OBJECT(element)));
    auto* pipeline = static_cast<Pipeline*>(self);
    Kept kept = Keep(buffer);
    const std::lock_guard lock(pipeline->mutex_);
    pipeline->outcome_.buffers[name.get()].push_back(std::move(kept));
  }
  static void OnIdentity(GstElement* element, GstBuffer* buffer, gpointer self) {
    OnBuffer(element, buffer, nullptr, self);
  }
  void Watch(GstElement* element) {
    const gst::StringPtr name(gst_object_get_name(GST_OBJECT(element)));
    if (!g_str_has_prefix(name.get(), "see")) return;
    const std::string type = G_OBJECT_TYPE_NAME(element);
    g_object_set(element, "signal-handoffs", TRUE, nullptr);
    g_signal_connect(element, "handoff",
                     type == "GstFakeSink" ? G_CALLBACK(OnBuffer) : G_CALLBACK(OnIdentity), this);
    const gst::PadPtr pad(gst_element_get_static_pad(element, "sink"));
    gst_pad_add_probe(pad.get(), GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM, OnEvent, this, nullptr);
  }
  static GstPadProbeReturn OnEvent(GstPad* pad, GstPadProbeInfo* info, gpointer self) {
    GstEvent* event = GST_PAD_PROBE_INFO_EVENT(info);
    auto* pipeline = static_cast<Pipeline*>(self);
    Outcome& outcome = pipeline->outcome_;
    const std::lock_guard lock(pipeline->mutex_);
    const gst::StringPtr name(gst_object_get_name(GST_OBJECT_PARENT(pad)));
    if (GST_EVENT_TYPE(event) == GST_EVENT_CAPS) {
      GstCaps* caps = nullptr;
      gst_event_parse_caps(event, &caps);
      const gst::StringPtr text(gst_caps_to_string(caps));
      outcome.caps[name.get()] = text.get();
    } else if (GST_EVENT_TYPE(event) == GST_EVENT_GAP) {
      GstClockTime begin = 0, length = 0;
      gst_event_parse_gap(event, &begin, &length);
      outcome.gaps[name.get()].emplace_back(begin / GST_MSECOND, length / GST_MSECOND);
    }
    return GST_PAD_PROBE_OK;
  }
  void Note(GstMessage* message) {
    if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) {
      if (outcome_.error.empty()) outcome_.error = MessageText(message);
    } else if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_WARNING) {
      outcome_.warning = MessageText(message);
    } else if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ELEMENT) {
      const GstStructure* s = gst_message_get_structure(message);
      if (gst_structure_has_name(s, "mcap-file-complete")) NoteComplete(s);
    } else if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_SEGMENT_DONE) {
      gst_message_parse_segment_done(message, nullptr, &outcome_.segment_done);
    }
  }
  void NoteComplete(const GstStructure* s) {
    CompleteFile file;
    file.location = gst_structure_get_string(s, "location");
    gst_structure_get_uint64(s, "messages", &file.messages);
    gst_structure_get_uint64(s, "size", &file.size);
    gst_structure_get_uint64(s, "start-time", &file.start_time);
    gst_structure_get_uint64(s, "end-time", &file.end_time);
    outcome_.complete.push_back(std::move(file));
  }
  void TakeStats() {
    const gst::ElementPtr element = Find("m");
    if (!element ||
        g_object_class_find_property(G_OBJECT_GET_CLASS(element.get()), "stats") == nullptr)
      return;
    const gst::StructurePtr stats = StatsOf(element.get());
    for (gint i = 0; i < gst_structure_n_fields(stats.get()); ++i) {
      const gchar* name = gst_structure_nth_field_name(stats.get(), static_cast<guint>(i));
      gst_structure_get_uint64(stats.get(), name, &outcome_.stats[name]);
    }
  }

  gst::ElementPtr pipeline_;
  // Guards the buffers, caps and gaps, because each stream has a thread of its own.
  mutable std::mutex mutex_;
  Outcome outcome_;
};

inline Outcome Play(const std::string& description) { return Pipeline(description).Run(); }

class Recording : public FolderTest {
 protected:
  std::string Path(const std::string& name) const { return folder_ + "/" + name; }
  std::string At(const std::string& name) const { return " location=" + Path(name) + " "; }
  std::vector<std::string> Files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }
  /// Records `scans` scans of the synthetic sensor as coded slices. Returns the slices.
  std::vector<Kept> Record(int scans, const std::string& options, const std::string& name) {
    const auto outcome =
        Play(kSensor + " num-buffers=" + std::to_string(8 * scans) +
             " ! lidarenc ! identity name=see ! mcapsink name=m " + options + At(name));
    EXPECT_EQ(outcome.error, "");
    caps_ = outcome.caps.at("see");
    files_ = outcome.complete;
    return outcome.buffers.at("see");
  }

  const std::string kSensor = "lidartestsrc model=os1-32 mode=512x10";
  std::string caps_;  // caps of what Record() wrote last
  std::vector<CompleteFile> files_;
};

}  // namespace lidar::test
