// SPDX-License-Identifier: LGPL-2.1-or-later
// An RTSP server with a single stream, which all viewers share.
#include <glib-unix.h>
#include <gst/gst.h>
#include <gst/rtsp-server/rtsp-server.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "src/tools/common/printable.h"
#include "src/tools/common/program.h"

namespace {

constexpr guint kMaxViewers = 32;
constexpr guint kCleanupSeconds = 2;

struct Options {
  std::string address = "127.0.0.1";
  int port = 8554;
  std::string path = "/lidar";
  std::vector<std::string> pipeline;
};

struct Unref {
  void operator()(gpointer object) const { g_object_unref(object); }
};
struct UnrefLoop {
  void operator()(GMainLoop* loop) const { g_main_loop_unref(loop); }
};
template <class Type>
using ObjectPtr = std::unique_ptr<Type, Unref>;

/// Joins the words of a command line. Escapes the blanks within a word, so that the parser does not
/// split the word.
std::string Join(const std::vector<std::string>& words) {
  std::string text = "(";
  for (const std::string& word : words) {
    text += ' ';
    bool quoted = false;
    for (const char c : word) {
      if (c == '"') quoted = !quoted;
      if (c == ' ' && !quoted) text += '\\';
      text += c;
    }
  }
  return text + " )";
}

/// Makes the pipeline once, so that an error in it appears now and not when the first viewer
/// connects.
void Check(const std::string& pipeline) {
  GError* error = nullptr;
  GstElement* bin = gst_parse_launch(pipeline.c_str(), &error);
  const std::string why = error != nullptr ? error->message : "";
  g_clear_error(&error);
  GstElement* payloader =
      bin != nullptr && GST_IS_BIN(bin) ? gst_bin_get_by_name(GST_BIN(bin), "pay0") : nullptr;
  const bool good = payloader != nullptr && why.empty();
  gst_clear_object(&payloader);
  if (bin != nullptr) gst_object_unref(gst_object_ref_sink(bin));
  if (!good)
    throw std::runtime_error(why.empty() ? "the pipeline has no element with name=pay0" : why);
}

/// Returns a factory that makes a single medium, which all viewers share. Without this gen_key(), a
/// viewer whose URL has a query would start another pipeline.
GstRTSPMediaFactory* MakeFactory(const std::string& pipeline) {
  GstRTSPMediaFactory* factory = gst_rtsp_media_factory_new();
  GST_RTSP_MEDIA_FACTORY_GET_CLASS(factory)->gen_key =
      [](GstRTSPMediaFactory*, const GstRTSPUrl*) -> gchar* { return g_strdup(""); };
  gst_rtsp_media_factory_set_launch(factory, pipeline.c_str());
  gst_rtsp_media_factory_set_shared(factory, TRUE);
  return factory;
}

ObjectPtr<GstRTSPServer> MakeServer(const Options& options) {
  const std::string pipeline = Join(options.pipeline);
  Check(pipeline);
  ObjectPtr<GstRTSPServer> server(gst_rtsp_server_new());
  gst_rtsp_server_set_address(server.get(), options.address.c_str());
  gst_rtsp_server_set_service(server.get(), std::to_string(options.port).c_str());
  const ObjectPtr<GstRTSPMountPoints> mounts(gst_rtsp_server_get_mount_points(server.get()));
  gst_rtsp_mount_points_add_factory(mounts.get(), options.path.c_str(), MakeFactory(pipeline));
  const ObjectPtr<GstRTSPSessionPool> pool(gst_rtsp_server_get_session_pool(server.get()));
  gst_rtsp_session_pool_set_max_sessions(pool.get(), kMaxViewers);
  return server;
}

void Serve(const Options& options) {
  const std::unique_ptr<GMainLoop, UnrefLoop> loop(g_main_loop_new(nullptr, FALSE));
  const ObjectPtr<GstRTSPServer> server = MakeServer(options);
  if (gst_rtsp_server_attach(server.get(), nullptr) == 0)
    throw std::runtime_error("cannot listen on " + options.address + ":" +
                             std::to_string(options.port));
  // Removes the sessions of viewers that left without TEARDOWN.
  g_timeout_add_seconds(
      kCleanupSeconds,
      [](gpointer data) -> gboolean {
        const ObjectPtr<GstRTSPSessionPool> pool(
            gst_rtsp_server_get_session_pool(GST_RTSP_SERVER(data)));
        gst_rtsp_session_pool_cleanup(pool.get());
        return G_SOURCE_CONTINUE;
      },
      server.get());
  const auto quit = [](gpointer data) -> gboolean {
    g_main_loop_quit(static_cast<GMainLoop*>(data));
    return G_SOURCE_CONTINUE;
  };
  g_unix_signal_add(SIGINT, quit, loop.get());
  g_unix_signal_add(SIGTERM, quit, loop.get());
  std::printf("rtsp://%s:%d%s\n", lidar::tools::HostInUrl(options.address).c_str(),
              gst_rtsp_server_get_bound_port(server.get()), options.path.c_str());
  std::fflush(stdout);
  g_main_loop_run(loop.get());
}

Options ReadOptions(int argc, char** argv) {
  CLI::App app(
      "Serves a pipeline, written as for gst-launch-1.0, by RTSP. All viewers share it; it runs "
      "while there are any. Prints the address.");
  lidar::tools::AddVersionFlag(&app, "lidar-rtsp-launch");
  Options options;
  app.add_option("--address", options.address, "Local address to listen on")->capture_default_str();
  app.add_option("--port", options.port, "TCP port to listen on; 0: any")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  app.add_option("--path", options.path, "Path in the address of the stream; begins with /")
      ->check(CLI::Validator(
          [](const std::string& path) {
            return path.rfind('/', 0) == 0 ? "" : "\"" + path + "\" does not begin with /";
          },
          "/PATH"))
      ->capture_default_str();
  app.prefix_command();  // the first word that is not an option begins the pipeline
  app.footer(
      "PIPELINE: elements, properties and links, after the options; the last is called pay0");
  lidar::tools::Parse(&app, argc, argv);
  options.pipeline = app.remaining();
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  return lidar::tools::Guard("lidar-rtsp-launch", [&] {
    const Options options = ReadOptions(argc, argv);
    gst_init(nullptr, nullptr);
    Serve(options);
    gst_deinit();  // the leaks tracer reports here
    return 0;
  });
}
