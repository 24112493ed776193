// SPDX-License-Identifier: LGPL-2.1-or-later
#include "scream/srtp_layer.h"

#include <array>
#include <cstring>

#include "common/buffer_map.h"

namespace lidar::gst {
namespace {

struct Cipher {
  const char* name;
  std::size_t key_size;  // master key and salt
  bool authenticates;    // needs no HMAC beside it
};
constexpr std::array<Cipher, 4> kCiphers = {{{"aes-128-icm", 30, false},
                                             {"aes-256-icm", 46, false},
                                             {"aes-128-gcm", 28, true},
                                             {"aes-256-gcm", 44, true}}};
constexpr std::size_t kMaxStreams = 64;
// Losses long enough to lose count of a rollover look like this.
constexpr unsigned kFailuresUntilLost = 500;
constexpr std::uint32_t kMaxRollover = 100'000;  // months
constexpr unsigned kFailuresUntilWarning = 20;

const Cipher* FindCipher(const std::string& name) {
  for (const Cipher& c : kCiphers)
    if (name == c.name) return &c;
  return nullptr;
}

bool ReadText(const std::string& source, std::string* text, std::string* error) {
  if (source.rfind("env:", 0) == 0) {
    const gchar* value = g_getenv(source.c_str() + 4);
    if (value == nullptr) {
      *error = "the environment has no variable " + source.substr(4);
      return false;
    }
    *text = value;
  } else if (source.rfind("file:", 0) == 0) {
    gchar* content = nullptr;
    GError* problem = nullptr;
    if (!g_file_get_contents(source.c_str() + 5, &content, nullptr, &problem)) {
      *error = problem->message;
      g_error_free(problem);
      return false;
    }
    *text = content;
    g_free(content);
  } else {
    *text = source;
  }
  while (!text->empty() && g_ascii_isspace(text->back())) text->pop_back();
  return true;
}

PadPtr PadOf(GstElement* element, const char* name) {
  return PadPtr(gst_element_get_static_pad(element, name));
}

/// Takes what `source` gives and chains it into the pad that is its private data. Both ends are of
/// one streaming thread, so order is kept and no queue is needed.
GstFlowReturn RelayChain(GstPad* pad, GstObject*, GstBuffer* buffer) {
  return gst_pad_chain(GST_PAD(gst_pad_get_element_private(pad)), buffer);
}

PadPtr NewRelay(const char* name, GstPad* target) {
  PadPtr pad(GST_PAD(gst_object_ref_sink(gst_pad_new(name, GST_PAD_SINK))));
  gst_pad_set_element_private(pad.get(), target);
  gst_pad_set_chain_function(pad.get(), RelayChain);
  gst_pad_set_event_function(pad.get(), [](GstPad*, GstObject*, GstEvent* event) -> gboolean {
    gst_event_unref(event);  // the target has its own
    return TRUE;
  });
  gst_pad_set_active(pad.get(), TRUE);
  return pad;
}

/// Gives the decoder one buffer at a time, and one that is its own: it decodes in place, and with
/// the buffers of a list, which others hold too, it frees what it does not own.
PadPtr NewEntry(GstPad* target) {
  PadPtr pad = NewRelay("entry", target);
  gst_pad_set_chain_function(pad.get(), [](GstPad* p, GstObject*, GstBuffer* buffer) {
    GstBuffer* own = gst_buffer_copy_deep(buffer);
    gst_buffer_unref(buffer);
    return gst_pad_chain(GST_PAD(gst_pad_get_element_private(p)), own);
  });
  gst_pad_set_event_function(pad.get(), [](GstPad* p, GstObject*, GstEvent* event) {
    return gst_pad_send_event(GST_PAD(gst_pad_get_element_private(p)), event);
  });
  return pad;
}

bool IsRtcp(GstBuffer* buffer) {
  guint8 head[2] = {0, 0};
  return gst_buffer_extract(buffer, 0, head, 2) == 2 && head[1] >= 192 && head[1] <= 223;
}

}  // namespace

std::optional<std::vector<std::uint8_t>> ReadSrtpKey(const SrtpSettings& settings,
                                                     std::string* error) {
  const Cipher* cipher = FindCipher(settings.cipher);
  if (cipher == nullptr) {
    *error = "srtp-cipher is none of aes-128-icm, aes-256-icm, aes-128-gcm, aes-256-gcm";
    return std::nullopt;
  }
  if (settings.auth != "hmac-sha1-80" && settings.auth != "hmac-sha1-32") {
    *error = "srtp-auth is neither hmac-sha1-80 nor hmac-sha1-32";
    return std::nullopt;
  }
  std::string text;
  if (!ReadText(settings.key, &text, error)) return std::nullopt;
  std::vector<std::uint8_t> key;
  bool hex = text.size() == 2 * cipher->key_size;
  for (std::size_t i = 0; hex && i < text.size(); i += 2) {
    const int high = g_ascii_xdigit_value(text[i]);
    const int low = g_ascii_xdigit_value(text[i + 1]);
    hex = high >= 0 && low >= 0;
    key.push_back(static_cast<std::uint8_t>(high << 4 | low));
  }
  if (hex) return key;
  // Never the key itself: errors end in logs.
  *error = "the SRTP key must be " + std::to_string(2 * cipher->key_size) +
           " hexadecimal digits (master key and salt) for " + settings.cipher;
  return std::nullopt;
}

SrtpLayer::SrtpLayer(const SrtpSettings& settings, const SrtpLinks& links,
                     std::vector<std::uint8_t> key)
    : settings_(settings), links_(links), key_(std::move(key)) {}

std::unique_ptr<SrtpLayer> SrtpLayer::Create(const SrtpSettings& settings, const SrtpLinks& links,
                                             std::string* error) {
  auto key = ReadSrtpKey(settings, error);
  if (!key) return nullptr;
  std::unique_ptr<SrtpLayer> layer(new SrtpLayer(settings, links, *std::move(key)));
  if (!layer->MakeElements(error)) return nullptr;
  if (layer->LinkOut() && layer->LinkIn()) return layer;
  *error = "the elements of the srtp plugin cannot be linked";
  return nullptr;
}

bool SrtpLayer::MakeElements(std::string* error) {
  enc_ = gst_element_factory_make("srtpenc", nullptr);
  dec_ = gst_element_factory_make("srtpdec", nullptr);
  for (GstElement* element : {enc_, dec_})
    if (element != nullptr) gst_bin_add(GST_BIN(links_.bin), element);
  if (enc_ == nullptr || dec_ == nullptr) {
    *error = "the srtp plugin is missing; install gstreamer1.0-plugins-bad";
    return false;
  }
  const char* auth = FindCipher(settings_.cipher)->authenticates ? "null" : settings_.auth.c_str();
  for (const char* name : {"rtp-cipher", "rtcp-cipher"})
    gst_util_set_object_arg(G_OBJECT(enc_), name, settings_.cipher.c_str());
  gst_util_set_object_arg(G_OBJECT(enc_), "rtp-auth", auth);
  // RFC 3711 has no short tag for SRTCP.
  gst_util_set_object_arg(G_OBJECT(enc_), "rtcp-auth",
                          strcmp(auth, "null") == 0 ? auth : "hmac-sha1-80");
  const BufferPtr key(gst_buffer_new_memdup(key_.data(), key_.size()));
  g_object_set(enc_, "key", key.get(), "allow-repeat-tx", FALSE, nullptr);
  g_signal_connect(dec_, "request-key",
                   G_CALLBACK(+[](GstElement*, guint ssrc, gpointer self) -> GstCaps* {
                     return static_cast<SrtpLayer*>(self)->KeyFor(ssrc);
                   }),
                   this);
  return true;
}

bool SrtpLayer::LinkOut() {
  const PadPtr source = PadOf(links_.sender, links_.out);
  const PadPtr socket = PadOf(links_.socket_sink, "sink");
  gst_pad_unlink(source.get(), socket.get());
  const PadPtr rtcp_in(gst_element_request_pad_simple(enc_, "rtcp_sink_0"));
  const PadPtr rtcp_out = PadOf(enc_, "rtcp_src_0");
  if (!links_.sends_media) {
    return gst_pad_link(source.get(), rtcp_in.get()) == GST_PAD_LINK_OK &&
           gst_pad_link(rtcp_out.get(), socket.get()) == GST_PAD_LINK_OK;
  }
  const PadPtr rtp_in(gst_element_request_pad_simple(enc_, "rtp_sink_0"));
  const PadPtr rtp_out = PadOf(enc_, "rtp_src_0");
  out_relay_ = NewRelay("srtcp", socket.get());
  out_rtcp_.reset(GST_PAD(gst_object_ref_sink(gst_pad_new("rtcp", GST_PAD_SRC))));
  gst_pad_set_active(out_rtcp_.get(), TRUE);
  // screamtx says goodbye with RTCP among its RTP.
  out_probe_ = gst_pad_add_probe(
      source.get(), GST_PAD_PROBE_TYPE_BUFFER,
      [](GstPad* pad, GstPadProbeInfo* info, gpointer data) {
        GstBuffer* buffer = GST_PAD_PROBE_INFO_BUFFER(info);
        auto* self = static_cast<SrtpLayer*>(data);
        if (!IsRtcp(buffer) || !self->out_rtcp_) return GST_PAD_PROBE_OK;
        GstPad* rtcp = self->out_rtcp_.get();
        GstSegment segment;
        gst_segment_init(&segment, GST_FORMAT_TIME);
        const CapsPtr caps(gst_caps_new_empty_simple("application/x-rtcp"));
        gst_pad_push_event(rtcp, gst_event_new_stream_start(GST_PAD_NAME(pad)));
        gst_pad_push_event(rtcp, gst_event_new_caps(caps.get()));
        gst_pad_push_event(rtcp, gst_event_new_segment(&segment));
        info->data = nullptr;
        gst_pad_push(rtcp, buffer);
        return GST_PAD_PROBE_HANDLED;
      },
      this, nullptr);
  return gst_pad_link(source.get(), rtp_in.get()) == GST_PAD_LINK_OK &&
         gst_pad_link(rtp_out.get(), socket.get()) == GST_PAD_LINK_OK &&
         gst_pad_link(out_rtcp_.get(), rtcp_in.get()) == GST_PAD_LINK_OK &&
         gst_pad_link(rtcp_out.get(), out_relay_.get()) == GST_PAD_LINK_OK;
}

bool SrtpLayer::LinkIn() {
  const PadPtr socket = PadOf(links_.socket_source, "src");
  const PadPtr target = PadOf(links_.sender, links_.in);
  gst_pad_unlink(socket.get(), target.get());
  const PadPtr sink = PadOf(dec_, links_.sends_media ? "rtcp_sink" : "rtp_sink");
  gst_pad_add_probe(
      sink.get(), GST_PAD_PROBE_TYPE_BUFFER,
      [](GstPad*, GstPadProbeInfo* info, gpointer self) {
        static_cast<SrtpLayer*>(self)->OnDatagram(GST_PAD_PROBE_INFO_BUFFER(info));
        return GST_PAD_PROBE_OK;
      },
      this, nullptr);
  for (const char* name : {"rtp_src", "rtcp_src"}) {
    gst_pad_add_probe(
        PadOf(dec_, name).get(),
        static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_BUFFER_LIST),
        [](GstPad*, GstPadProbeInfo*, gpointer self) {
          static_cast<SrtpLayer*>(self)->OnPassed();
          return GST_PAD_PROBE_OK;
        },
        this, nullptr);
  }
  in_entry_ = NewEntry(sink.get());
  if (links_.sends_media) {
    return gst_pad_link(socket.get(), in_entry_.get()) == GST_PAD_LINK_OK &&
           gst_pad_link(PadOf(dec_, "rtcp_src").get(), target.get()) == GST_PAD_LINK_OK;
  }
  in_relay_ = NewRelay("rtcp", target.get());
  return gst_pad_link(socket.get(), in_entry_.get()) == GST_PAD_LINK_OK &&
         gst_pad_link(PadOf(dec_, "rtp_src").get(), target.get()) == GST_PAD_LINK_OK &&
         gst_pad_link(PadOf(dec_, "rtcp_src").get(), in_relay_.get()) == GST_PAD_LINK_OK;
}

