// SPDX-License-Identifier: LGPL-2.1-or-later
// gst-launch for pipelines with DTLS-SRTP, that trusts one certificate and no other.
#include <gst/gst.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "gst/common/refs.h"
#include "src/tools/common/elements.h"
#include "src/tools/common/program.h"

namespace {

using lidar::gst::ElementPtr;
using lidar::gst::MessagePtr;
using lidar::gst::StringPtr;

enum ExitCode { kGood = 0, kFailed = 1, kUsage = 2, kRefused = 3 };

struct Options {
  std::string certificate;
  std::string peer_certificate;
  std::string stats;
  std::vector<std::string> pipeline;
};

struct Context {
  std::string own;   // certificate and private key, PEM
  std::string peer;  // the certificate to trust, without line breaks
  ElementPtr pipeline;
  unsigned dtls_elements = 0;
};

/// What is between the lines that begin and end the first certificate, without white space.
std::string CertificateIn(const std::string& pem) {
  static const std::string kBegin = "-----BEGIN CERTIFICATE-----";
  const auto begin = pem.find(kBegin);
  const auto end = pem.find("-----END CERTIFICATE-----");
  std::string body;
  if (begin == std::string::npos || end == std::string::npos || end < begin) return body;
  for (std::size_t i = begin + kBegin.size(); i < end; ++i)
    if (!g_ascii_isspace(pem[i])) body += pem[i];
  return body;
}

bool ReadPem(const std::string& path, const char* must_have, std::string* pem) {
  gchar* text = nullptr;
  GError* error = nullptr;
  if (!g_file_get_contents(path.c_str(), &text, nullptr, &error)) {
    std::fprintf(stderr, "%s\n", error->message);
    g_error_free(error);
    return false;
  }
  *pem = text;
  g_free(text);
  if (!CertificateIn(*pem).empty() && pem->find(must_have) != std::string::npos) return true;
  std::fprintf(stderr, "%s is not PEM with a certificate%s.\n", path.c_str(),
               std::string(must_have) == "PRIVATE KEY" ? " and its private key" : "");
  return false;
}

/// Comes in the handshake, before there are keys: with the process everything ends that could
/// send to a stranger or believe one.
void OnPeerCertificate(GObject* dtls, GParamSpec*, Context* context) {
  gchar* pem = nullptr;
  g_object_get(dtls, "peer-pem", &pem, nullptr);
  const StringPtr owner(pem);
  if (pem != nullptr && CertificateIn(pem) == context->peer) return;
  std::fprintf(stderr, "REFUSED: the peer's certificate is not the one to trust.\n");
  std::fflush(nullptr);
  std::_Exit(kRefused);
}

/// srtpenc would encrypt with a random key that nobody knows, until the handshake gives it one.
void HoldUntilThereIsAKey(GstElement* encoder) {
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
        g_signal_connect_object(data, "on-key-set", G_CALLBACK(+[](GstPad* held, GstElement*) {
                                  const auto id =
                                      GPOINTER_TO_SIZE(g_object_steal_data(G_OBJECT(held), "hold"));
                                  if (id != 0) gst_pad_remove_probe(held, id);
                                }),
                                pad, G_CONNECT_SWAPPED);
      },
      encoder);
  gst_iterator_free(pads);
}

void Prepare(const GValue* value, gpointer data) {
  auto* context = static_cast<Context*>(data);
  auto* element = GST_ELEMENT(g_value_get_object(value));
  const GstElementFactory* factory = gst_element_get_factory(element);
  const std::string name = factory != nullptr ? GST_OBJECT_NAME(factory) : "";
  if (name == "dtlsdec") {
    ++context->dtls_elements;
    g_object_set(element, "pem", context->own.c_str(), nullptr);
    g_signal_connect(element, "notify::peer-pem", G_CALLBACK(OnPeerCertificate), context);
  }
  if (name == "dtlssrtpenc") HoldUntilThereIsAKey(element);
}

bool MakePipeline(const std::vector<std::string>& words, Context* context) {
  context->pipeline = lidar::tools::ParsePipeline(words);
  if (!context->pipeline) return false;
  GstIterator* elements = gst_bin_iterate_recurse(GST_BIN(context->pipeline.get()));
  gst_iterator_foreach(elements, Prepare, context);
  gst_iterator_free(elements);
  if (context->dtls_elements > 0) return true;
  std::fprintf(stderr, "The pipeline has no dtlssrtpdec; use gst-launch-1.0 for others.\n");
  return false;
}

/// Until EOS, an error or a signal. EOS does not get past dtlssrtpenc, whose handshake has no end.
int Play(GstElement* pipeline, const std::string& stats) {
  bool run = true;
  lidar::tools::StopOnSignals(&run);
  GstBus* bus = gst_element_get_bus(pipeline);
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  int result = kGood;
  while (run) {
    g_main_context_iteration(nullptr, FALSE);
    const MessagePtr message(gst_bus_timed_pop_filtered(
        bus, 100 * GST_MSECOND, static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR)));
    if (!message) continue;
    run = false;
    if (GST_MESSAGE_TYPE(message.get()) != GST_MESSAGE_ERROR) continue;
    std::fprintf(stderr, "%s\n", lidar::tools::MessageText(message.get()).c_str());
    result = kFailed;
  }
  lidar::tools::PrintStats(pipeline, stats);
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(bus);
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Runs a pipeline, written as for gst-launch-1.0, whose dtlssrtpdec and dtlssrtpenc have a "
      "certificate of ours and trust one of the peer.\n"
      "Ends with 3 where the peer has another one: before there are keys, so nothing was sent.");
  lidar::tools::AddVersionFlag(&app, "lidar-dtls-launch");
  Options options;
  app.add_option("--certificate", options.certificate, "Our certificate and private key, PEM")
      ->required();
  app.add_option("--peer-certificate", options.peer_certificate, "The peer's certificate, PEM")
      ->required();
  app.add_option("--stats", options.stats,
                 "Elements, with commas, whose stats are printed at the end");
  app.prefix_command();  // the first word that is no option begins the pipeline
  app.footer("PIPELINE: elements, properties and links, after the options");
  lidar::tools::Parse(&app, argc, argv);
  options.pipeline = app.remaining();
  Context context;
  std::string peer;
  if (!ReadPem(options.certificate, "PRIVATE KEY", &context.own) ||
      !ReadPem(options.peer_certificate, "CERTIFICATE", &peer))
    return kUsage;
  context.peer = CertificateIn(peer);
  gst_init(nullptr, nullptr);
  if (!MakePipeline(options.pipeline, &context)) return kUsage;
  const int result = Play(context.pipeline.get(), options.stats);
  context.pipeline.reset();
  gst_deinit();
  return result;
}
