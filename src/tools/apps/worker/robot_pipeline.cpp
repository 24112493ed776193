// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/apps/worker/robot_pipeline.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "gst/common/buffer_map.h"
#include "src/tools/apps/fleet/connection.h"
#include "src/tools/common/elements.h"
#include "src/tools/common/event_loop.h"

namespace lidar::worker {
namespace {

using fleet::SetConnection;
using tools::MessageText;

GstElement* Add(GstElement* bin, const std::string& factory) {
  return tools::AddElement(bin, factory, factory.c_str());
}

template <std::size_t count>
std::string NumbersText(const std::array<double, count>& numbers) {
  std::string text;
  for (const double value : numbers) {
    char word[32];
    text.append(word, std::to_chars(word, word + sizeof word, value).ptr) += ' ';
  }
  return text;
}

void SetOdometry(GstElement* odometry, const PipelineSettings& settings,
                 const std::optional<Progress>& begin) {
  for (const auto& [name, value] : settings.odometry) {
    GParamSpec* const spec =
        g_object_class_find_property(G_OBJECT_GET_CLASS(odometry), name.c_str());
    if (spec == nullptr) throw std::runtime_error("lidarodometry has no property " + name);
    GValue read = G_VALUE_INIT;
    g_value_init(&read, spec->value_type);
    const bool taken =
        gst_value_deserialize(&read, value.c_str()) && !g_param_value_validate(spec, &read);
    if (taken) g_object_set_property(G_OBJECT(odometry), name.c_str(), &read);
    g_value_unset(&read);
    if (!taken) throw std::runtime_error("lidarodometry does not accept " + name + "=" + value);
  }
  g_object_set(odometry, "post-messages", FALSE, nullptr);
  if (!begin) return;
  g_object_set(odometry, "initial-pose", NumbersText(begin->pose).c_str(), nullptr);
  if (begin->velocity)
    g_object_set(odometry, "initial-velocity", NumbersText(*begin->velocity).c_str(), nullptr);
}

/// Returns `begin` for a pipeline that reads `stream`. If `begin` belongs to another stream,
/// removes its velocity, which is valid only at a scan of that stream.
std::optional<Progress> BeginIn(std::uint64_t stream, std::optional<Progress> begin) {
  if (begin && begin->stream != stream) begin->velocity.reset();
  return begin;
}

}  // namespace

RobotPipeline::RobotPipeline(const PipelineSettings& settings, const std::string& robot,
                             std::uint64_t stream, const std::optional<Progress>& begin)
    : made_at_(tools::Now()),
      stream_(stream),
      begin_(BeginIn(stream, begin)),
      begin_scan_(begin && begin->stream == stream ? begin->scan : 0),
      decoder_(settings.decoder),
      pipeline_(GST_ELEMENT(gst_object_ref_sink(gst_pipeline_new(robot.c_str())))),
      window_(settings.rewind) {
  GstElement* bin = pipeline_.get();
  GstElement* source = Add(bin, "natssrc");
  GstElement* decoder = Add(bin, settings.decoder);
  GstElement* odometry = Add(bin, "lidarodometry");
  GstElement* clouds = Add(bin, "fakesink");
  GstElement* poses = Add(bin, "natssink");
  const auto dot = robot.find('.');
  const std::string begin_of_subject = settings.prefix + "." + robot.substr(0, dot);
  const std::string sensor = robot.substr(dot + 1);
  SetConnection(source, settings.connection);
  SetConnection(poses, settings.connection);
  g_object_set(source, "jetstream", settings.stream.c_str(), "subject",
               (begin_of_subject + ".lidar." + sensor).c_str(), nullptr);
  if (begin_scan_ > 0) g_object_set(source, "start-sequence", begin->from, nullptr);
  g_object_set(poses, "subject", (begin_of_subject + ".odometry." + sensor).c_str(), nullptr);
  SetOdometry(odometry, settings, begin_);
  // A single thread does all the work, so there is only one message in the pipeline at a time.
  for (GstElement* sink : {clouds, poses})
    g_object_set(sink, "sync", FALSE, "async", FALSE, nullptr);
  if (!gst_element_link_many(source, decoder, odometry, clouds, nullptr) ||
      !gst_element_link_pads(odometry, "odometry", poses, "sink"))
    throw std::runtime_error(settings.decoder + " cannot be linked to natssrc and lidarodometry");
  Watch(source, "src", &RobotPipeline::OnMessage);
  Watch(odometry, "sink", &RobotPipeline::OnCloud);
  Watch(odometry, "odometry", &RobotPipeline::OnPose);
}

RobotPipeline::~RobotPipeline() {
  end_ = 0;
  if (start_.valid()) start_.wait();
  gst_element_set_state(pipeline_.get(), GST_STATE_NULL);
}

void RobotPipeline::Watch(GstElement* element, const char* name,
                          GstPadProbeReturn (RobotPipeline::*on_buffer)(GstBuffer*)) {
  using Call = GstPadProbeReturn (RobotPipeline::*)(GstBuffer*);
  struct Target {
    RobotPipeline* self;
    Call call;
  };
  const gst::PadPtr pad(gst_element_get_static_pad(element, name));
  gst_pad_add_probe(
      pad.get(), GST_PAD_PROBE_TYPE_BUFFER,
      [](GstPad*, GstPadProbeInfo* info, gpointer data) {
        const auto* target = static_cast<Target*>(data);
        return (target->self->*target->call)(GST_PAD_PROBE_INFO_BUFFER(info));
      },
      new Target{this, on_buffer}, [](gpointer data) { delete static_cast<Target*>(data); });
}

void RobotPipeline::Play() {
  start_ = std::async(std::launch::async, [pipeline = pipeline_.get()] {
    gst_element_set_state(pipeline, GST_STATE_PLAYING);  // errors appear on the bus
  });
}

GstPadProbeReturn RobotPipeline::OnMessage(GstBuffer* buffer) {
  number_ = GST_BUFFER_OFFSET(buffer);
  const GstClockTime captured = gst_lidar_buffer_get_capture_time(buffer);
  window_.Add({number_, GST_BUFFER_PTS(buffer),
               GST_CLOCK_TIME_IS_VALID(captured) ? std::optional(captured) : std::nullopt});
  return GST_PAD_PROBE_OK;
}

/// Passes on the clouds that odometry needs. Divides the clouds into scans in the same way as
/// lidarodometry.
GstPadProbeReturn RobotPipeline::OnCloud(GstBuffer* buffer) {
  if (number_ < begin_scan_) return GST_PAD_PROBE_DROP;  // only the decoder needs this message
  GstLidarSlice slice{};
  if (!gst_lidar_buffer_get_slice(buffer, &slice) || slice.slice_count == 0) slice = {0, 0, 1, 0};
  // A map that begins with part of a scan would fit the next scan badly.
  if (!begun_ && number_ != begin_scan_ && slice.slice_index > 0) return GST_PAD_PROBE_DROP;
  if (!std::exchange(begun_, true) && begin_scan_ > 0 && number_ > begin_scan_)
    NoteLateBegin(gst_lidar_buffer_get_capture_time(buffer));
  closed_.reset();
  if (!open_ || slice.scan_id != open_->id || slice.slice_index < open_->next_index) {
    closed_ = open_;
    open_ = Scan{slice.scan_id, 0, number_, window_.first()};
  }
  open_->next_index = slice.slice_index + 1;
  return GST_PAD_PROBE_OK;
}

/// Notes that the stream does not contain the scan at whose pose the record ends. Odometry begins
/// at this pose, but with a later scan, so the motion between the two scans is missing.
void RobotPipeline::NoteLateBegin(GstClockTime captured) {
  begun_late_ = true;
  const GstClockTime since = begin_->time;
  late_ns_ = GST_CLOCK_TIME_IS_VALID(captured) ? captured - std::min(since, captured) : 0;
}

/// Records the pose as progress. If the lease has ended, drops the pose instead.
GstPadProbeReturn RobotPipeline::OnPose(GstBuffer* buffer) {
  std::optional<Scan>& scan = closed_ ? closed_ : open_;
  const gst::BufferMap map(buffer, GST_MAP_READ);
  Progress progress;
  std::array<guint64, 7> words{};
  if (tools::Now().time_since_epoch().count() >= end_) dropped_ = true;
  if (!scan || !map || map.size() < sizeof words || dropped_) return GST_PAD_PROBE_DROP;
  std::memcpy(words.data(), map.data(), sizeof words);
  for (std::size_t i = 0; i < words.size(); ++i) {
    words[i] = GUINT64_FROM_LE(words[i]);
    std::memcpy(&progress.pose[i], &words[i], sizeof words[i]);
  }
  const GstClockTime time = gst_lidar_buffer_get_capture_time(buffer);
  progress.time = GST_CLOCK_TIME_IS_VALID(time) ? time : 0;
  progress.scan = scan->first;
  progress.from = scan->from;
  scan.reset();
  // No other worker could continue from this pose.
  if (!ReadsBack(progress)) return GST_PAD_PROBE_OK;
  const std::lock_guard lock(mutex_);
  if (progress_)
    progress.velocity = VelocityBetween(*progress_, progress);
  else if (begin_ && !begun_late_)
    progress.velocity = begin_->velocity;  // this scan is the one of the record
  progress_ = progress;
  return GST_PAD_PROBE_OK;
}

std::optional<Progress> RobotPipeline::progress() const {
  const std::lock_guard lock(mutex_);
  return progress_;
}

void RobotPipeline::AddStats(const std::string& labels, fleet::Exposition* exposition,
                             nlohmann::json* report) const {
  fleet::AddStats(pipeline_.get(), {"natssrc", decoder_, "lidarodometry", "natssink"}, labels,
                  exposition, report);
}

std::string RobotPipeline::Poll() {
  if (const std::uint64_t late = late_ns_.exchange(0))
    std::fprintf(
        stderr,
        "%s: the scan of its last pose cannot be decoded; its poses lack the motion of %.2f s\n",
        GST_OBJECT_NAME(pipeline_.get()), static_cast<double>(late) * 1e-9);
  GstBus* bus = GST_ELEMENT_BUS(pipeline_.get());
  while (const gst::MessagePtr message{gst_bus_pop(bus)}) {
    if (GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_ERROR) return MessageText(message.get());
    if (GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_EOS) return "the stream has ended";
    if (GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_WARNING)
      std::fprintf(stderr, "%s: %s\n", GST_OBJECT_NAME(pipeline_.get()),
                   MessageText(message.get()).c_str());
  }
  return "";
}

}  // namespace lidar::worker
