// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/scream_bench/pipeline.h"

#include <glib-unix.h>

#include <iostream>
#include <memory>
#include <stdexcept>

namespace lidar::tools {
namespace {

struct MainLoopUnref {
  void operator()(GMainLoop* loop) const { g_main_loop_unref(loop); }
};

struct Runner {
  std::string program;
  GstElement* pipeline;
  Duration duration;
  const std::function<void()>* tick;
  const std::function<void()>* end;
  std::unique_ptr<GMainLoop, MainLoopUnref> loop{g_main_loop_new(nullptr, FALSE)};
  bool has_played = false;
  bool ending = false;
  int result = 0;
};

/// Ends the run. The first call lets the queues drain, and a second call stops at once.
void End(Runner* runner) {
  if (runner->ending) {
    g_main_loop_quit(runner->loop.get());
    return;
  }
  runner->ending = true;
  (*runner->end)();
  constexpr guint kDrainMs = 1000;
  g_timeout_add(
      kDrainMs,
      [](gpointer data) -> gboolean {
        g_main_loop_quit(static_cast<Runner*>(data)->loop.get());
        return G_SOURCE_REMOVE;
      },
      runner);
}

gboolean OnTick(gpointer data) {
  auto* runner = static_cast<Runner*>(data);
  if (!runner->has_played) {
    GstState state = GST_STATE_NULL;
    gst_element_get_state(runner->pipeline, &state, nullptr, 0);
    if (state != GST_STATE_PLAYING) return G_SOURCE_CONTINUE;
    runner->has_played = true;
    if (runner->duration < Duration::max()) {
      g_timeout_add(
          static_cast<guint>(Milliseconds(runner->duration)),
          [](gpointer end) -> gboolean {
            End(static_cast<Runner*>(end));
            return G_SOURCE_REMOVE;
          },
          runner);
    }
  }
  (*runner->tick)();
  return G_SOURCE_CONTINUE;
}

gboolean OnMessage(GstBus*, GstMessage* message, gpointer data) {
  auto* runner = static_cast<Runner*>(data);
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_EOS) {
    g_main_loop_quit(runner->loop.get());
  } else if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) {
    std::cerr << runner->program << ": " << MessageText(message) << '\n';
    runner->result = 1;
    g_main_loop_quit(runner->loop.get());
  }
  return G_SOURCE_CONTINUE;
}

}  // namespace

void LinkPads(GstElement* from, const char* from_pad, GstElement* to, const char* to_pad) {
  if (!gst_element_link_pads(from, from_pad, to, to_pad))
    throw std::runtime_error(std::string("cannot link ") + GST_ELEMENT_NAME(from) + " to " +
                             GST_ELEMENT_NAME(to));
}

int RunPipeline(GstElement* pipeline, const std::string& program, Duration duration,
                const std::function<void()>& every_100_ms, const std::function<void()>& end) {
  Runner runner{program, pipeline, duration, &every_100_ms, &end};
  GstBus* bus = gst_element_get_bus(pipeline);
  const guint watch = gst_bus_add_watch(bus, OnMessage, &runner);
  gst_object_unref(bus);
  const auto on_signal = [](gpointer data) -> gboolean {
    End(static_cast<Runner*>(data));
    return G_SOURCE_CONTINUE;
  };
  const guint interrupt = g_unix_signal_add(SIGINT, on_signal, &runner);
  const guint terminate = g_unix_signal_add(SIGTERM, on_signal, &runner);
  constexpr guint kTickMs = 100;
  const guint tick = g_timeout_add(kTickMs, OnTick, &runner);
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  g_main_loop_run(runner.loop.get());
  for (const guint source : {watch, interrupt, terminate, tick}) g_source_remove(source);
  return runner.result;
}

Duration UnixNow() { return std::chrono::microseconds{g_get_real_time()}; }

}  // namespace lidar::tools
