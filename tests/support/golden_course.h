// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs an element by a script, and compares what the element did with a golden file.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <optional>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "gst/common/latency.h"
#include "tests/support/golden_lines.h"
#include "tests/support/patience.h"
#include "tests/support/run_trace.h"

namespace lidar::test {

/// The names of the element's pads that a course uses. A name is null if the element has no such
/// pad.
struct CoursePads {
  const char* sink = "sink";
  const char* src = "src";
};

/// Plays the element that `launch` describes. Records each step of the script and everything that
/// the element outputs or posts because of it. The harness upstream of the element is live and has
/// a latency of 20 ms.
class Course {
 public:
  explicit Course(const std::string& launch, const CoursePads& pads = {}, bool with_bytes = true) {
    // Some elements choose the numbers of their streams at random. A fixed seed makes these numbers
    // the same in each run.
    g_random_set_seed(1);
    const gst::ElementPtr element(gst_parse_launch(launch.c_str(), nullptr));
    h_.reset(gst_harness_new_with_element(element.get(), pads.sink, pads.src));
    if (pads.sink != nullptr) gst_harness_set_upstream_latency(h_.get(), 20 * GST_MSECOND);
    trace_.emplace(h_.get(), with_bytes);
    if (pads.sink != nullptr) trace_->WatchUpstream(h_->srcpad);
  }
  ~Course() {
    trace_.reset();
    h_.reset();
    EXPECT_EQ(buffers_, 0) << "that were pushed outlive the element";
  }
  Course(const Course&) = delete;
  Course& operator=(const Course&) = delete;

  GstHarness* harness() { return h_.get(); }
  GstElement* element() { return h_->element; }

  RunTrace* trace() { return &*trace_; }

