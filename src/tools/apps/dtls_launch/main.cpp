// SPDX-License-Identifier: LGPL-2.1-or-later
// gst-launch for pipelines with DTLS-SRTP. Accepts exactly one certificate of a peer.
#include <gst/gst.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "gst/common/certificates.h"
#include "gst/common/refs.h"
#include "src/tools/common/elements.h"
#include "src/tools/common/program.h"

namespace {

using lidar::gst::CertificateIn;
using lidar::gst::Certificates;
using lidar::gst::ElementPtr;
using lidar::gst::MessagePtr;
using lidar::gst::StringPtr;

enum ExitCode { kGood = 0, kFailed = 1, kUsage = 2, kRefused = 3 };

struct Options {
  std::string certificate;
  std::string peer_certificate;
  std::string stats;
  double duration_s = 0;
  std::vector<std::string> pipeline;
};

/// A pipeline that makes one handshake, and the result of this handshake. Threads of the pipeline
/// set the flags.
struct Session {
  explicit Session(const Certificates& c) : certificates(c) {}
  ~Session() {
    if (pipeline) gst_element_set_state(pipeline.get(), GST_STATE_NULL);
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  const Certificates& certificates;
  unsigned dtls_elements = 0;
  std::atomic<bool> refused{false};
  std::atomic<bool> has_keys{false};
  ElementPtr pipeline;
};

constexpr GstClockTime kPoll = 100 * GST_MSECOND;
// The pause between two handshakes. It limits how often forged packets can restart the pipeline.
constexpr gulong kPauseUs = 200'000;

/// Sets `refused` if the peer's certificate is not the trusted one. The certificate arrives before
/// the keys do, and no packet passes after `refused` is set.
void OnPeerCertificate(GObject* dtls, GParamSpec*, Session* session) {
  gchar* pem = nullptr;
  g_object_get(dtls, "peer-pem", &pem, nullptr);
  const StringPtr owner(pem);
  if (pem == nullptr || CertificateIn(pem) != session->certificates.peer) session->refused = true;
}

/// Drops all packets once `refused` is set. These are the rest of the handshake, and data that are
/// encrypted with its keys.
void DropOnceRefused(GstElement* decoder, Session* session) {
  GstPad* pad = gst_element_get_static_pad(decoder, "sink");
  gst_pad_add_probe(
      pad, static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_BUFFER_LIST),
      [](GstPad*, GstPadProbeInfo*, gpointer data) {
        return static_cast<Session*>(data)->refused ? GST_PAD_PROBE_DROP : GST_PAD_PROBE_OK;
      },
      session, nullptr);
  gst_object_unref(pad);
}

/// Holds packets back until the handshake has set a key, because srtpenc would otherwise encrypt
/// them with a random key.
void HoldUntilThereIsAKey(GstElement* encoder, Session* session) {
  g_object_set_data(G_OBJECT(encoder), "session", session);
  GstIterator* pads = gst_element_iterate_sink_pads(encoder);
  gst_iterator_foreach(
      pads,
      [](const GValue* value, gpointer data) {
        auto* pad = GST_PAD(g_value_get_object(value));
        const gulong probe = gst_pad_add_probe(
            pad,
            static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BLOCK | GST_PAD_PROBE_TYPE_BUFFER |
                                         GST_PAD_PROBE_TYPE_BUFFER_LIST),
            [](GstPad*, GstPadProbeInfo*, gpointer) { return GST_PAD_PROBE_OK; }, nullptr, nullptr);
        g_object_set_data(G_OBJECT(pad), "hold", GSIZE_TO_POINTER(probe));
        g_signal_connect_object(
            data, "on-key-set", G_CALLBACK(+[](GstPad* held, GstElement* has_key) {
              const auto* of =
                  static_cast<Session*>(g_object_get_data(G_OBJECT(has_key), "session"));
              if (of->refused) return;
              const auto id = GPOINTER_TO_SIZE(g_object_steal_data(G_OBJECT(held), "hold"));
              if (id != 0) gst_pad_remove_probe(held, id);
            }),
            pad, G_CONNECT_SWAPPED);
      },
      encoder);
  gst_iterator_free(pads);
}

void Prepare(const GValue* value, gpointer data) {
  auto* session = static_cast<Session*>(data);
  auto* element = GST_ELEMENT(g_value_get_object(value));
  const GstElementFactory* factory = gst_element_get_factory(element);
  const std::string name = factory != nullptr ? GST_OBJECT_NAME(factory) : "";
  if (name == "dtlsdec") {
    ++session->dtls_elements;
    g_object_set(element, "pem", session->certificates.own.c_str(), nullptr);
    g_signal_connect(element, "notify::peer-pem", G_CALLBACK(OnPeerCertificate), session);
    g_signal_connect_swapped(element, "on-key-received",
                             G_CALLBACK(+[](Session* s) { s->has_keys = !s->refused; }), session);
  }
  if (name == "dtlssrtpdec") DropOnceRefused(element, session);
  if (name == "dtlssrtpenc") HoldUntilThereIsAKey(element, session);
}

bool MakePipeline(const std::vector<std::string>& words, Session* session) {
  session->pipeline = lidar::tools::ParsePipeline(words);
  if (!session->pipeline) return false;
  GstIterator* elements = gst_bin_iterate_recurse(GST_BIN(session->pipeline.get()));
  gst_iterator_foreach(elements, Prepare, session);
  gst_iterator_free(elements);
  if (session->dtls_elements > 0) return true;
  std::fprintf(stderr,
               "The pipeline has no dtlssrtpdec; use gst-launch-1.0 for other pipelines.\n");
  return false;
}

