// SPDX-License-Identifier: LGPL-2.1-or-later
// gst-launch for a pipeline with two webrtcbins that call each other. Does the signalling between
// them.
#include <gst/gst.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "gst/common/refs.h"
#include "src/tools/common/elements.h"
#include "src/tools/common/program.h"

namespace {

using lidar::gst::ElementPtr;
using lidar::gst::MessagePtr;
using lidar::gst::StringPtr;

enum ExitCode { kGood = 0, kFailed = 1, kUsage = 2 };

constexpr double kMostToConnect_s = 60;

struct Options {
  std::string aux;  // auxiliary element for both ends, in gst-launch syntax
  std::string stats;
  std::string address = "127.0.0.1";
  guint port = 0;   // UDP port of the callee; 0: any
  guint relay = 0;  // port of a relay, to which the caller sends instead of `port`; 0: no relay
  double duration_s = 0;
  double interval_s = 1;
  std::vector<std::string> pipeline;
};

struct Call {
  Options options;
  ElementPtr pipeline;
  ElementPtr caller;
  ElementPtr callee;
};

/// A step of the signalling. It runs when a webrtcbin has replied to the request of the step
/// before.
using Step = void (*)(Call*, const GstStructure* reply);

struct Pending {
  Call* call;
  Step step;
};

/// Returns a promise that calls `step` with the reply.
GstPromise* Then(Call* call, Step step) {
  return gst_promise_new_with_change_func(
      [](GstPromise* promise, gpointer data) {
        const auto* pending = static_cast<Pending*>(data);
        const GstStructure* reply = gst_promise_wait(promise) == GST_PROMISE_RESULT_REPLIED
                                        ? gst_promise_get_reply(promise)
                                        : nullptr;
        pending->step(pending->call, reply);
        gst_promise_unref(promise);
      },
      new Pending{call, step}, [](gpointer data) { delete static_cast<Pending*>(data); });
}

void Fail(Call* call, const char* what) {
  GST_ELEMENT_ERROR(call->pipeline.get(), RESOURCE, FAILED, ("%s", what), (nullptr));
}

/// Returns the session description called `name` in a reply, or null if there is none.
gpointer DescriptionIn(const GstStructure* reply, const char* name) {
  const GValue* value = reply != nullptr ? gst_structure_get_value(reply, name) : nullptr;
  return value != nullptr && G_VALUE_HOLDS_BOXED(value) ? g_value_get_boxed(value) : nullptr;
}

/// Sets `description`, which `from` has made, as the local description of `from` and as the remote
/// description of `to`. Need not wait in between, because a webrtcbin runs its tasks in order.
void Exchange(GstElement* from, GstElement* to, gpointer description) {
  g_signal_emit_by_name(from, "set-local-description", description, nullptr);
  g_signal_emit_by_name(to, "set-remote-description", description, nullptr);
}

void OnAnswer(Call* call, const GstStructure* reply) {
  const gpointer answer = DescriptionIn(reply, "answer");
  if (answer == nullptr) return Fail(call, "The callee does not answer the offer.");
  Exchange(call->callee.get(), call->caller.get(), answer);
}

void OnOffer(Call* call, const GstStructure* reply) {
  const gpointer offer = DescriptionIn(reply, "offer");
  if (offer == nullptr) return Fail(call, "The caller has nothing to offer.");
  Exchange(call->caller.get(), call->callee.get(), offer);
  g_signal_emit_by_name(call->callee.get(), "create-answer", nullptr, Then(call, OnAnswer));
}

void OnNegotiationNeeded(GstElement* caller, Call* call) {
  g_signal_emit_by_name(caller, "create-offer", nullptr, Then(call, OnOffer));
}

/// Gives the callee's address to the caller. If there is a relay, gives the relay's port in place
/// of the callee's port.
void OnCandidateOfCallee(GstElement*, guint line, gchar* text, Call* call) {
  std::string candidate = text;
  if (call->options.relay != 0) {
    const std::string host = " " + call->options.address + " ";
    const std::string own = host + std::to_string(call->options.port) + " ";
    const auto at = candidate.find(own);
    if (at == std::string::npos) return;
    candidate.replace(at, own.size(), host + std::to_string(call->options.relay) + " ");
  }
  g_signal_emit_by_name(call->caller.get(), "add-ice-candidate", line, candidate.c_str());
}

/// Gives the caller's address to the callee. Does nothing if there is a relay, because the callee
/// then uses the address from which packets arrive.
void OnCandidateOfCaller(GstElement*, guint line, gchar* text, Call* call) {
  if (call->options.relay == 0)
    g_signal_emit_by_name(call->callee.get(), "add-ice-candidate", line, text);
}

/// Makes the auxiliary element of a sender. This function handles the signal request-aux-sender.
GstElement* OnAuxSender(GstElement* webrtc, GObject*, Call* call) {
  GError* error = nullptr;
  GstElement* aux = gst_parse_launch(call->options.aux.c_str(), &error);
  if (error != nullptr) Fail(call, error->message);
  g_clear_error(&error);
  const StringPtr end(gst_element_get_name(webrtc));
  if (aux != nullptr)
    gst_object_set_name(GST_OBJECT(aux), (end.get() + std::string("-aux")).c_str());
  return aux;
}

/// Restricts ICE to `address`, and to `port` unless it is 0, because other candidates would bypass
/// the relay.
void BindIce(GstElement* webrtc, const std::string& address, guint port) {
  GObject* ice = nullptr;
  g_object_get(webrtc, "ice-agent", &ice, nullptr);
  gboolean added = FALSE;
  g_signal_emit_by_name(ice, "add-local-ip-address", address.c_str(), &added);
  if (port != 0) g_object_set(ice, "min-rtp-port", port, "max-rtp-port", port, nullptr);
  g_object_unref(ice);
}

ElementPtr WebrtcBin(GstElement* pipeline, const char* name) {
  ElementPtr element(gst_bin_get_by_name(GST_BIN(pipeline), name));
  const GstElementFactory* factory = element ? gst_element_get_factory(element.get()) : nullptr;
  if (factory != nullptr && g_strcmp0(GST_OBJECT_NAME(factory), "webrtcbin") == 0) return element;
  std::fprintf(stderr, "The pipeline has no webrtcbin with name=%s.\n", name);
  return nullptr;
}

bool MakePipeline(Call* call) {
  call->pipeline = lidar::tools::ParsePipeline(call->options.pipeline);
  if (!call->pipeline) return false;
  call->caller = WebrtcBin(call->pipeline.get(), "caller");
  call->callee = WebrtcBin(call->pipeline.get(), "callee");
  return call->caller && call->callee;
}

void Connect(Call* call) {
  BindIce(call->caller.get(), call->options.address, 0);
  BindIce(call->callee.get(), call->options.address, call->options.port);
  g_signal_connect(call->caller.get(), "on-negotiation-needed", G_CALLBACK(OnNegotiationNeeded),
                   call);
  g_signal_connect(call->caller.get(), "on-ice-candidate", G_CALLBACK(OnCandidateOfCaller), call);
  g_signal_connect(call->callee.get(), "on-ice-candidate", G_CALLBACK(OnCandidateOfCallee), call);
  if (call->options.aux.empty()) return;
  for (GstElement* end : {call->caller.get(), call->callee.get()})
    g_signal_connect(end, "request-aux-sender", G_CALLBACK(OnAuxSender), call);
}

/// Prints one line of statistics for each element that the options name.
void PrintStats(const Call& call, gint64 start) {
  std::array<char, 32> time{};
  const double elapsed_s = static_cast<double>(g_get_monotonic_time() - start) / 1e6;
  std::snprintf(time.data(), time.size(), "%.1f ", elapsed_s);
  lidar::tools::PrintStats(call.pipeline.get(), call.options.stats, time.data());
}

/// Handles a message of the pipeline. Returns true if the pipeline continues.
bool Handle(GstMessage* message, int* result) {
  if (message == nullptr) return true;
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_EOS) return false;
  std::fprintf(stderr, "%s\n", lidar::tools::MessageText(message).c_str());
  *result = kFailed;
  return false;
}