SrtpLayer::~SrtpLayer() {
  if (out_probe_ != 0) gst_pad_remove_probe(PadOf(links_.sender, links_.out).get(), out_probe_);
  for (GstElement* element : {enc_, dec_}) {
    if (element == nullptr) continue;
    gst_element_set_state(element, GST_STATE_NULL);
    gst_bin_remove(GST_BIN(links_.bin), element);  // unlinks its pads
  }
  if (in_entry_) gst_pad_unlink(PadOf(links_.socket_source, "src").get(), in_entry_.get());
  for (const PadPtr* pad : {&out_rtcp_, &out_relay_, &in_entry_, &in_relay_})
    if (*pad) gst_pad_set_active(pad->get(), FALSE);
  gst_element_link_pads(links_.sender, links_.out, links_.socket_sink, "sink");
  gst_element_link_pads(links_.socket_source, "src", links_.sender, links_.in);
}

unsigned SrtpLayer::overhead() const {
  if (FindCipher(settings_.cipher)->authenticates) return 16;
  return settings_.auth == "hmac-sha1-32" ? 4 : 10;
}

SrtpCounts SrtpLayer::counts() const {
  std::lock_guard lock(mutex_);
  return counts_;
}

GstCaps* SrtpLayer::KeyFor(std::uint32_t ssrc) {
  const char* auth = FindCipher(settings_.cipher)->authenticates ? "null" : settings_.auth.c_str();
  const char* rtcp_auth = strcmp(auth, "null") == 0 ? auth : "hmac-sha1-80";
  const BufferPtr key(gst_buffer_new_memdup(key_.data(), key_.size()));
  std::lock_guard lock(mutex_);
  return gst_caps_new_simple("application/x-srtp", "srtp-key", GST_TYPE_BUFFER, key.get(),
                             "srtp-cipher", G_TYPE_STRING, settings_.cipher.c_str(), "srtp-auth",
                             G_TYPE_STRING, auth, "srtcp-cipher", G_TYPE_STRING,
                             settings_.cipher.c_str(), "srtcp-auth", G_TYPE_STRING, rtcp_auth,
                             "roc", G_TYPE_UINT, streams_[ssrc].rollover, nullptr);
}