/// Returns true if the object is a DTLS element, or if it is inside of one.
bool IsOfDtls(GstObject* source) {
  for (GstObject* o = source; o != nullptr; o = GST_OBJECT_PARENT(o)) {
    const GstElementFactory* factory =
        GST_IS_ELEMENT(o) ? gst_element_get_factory(GST_ELEMENT(o)) : nullptr;
    if (factory != nullptr && g_str_has_prefix(GST_OBJECT_NAME(factory), "dtls")) return true;
  }
  return false;
}

enum class End { kOver, kFailed, kNoHandshake };

/// Plays until EOS or an error, until a certificate is refused, or until `*run` is false. If
/// `duration_s` is not 0, it limits the time after the keys were received. EOS does not pass
/// through dtlssrtpenc, because the part of it that makes the handshake never sends EOS.
End Play(Session* session, double duration_s, const bool* run, std::string* why) {
  GstBus* bus = GST_ELEMENT_BUS(session->pipeline.get());
  gst_element_set_state(session->pipeline.get(), GST_STATE_PLAYING);
  gint64 end = G_MAXINT64;
  while (*run && !session->refused && g_get_monotonic_time() < end) {
    g_main_context_iteration(nullptr, FALSE);
    if (duration_s > 0 && end == G_MAXINT64 && session->has_keys)
      end = g_get_monotonic_time() + static_cast<gint64>(duration_s * G_TIME_SPAN_SECOND);
    const MessagePtr message(gst_bus_timed_pop_filtered(
        bus, kPoll, static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR)));
    if (!message) continue;
    if (GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_EOS) return End::kOver;
    if (session->refused) break;
    if (IsOfDtls(GST_MESSAGE_SRC(message.get()))) {
      // Leaves out the name of the element: automatic names have another number in each session.
      *why = "The handshake failed: " + lidar::tools::ErrorText(message.get());
      return End::kNoHandshake;
    }
    *why = lidar::tools::MessageText(message.get());
    return End::kFailed;
  }
  *why = "REFUSED: the peer's certificate is not the one to trust.";
  return session->refused ? End::kNoHandshake : End::kOver;
}

/// Runs one session after another, so that forged packets can end a handshake but not the program.
class Sessions {
 public:
  Sessions(const Options& options, const Certificates& certificates)
      : options_(options), certificates_(certificates) {
    lidar::tools::StopOnSignals(&run_);
  }

  int Run() {
    while (true) {
      Session session(certificates_);
      if (!MakePipeline(options_.pipeline, &session)) return kUsage;
      std::string why;
      const End end = Play(&session, options_.duration_s, &run_, &why);
      refused_ = refused_ || session.refused;
      if (session.has_keys) had_keys_ = true;
      if (end == End::kNoHandshake) {
        Tell(session, why);
      } else {
        lidar::tools::PrintStats(session.pipeline.get(), options_.stats);
        if (end == End::kOver) return Result();
        std::fprintf(stderr, "%s\n", why.c_str());
        return kFailed;
      }
      g_usleep(kPauseUs);
    }
  }

 private:
  /// Prints `why` unless it is the same as the last time, so that forged packets cannot fill a log.
  void Tell(const Session& session, const std::string& why) {
    if (session.has_keys) told_.clear();
    if (std::exchange(told_, why) == why) return;
    std::fprintf(stderr, "%s Waiting for another handshake.\n", why.c_str());
    std::fflush(stderr);
  }

  int Result() const {
    if (had_keys_) return kGood;
    if (refused_) return kRefused;
    std::fprintf(stderr, "No handshake was completed: is the other end running?\n");
    return kFailed;
  }

  const Options& options_;
  const Certificates& certificates_;
  bool run_ = true;
  bool refused_ = false;
  bool had_keys_ = false;
  std::string told_;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Runs a pipeline, written as for gst-launch-1.0. Its dtlssrtpdec and dtlssrtpenc use our "
      "certificate and trust one of the peer.\n"
      "A peer with another certificate is refused before there are keys, and the program waits for "
      "the next handshake. It exits with 3 if it refused all peers.");
  lidar::tools::AddVersionFlag(&app, "lidar-dtls-launch");
  Options options;
  app.add_option("--certificate", options.certificate, "Our certificate and private key, PEM")
      ->required();
  app.add_option("--peer-certificate", options.peer_certificate, "The peer's certificate, PEM")
      ->required();
  app.add_option("--stats", options.stats,
                 "Elements whose stats are printed at the end, comma-separated");
  app.add_option("--duration", options.duration_s,
                 "Time to play after the handshake [s]; default: until Ctrl-C")
      ->check(CLI::Range(0.1, 1e7));
  app.prefix_command();  // the first word that is not an option begins the pipeline
  app.footer("PIPELINE: elements, properties and links, after the options");
  lidar::tools::Parse(&app, argc, argv);
  options.pipeline = app.remaining();
  Certificates certificates;
  std::string error;
  if (!lidar::gst::ReadCertificates(options.certificate, options.peer_certificate, &certificates,
                                    &error)) {
    std::fprintf(stderr, "%s.\n", error.c_str());
    return kUsage;
  }
  gst_init(nullptr, nullptr);
  const int result = Sessions(options, certificates).Run();
  gst_deinit();
  return result;
}
