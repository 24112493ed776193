// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/demo/media_process.h"

#include <glib-unix.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <ctime>
#include <optional>
#include <stdexcept>
#include <utility>

#include "gst/common/buffer_map.h"
#include "gst/lidar/cloud_info.h"

namespace lidar::demo {
namespace {

constexpr int kCloudsFd = 3;
constexpr std::size_t kRecordBacklog = 16U << 20;
constexpr std::size_t kCloudBacklog = 256U << 20;
constexpr guint kDrainMs = 5000;

gst::PadPtr PadOf(GstElement* pipeline, const char* element, const char* pad) {
  const gst::ElementPtr e(gst_bin_get_by_name(GST_BIN(pipeline), element));
  gst::PadPtr p(e ? gst_element_get_static_pad(e.get(), pad) : nullptr);
  if (!p) throw std::runtime_error(std::string("no pad ") + pad + " of an element " + element);
  return p;
}

gboolean CallHandler(gpointer handler) {
  (*static_cast<std::function<void()>*>(handler))();
  return G_SOURCE_CONTINUE;
}

}  // namespace

std::int64_t UnixNow() {
  timespec t{};
  clock_gettime(CLOCK_REALTIME, &t);
  return std::int64_t{t.tv_sec} * 1000000000 + t.tv_nsec;
}

MediaProcess::MediaProcess(const std::string& description)
    : loop_(g_main_loop_new(nullptr, FALSE)),
      records_(STDOUT_FILENO, kRecordBacklog),
      clouds_(kCloudsFd, kCloudBacklog) {
  GError* error = nullptr;
  pipeline_.reset(
      gst_parse_launch_full(description.c_str(), nullptr, GST_PARSE_FLAG_FATAL_ERRORS, &error));
  const gst::ErrorPtr owner(error);
  if (!pipeline_) throw std::runtime_error(error->message);
}

MediaProcess::~MediaProcess() {
  gst_element_set_state(pipeline_.get(), GST_STATE_NULL);
  g_main_loop_unref(loop_);
}

gst::ElementPtr MediaProcess::Find(const char* name) const {
  return gst::ElementPtr(gst_bin_get_by_name(GST_BIN(pipeline_.get()), name));
}

void MediaProcess::OnBuffer(const char* element, const char* pad, BufferHandler handler) {
  gst_pad_add_probe(
      PadOf(pipeline_.get(), element, pad).get(), GST_PAD_PROBE_TYPE_BUFFER,
      [](GstPad* p, GstPadProbeInfo* info, gpointer data) {
        (*static_cast<BufferHandler*>(data))(p, GST_PAD_PROBE_INFO_BUFFER(info));
        return GST_PAD_PROBE_OK;
      },
      new BufferHandler(std::move(handler)),
      [](gpointer data) { delete static_cast<BufferHandler*>(data); });
}

void MediaProcess::OnEvent(const char* element, const char* pad, EventHandler handler) {
  gst_pad_add_probe(
      PadOf(pipeline_.get(), element, pad).get(), GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM,
      [](GstPad*, GstPadProbeInfo* info, gpointer data) {
        (*static_cast<EventHandler*>(data))(GST_PAD_PROBE_INFO_EVENT(info));
        return GST_PAD_PROBE_OK;
      },
      new EventHandler(std::move(handler)),
      [](gpointer data) { delete static_cast<EventHandler*>(data); });
}

void MediaProcess::Every(guint interval_ms, std::function<void()> handler) {
  periodic_.push_back({interval_ms, std::move(handler)});
}

void MediaProcess::Write(const nlohmann::json& record) { records_.Write(record.dump() + '\n'); }

void MediaProcess::Write(const Cloud& cloud) { clouds_.Write(WriteFrame(cloud)); }

std::int64_t MediaProcess::UnixTimeOf(GstPad* pad, GstClockTime pts) const {
  const gst::EventPtr event(gst_pad_get_sticky_event(pad, GST_EVENT_SEGMENT, 0));
  const std::unique_ptr<GstClock, gst::Unref> clock(gst_element_get_clock(pipeline_.get()));
  const std::int64_t now = UnixNow();
  if (!event || !clock) return now;
  const GstSegment* segment = nullptr;
  gst_event_parse_segment(event.get(), &segment);
  const auto running = gst_segment_to_running_time(segment, GST_FORMAT_TIME, pts);
  const auto clock_now = static_cast<std::int64_t>(gst_clock_get_time(clock.get()));
  const auto base = static_cast<std::int64_t>(gst_element_get_base_time(pipeline_.get()));
  return now - (clock_now - (base + static_cast<std::int64_t>(running)));
}

void MediaProcess::HandleError(GstMessage* message) {
  GError* error = nullptr;
  gchar* debug = nullptr;
  gst_message_parse_error(message, &error, &debug);
  const gst::ErrorPtr owner(error);
  const gst::StringPtr debug_owner(debug);
  g_printerr("%s: %s\n%s\n", GST_OBJECT_NAME(GST_MESSAGE_SRC(message)), error->message,
             debug != nullptr ? debug : "");
  exit_code_ = 1;
  g_main_loop_quit(loop_);
}

gboolean MediaProcess::OnMessage(GstBus*, GstMessage* message, gpointer data) {
  auto* self = static_cast<MediaProcess*>(data);
  switch (GST_MESSAGE_TYPE(message)) {
    case GST_MESSAGE_ERROR:
      self->HandleError(message);
      break;
    case GST_MESSAGE_EOS:
      g_main_loop_quit(self->loop_);
      break;
    case GST_MESSAGE_LATENCY:
      gst_bin_recalculate_latency(GST_BIN(self->pipeline_.get()));
      break;
    default:
      break;
  }
  return G_SOURCE_CONTINUE;
}

gboolean MediaProcess::OnSignal(gpointer data) {
  auto* self = static_cast<MediaProcess*>(data);
  if (self->asked_to_stop_) {
    g_main_loop_quit(self->loop_);
    return G_SOURCE_CONTINUE;
  }
  self->asked_to_stop_ = true;
  gst_element_send_event(self->pipeline_.get(), gst_event_new_eos());
  g_timeout_add(
      kDrainMs,
      [](gpointer loop) -> gboolean {
        g_printerr("EOS did not pass the pipeline in time\n");
        g_main_loop_quit(static_cast<GMainLoop*>(loop));
        return G_SOURCE_REMOVE;
      },
      self->loop_);
  return G_SOURCE_CONTINUE;
}

int MediaProcess::Run() {
  GstBus* bus = gst_element_get_bus(pipeline_.get());
  const guint watch = gst_bus_add_watch(bus, OnMessage, this);
  gst_object_unref(bus);
  // The signal handlers stay until the process exits, because a late signal must not interrupt the
  // writing of the last records.
  g_unix_signal_add(SIGINT, OnSignal, this);
  g_unix_signal_add(SIGTERM, OnSignal, this);
  std::vector<guint> sources = {watch};
  for (Periodic& periodic : periodic_)
    sources.push_back(g_timeout_add(periodic.interval_ms, CallHandler, &periodic.handler));
  // Ignores SIGPIPE, because a closed pipe must not kill this process before EOS.
  std::signal(SIGPIPE, SIG_IGN);
  gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING);
  Write(nlohmann::json{{"type", "playing"}, {"unix_ns", UnixNow()}});
  g_main_loop_run(loop_);
  for (const Periodic& periodic : periodic_) periodic.handler();
  for (const guint id : sources) g_source_remove(id);
  gst_element_set_state(pipeline_.get(), GST_STATE_NULL);
  return exit_code_;
}

std::optional<Cloud> ReadCloud(GstPad* pad, GstBuffer* buffer) {
  const gst::CapsPtr caps(gst_pad_get_current_caps(pad));
  const auto info = caps ? gst::CloudInfo::FromCaps(caps.get()) : std::nullopt;
  const gst::BufferMap map(buffer, GST_MAP_READ);
  if (!info || !map || !info->fields.HasPackedXyz() || info->point_step == 0) return {};
  GstLidarSlice slice{};
  gst_lidar_buffer_get_slice(buffer, &slice);
  const gsize points = map.size() / info->point_step;
  Cloud cloud{{slice.scan_id, slice.slice_index}, info->height, 0, {}};
  cloud.width = static_cast<std::uint32_t>(points / std::max(info->height, 1U));
  cloud.xyz.resize(gsize{cloud.width} * cloud.height * 3);
  const std::uint8_t* p = map.data() + info->fields.Find("x")->offset;
  for (std::size_t i = 0; i < cloud.xyz.size(); i += 3, p += info->point_step)
    std::memcpy(&cloud.xyz[i], p, 3 * sizeof(float));
  return cloud;
}

}  // namespace lidar::demo