  void Begin(const std::string& caps) {
    trace_->Begin(caps);
    Note("begin");
  }
  /// Starts a source element, and waits until `count` lines of the trace begin with `line`. Notes
  /// the step as `what`.
  void Play(const std::string& what, const char* line, std::size_t count = 1) {
    gst_element_set_state(element(), GST_STATE_PLAYING);
    Await(what, line, count);
  }
  void Send(const std::string& what, GstEvent* event, const char* line, std::size_t count = 1) {
    if (gst_element_send_event(element(), event))
      Await(what, line, count);
    else
      Note(what + ": refused");
  }
  void Await(const std::string& what, const char* line, std::size_t count = 1) {
    EXPECT_TRUE(Eventually([&] { return trace_->Count(line) >= count; })) << what;
    Note(what);
  }
  guint64 Stat(const char* name) { return StatOf(element(), name); }
  /// Waits until the element's statistic `name` has the value `wanted`.
  void AwaitStat(const char* name, guint64 wanted) {
    EXPECT_TRUE(Eventually([&] { return Stat(name) == wanted; }))
        << name << " is " << Stat(name) << " instead of " << wanted;
  }
  void AddLine(const std::string& line) { lines_.push_back(line); }
  /// Replaces each match of `pattern` in the recorded lines by `word`. This is for text that
  /// differs between runs, such as a port. A line that is empty afterwards is left out.
  void Hide(const std::string& pattern, const std::string& word) {
    hidden_.emplace_back(std::regex(pattern), word);
  }
  void SetCaps(const std::string& caps) {
    trace_->PushCaps(caps);
    Note("caps");
  }
  void Set(const char* property, const char* value) {
    gst_util_set_object_arg(G_OBJECT(element()), property, value);
    Note(std::string("set ") + property + "=" + value);
  }
  void Push(const std::string& what, gst::BufferPtr buffer) {
    CountWhileItLives(buffer.get());
    const GstFlowReturn flow = gst_pad_push(h_->srcpad, buffer.release());
    Note(what + ": " + gst_flow_get_name(flow));
  }
  /// Pushes a buffer, and waits until `count` lines of the trace begin with `line`. Notes the step
  /// as `what`.
  void PushUntil(const std::string& what, gst::BufferPtr buffer, const char* line,
                 std::size_t count = 1) {
    CountWhileItLives(buffer.get());
    EXPECT_EQ(gst_pad_push(h_->srcpad, buffer.release()), GST_FLOW_OK) << what;
    Await(what, line, count);
  }
  void PushEvent(const std::string& what, GstEvent* event) {
    const bool taken = gst_pad_push_event(h_->srcpad, event) != FALSE;
    Note(what + (taken ? "" : ": refused"));
  }
  void PushUpstream(const std::string& what, GstEvent* event) {
    const bool taken = gst_pad_push_event(h_->sinkpad, event) != FALSE;
    Note(what + (taken ? "" : ": refused"));
  }
  void PushSegment(GstFormat format, guint64 start = 0) {
    GstSegment segment;
    gst_segment_init(&segment, format);
    segment.start = segment.time = segment.position = start;
    PushEvent("segment", gst_event_new_segment(&segment));
  }
  void Gap(GstClockTime at, GstClockTime lasts) { PushEvent("gap", gst_event_new_gap(at, lasts)); }
  void Tag() { PushEvent("tag", gst_event_new_tag(gst_tag_list_new_empty())); }
  /// Pushes an event of an unknown type into the element from both sides: downstream and upstream.
  void Unknown() {
    PushEvent("unknown", gst_event_new_custom(GST_EVENT_CUSTOM_DOWNSTREAM,
                                              gst_structure_new_empty("unknown-event")));
    PushUpstream(
        "unknown upstream",
        gst_event_new_custom(GST_EVENT_CUSTOM_UPSTREAM, gst_structure_new_empty("unknown-event")));
  }
  void Flush() {
    trace_->Flush();
    Note("flush");
  }
  void End() { PushEvent("end", gst_event_new_eos()); }
  void Stop() {
    trace_->Stop();
    Note("stop");
  }
  /// Sends queries to the element from downstream, and notes the answers. Duration, position and
  /// seeking are queried in `format`.
  void Ask(GstFormat format = GST_FORMAT_TIME) {
    const gst::QueryPtr latency(gst_query_new_latency());
    if (Answers(latency.get())) {
      const gst::Latency l = gst::ReadLatency(latency.get());
      lines_.push_back("latency " + std::to_string(l.min) + (l.live ? " live" : ""));
    }
    gint64 value = 0;
    const gst::QueryPtr duration(gst_query_new_duration(format));
    if (Answers(duration.get())) {
      gst_query_parse_duration(duration.get(), nullptr, &value);
      lines_.push_back("duration " + std::to_string(value));
    }
    const gst::QueryPtr position(gst_query_new_position(format));
    if (Answers(position.get())) {
      gst_query_parse_position(position.get(), nullptr, &value);
      lines_.push_back("position " + std::to_string(value));
    }
    const gst::QueryPtr seeking(gst_query_new_seeking(format));
    if (Answers(seeking.get())) {
      gboolean seekable = FALSE;
      gint64 start = 0;
      gst_query_parse_seeking(seeking.get(), nullptr, &seekable, &start, &value);
      lines_.push_back((seekable ? "seekable from " : "not seekable from ") +
                       std::to_string(start) + " to " + std::to_string(value));
    }
    Note("asked");
  }
  /// Notes a step, and after it everything that the element has output or posted since the last
  /// step.
  void Note(const std::string& step) {
    lines_.push_back("- " + step);
    for (std::string& line : trace_->Take()) {
      if (line.rfind("stats ", 0) == 0) {
        NoteStats(line);
        continue;
      }
      // These lines do not come from the element itself: an event of the harness, messages about
      // latency from GStreamer's base classes of sources, and the size of the receive buffer, which
      // depends on the machine.
      if (line == "upstream event reconfigure") continue;
      if (h_->sinkpad == nullptr && line.find("latency") != std::string::npos) continue;
      if (line.find("grants a receive buffer") != std::string::npos) continue;
      line = Steady(line);
      // The order of the fields of caps differs between releases of GStreamer.
      if (line.rfind("event caps ", 0) == 0) {
        Lines fields = FieldsOf(line);
        std::sort(fields.begin() + 1, fields.end());
        line = Joined(fields);
      }
      lines_.push_back(std::move(line));
    }
  }
  void Expect(const std::string& path) {
    for (std::string& line : lines_) line = Shown(line);
    lines_.erase(std::remove(lines_.begin(), lines_.end(), ""), lines_.end());
    ExpectGoldenLines(lines_, path);
  }