void SrtpLayer::OnDatagram(GstBuffer* buffer) {
  guint8 head[12] = {};
  const gsize size = gst_buffer_extract(buffer, 0, head, sizeof head);
  std::unique_lock lock(mutex_);
  ++counts_.received;
  const bool refused = undecided_.has_value();
  if (refused) OnRefused(&lock);
  if (!lock.owns_lock()) lock.lock();
  const gsize at = links_.sends_media || IsRtcp(buffer) ? 4 : 8;  // RTCP, RTP
  undecided_ = size >= at + 4 ? GST_READ_UINT32_BE(head + at) : 0;
  // Garbage must not fill the memory with streams that do not exist.
  if (streams_.size() > kMaxStreams) {
    for (auto it = streams_.begin(); it != streams_.end();)
      it = it->second.known ? std::next(it) : streams_.erase(it);
  }
}

void SrtpLayer::OnPassed() {
  std::lock_guard lock(mutex_);
  if (!undecided_) return;
  Stream& stream = streams_[*undecided_];
  stream.known = true;
  stream.failures = 0;
  undecided_.reset();
}

/// The datagram before this one did not come out of the decoder.
void SrtpLayer::OnRefused(std::unique_lock<std::mutex>* lock) {
  ++counts_.refused;
  const std::uint32_t ssrc = *undecided_;
  undecided_.reset();
  Stream& stream = streams_[ssrc];
  ++stream.failures;
  const bool warn = !warned_ && !stream.known && counts_.refused >= kFailuresUntilWarning;
  warned_ = warned_ || warn;
  const bool lost = stream.known && stream.failures >= kFailuresUntilLost;
  const bool search = !links_.sends_media && (!stream.known || lost);
  if (search) {
    stream.known = false;
    stream.rollover = lost ? 0 : (stream.rollover + 1) % kMaxRollover;
  }
  lock->unlock();
  if (search) g_signal_emit_by_name(dec_, "remove-key", ssrc);
  if (!warn) return;
  GST_ELEMENT_WARNING(links_.bin, STREAM, DECRYPT,
                      ("Packets arrive that do not fit the SRTP key, and are dropped."),
                      ("check that both ends have the same srtp-key, srtp-cipher and srtp-auth; "
                       "this is said once, the property stats counts them"));
}

}  // namespace lidar::gst
