// SPDX-License-Identifier: LGPL-2.1-or-later
// An end of the demo: a pipeline that measures itself and writes JSON lines.
#pragma once
#include <gst/gst.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gst/common/refs.h"
#include "src/tools/bench/demo/cloud_frame.h"
#include "src/tools/common/async_writer.h"

namespace lidar::demo {

/// CLOCK_REALTIME [ns], the time of every record.
std::int64_t UnixNow();

class MediaProcess {
 public:
  /// Parses the description; throws std::runtime_error with GStreamer's error text.
  explicit MediaProcess(const std::string& description);
  ~MediaProcess();
  MediaProcess(const MediaProcess&) = delete;
  MediaProcess& operator=(const MediaProcess&) = delete;

  /// Null if the pipeline has no element of that name.
  gst::ElementPtr Find(const char* name) const;
  /// Calls `handler` for each buffer (or downstream event) that passes the pad, in the streaming
  /// thread.
  using BufferHandler = std::function<void(GstPad*, GstBuffer*)>;
  using EventHandler = std::function<void(GstEvent*)>;
  void OnBuffer(const char* element, const char* pad, BufferHandler handler);
  void OnEvent(const char* element, const char* pad, EventHandler handler);
  /// Calls `handler` at this interval in the main loop, and once more before the pipeline stops.
  void Every(guint interval_ms, std::function<void()> handler);

  /// Writes a record to standard output.
  void Write(const nlohmann::json& record);
  void Write(const Cloud& cloud);
  /// Converts `pts` to UnixNow's time, by the pipeline's clock.
  std::int64_t UnixTimeOf(GstPad* pad, GstClockTime pts) const;

  /// Plays until EOS, an error, or a signal that asks for EOS. Returns the program's exit code.
  int Run();

 private:
  struct Periodic {
    guint interval_ms;
    std::function<void()> handler;
  };
  static gboolean OnMessage(GstBus* bus, GstMessage* message, gpointer self);
  static gboolean OnSignal(gpointer self);
  void HandleError(GstMessage* message);

  gst::ElementPtr pipeline_;
  GMainLoop* loop_;
  std::vector<Periodic> periodic_;
  tools::AsyncWriter records_;
  tools::AsyncWriter clouds_;
  int exit_code_ = 0;
  bool asked_to_stop_ = false;
};

/// Returns the organised cloud of a buffer; nothing if the caps of `pad` are not a cloud's.
std::optional<Cloud> ReadCloud(GstPad* pad, GstBuffer* buffer);

}  // namespace lidar::demo
