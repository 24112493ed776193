// SPDX-License-Identifier: LGPL-2.1-or-later
// One end of the demo. Runs a pipeline, measures it, and writes the results as lines of JSON.
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

/// Returns CLOCK_REALTIME [ns]. Every record contains a time of this clock.
std::int64_t UnixNow();

class MediaProcess {
 public:
  /// Makes the pipeline. If `description` is wrong, throws std::runtime_error with GStreamer's
  /// error text.
  explicit MediaProcess(const std::string& description);
  ~MediaProcess();
  MediaProcess(const MediaProcess&) = delete;
  MediaProcess& operator=(const MediaProcess&) = delete;

  /// Returns the element called `name`, or null if the pipeline has no such element.
  gst::ElementPtr Find(const char* name) const;
  /// OnBuffer() and OnEvent() call `handler` for each buffer, or for each downstream event, that
  /// passes the pad. They call it in the streaming thread.
  using BufferHandler = std::function<void(GstPad*, GstBuffer*)>;
  using EventHandler = std::function<void(GstEvent*)>;
  void OnBuffer(const char* element, const char* pad, BufferHandler handler);
  void OnEvent(const char* element, const char* pad, EventHandler handler);
  /// Calls `handler` in the main loop once per interval, and once more before the pipeline stops.
  void Every(guint interval_ms, std::function<void()> handler);

  /// Writes a record to standard output.
  void Write(const nlohmann::json& record);
  void Write(const Cloud& cloud);
  /// Converts `pts`, which refers to the pipeline's clock, to the time of UnixNow().
  std::int64_t UnixTimeOf(GstPad* pad, GstClockTime pts) const;

  /// Plays until EOS or an error. A signal makes the pipeline send EOS. Returns the exit code of
  /// the program.
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

/// Returns the cloud in a buffer, or nothing if the caps of `pad` do not describe a cloud.
std::optional<Cloud> ReadCloud(GstPad* pad, GstBuffer* buffer);

}  // namespace lidar::demo