/// Reads the connection state as text, because its enumeration is in a header of gst-plugins-bad,
/// which the build does not need.
bool IsConnected(GstElement* webrtc) {
  GValue state = G_VALUE_INIT;
  g_object_get_property(G_OBJECT(webrtc), "connection-state", &state);
  const StringPtr name(gst_value_serialize(&state));
  g_value_unset(&state);
  return g_strcmp0(name.get(), "connected") == 0;
}

/// Runs the pipeline until EOS, an error or a signal, or until the duration is over. Prints
/// statistics at intervals.
int Play(const Call& call) {
  bool run = true;
  lidar::tools::StopOnSignals(&run);
  GstBus* bus = gst_element_get_bus(call.pipeline.get());
  gst_element_set_state(call.pipeline.get(), GST_STATE_PLAYING);
  const gint64 start = g_get_monotonic_time();
  const auto interval = static_cast<gint64>(call.options.interval_s * G_TIME_SPAN_SECOND);
  gint64 next = start + interval;
  gint64 connected = 0;
  int result = kGood;
  while (run) {
    g_main_context_iteration(nullptr, FALSE);
    const MessagePtr message(gst_bus_timed_pop_filtered(
        bus, 50 * GST_MSECOND, static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR)));
    run = run && Handle(message.get(), &result);
    const gint64 now = g_get_monotonic_time();
    if (connected == 0 && IsConnected(call.caller.get()) && IsConnected(call.callee.get()))
      connected = now;
    const double since_s = static_cast<double>(now - (connected > 0 ? connected : start)) / 1e6;
    if (connected == 0 && since_s > kMostToConnect_s) {
      std::fprintf(stderr, "The two ends have not connected within %g s.\n", kMostToConnect_s);
      result = kFailed;
      run = false;
    }
    if (connected > 0 && call.options.duration_s > 0 && since_s >= call.options.duration_s)
      run = false;
    if (now < next) continue;
    next += interval;
    PrintStats(call, start);
  }
  PrintStats(call, start);
  gst_element_set_state(call.pipeline.get(), GST_STATE_NULL);
  gst_object_unref(bus);
  return result;
}