 private:
  void CountWhileItLives(GstBuffer* buffer) {
    ++buffers_;
    gst_mini_object_weak_ref(
        GST_MINI_OBJECT_CAST(buffer),
        [](gpointer count, GstMiniObject*) { --*static_cast<std::atomic<int>*>(count); },
        &buffers_);
  }
  std::string Shown(std::string line) const {
    for (const auto& [pattern, word] : hidden_) line = std::regex_replace(line, pattern, word);
    return line;
  }
  bool Answers(GstQuery* query) {
    return (h_->sinkpad != nullptr ? gst_pad_peer_query(h_->sinkpad, query)
                                   : gst_element_query(element(), query)) != FALSE;
  }
  /// Removes what differs between runs or machines: durations that are not 0, and arrays of
  /// doubles. Rounds other doubles to three digits. A value halfway between two rounded values is
  /// rounded up, and a tiny value becomes 0.
  static std::string Steady(const std::string& line) {
    static const std::regex kClock(
        "(encode-time|decode-time|scan-time| age)=\\([a-z0-9]+\\)[1-9][0-9]*");
    static const std::regex kDouble("(?:\\(double\\)| pose )([-+.e0-9]+)");
    static const std::regex kDoubles("=\\(double\\)< [^>]*>");
    std::string steady = std::regex_replace(std::regex_replace(line, kClock, "$1"), kDoubles, "");
    std::smatch found;
    std::string rounded;
    while (std::regex_search(steady, found, kDouble)) {
      char text[G_ASCII_DTOSTR_BUF_SIZE];
      const double value = g_ascii_strtod(found[1].str().c_str(), nullptr) * (1 + 1e-9);
      constexpr double kTiny = 1e-6;
      g_ascii_formatd(text, sizeof text, "%.3g", std::abs(value) < kTiny ? 0 : value);
      rounded += found.prefix().str() + (found[0].str()[0] == ' ' ? " pose " : "") + text;
      steady = found.suffix().str();
    }
    return rounded + steady;
  }
  /// Notes the statistics that have changed since the last step. Leaves out the fields of
  /// GStreamer's base classes, because these fields differ between releases.
  void NoteStats(std::string line) {
    for (const char* first : {"scans-sent", "slices-received"})
      if (const std::size_t own = line.find(first); own != std::string::npos)
        line = "stats, " + line.substr(own);
    Lines fields = FieldsOf(Shown(Steady(line)));
    Lines changed = {"stats"};
    for (std::size_t i = 1; i < fields.size(); ++i)
      if (std::find(stats_.begin(), stats_.end(), fields[i]) == stats_.end())
        changed.push_back(fields[i]);
    if (changed.size() > 1) lines_.push_back(Joined(changed));
    stats_ = std::move(fields);
  }
  static Lines FieldsOf(const std::string& line) {
    Lines fields;
    std::size_t begin = 0;
    for (std::size_t end = 0; end != std::string::npos; begin = end + 2) {
      end = line.find(", ", begin);
      fields.push_back(line.substr(begin, end == std::string::npos ? end : end - begin));
    }
    return fields;
  }
  static std::string Joined(const Lines& fields) {
    std::string line;
    for (const std::string& field : fields) line += (line.empty() ? "" : ", ") + field;
    return line;
  }

  std::atomic<int> buffers_{0};  // the number of pushed buffers that still exist
  Harness h_;
  std::optional<RunTrace> trace_;
  Lines lines_;
  // The fields of the statistics after the last step.
  Lines stats_;
  std::vector<std::pair<std::regex, std::string>> hidden_;
};

/// The script of a course. The golden file has the same name as the course.
struct ScriptedCourse {
  std::string name;
  std::string launch;
  std::function<void(Course&)> script;
  CoursePads pads = {};
};

class GoldenCourse : public ::testing::Test {
 public:
  GoldenCourse(ScriptedCourse course, std::string folder, bool with_bytes)
      : course_(std::move(course)), folder_(std::move(folder)), with_bytes_(with_bytes) {}

 private:
  void TestBody() override {
    Course course(course_.launch, course_.pads, with_bytes_);
    course_.script(course);
    course.Expect(folder_ + "/" + course_.name + ".txt");
  }
  const ScriptedCourse course_;
  const std::string folder_;
  const bool with_bytes_;
};

/// Registers a test for each course. Must be called before main(). Returns the number of tests.
inline std::size_t AddGoldenCourses(const char* suite, const std::vector<ScriptedCourse>& courses,
                                    const std::string& folder, bool with_bytes = true) {
  for (const ScriptedCourse& course : courses)
    ::testing::RegisterTest(
        suite, course.name.c_str(), nullptr, nullptr, __FILE__, __LINE__,
        [=]() -> ::testing::Test* { return new GoldenCourse(course, folder, with_bytes); });
  return courses.size();
}

}  // namespace lidar::test