void AddOptions(CLI::App* app, Options* o) {
  lidar::tools::AddVersionFlag(app, "lidar-webrtc-launch");
  const auto port = CLI::Range(1U, 65535U);
  app->add_option("--aux", o->aux,
                  "What request-aux-sender of both ends returns; called caller-aux and callee-aux");
  app->add_option("--stats", o->stats, "Elements whose stats are printed, comma-separated");
  app->add_option("--interval", o->interval_s, "Time between prints of --stats [s]")
      ->check(CLI::Range(0.05, 3600.0))
      ->capture_default_str();
  app->add_option("--address", o->address, "Address of both ends")->capture_default_str();
  auto* own = app->add_option("--port", o->port, "UDP port of the callee")->check(port);
  app->add_option("--relay", o->relay,
                  "UDP port of a relay to the callee: the caller knows the callee by it")
      ->check(port)
      ->needs(own);
  app->add_option("--duration", o->duration_s,
                  "How long the call lasts [s]; without it, until Ctrl-C")
      ->check(CLI::Range(0.1, 1e7));
  app->prefix_command();  // the first word that is not an option begins the pipeline
  app->footer("PIPELINE: elements, properties and links, after the options");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Runs a pipeline, written as for gst-launch-1.0, with two webrtcbins: name=caller offers,\n"
      "name=callee answers. Both are in this process, so no server is needed.");
  Call call;
  AddOptions(&app, &call.options);
  lidar::tools::Parse(&app, argc, argv);
  call.options.pipeline = app.remaining();
  gst_init(nullptr, nullptr);
  if (!MakePipeline(&call)) return kUsage;
  Connect(&call);
  const int result = Play(call);
  call.callee.reset();
  call.caller.reset();
  call.pipeline.reset();
  gst_deinit();
  return result;
}
