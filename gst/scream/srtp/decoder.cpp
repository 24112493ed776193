// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/srtp/decoder.h"

namespace lidar::gst {

namespace {

// The replay window is large, because a sender alternates between its links, and packets are late
// after an outage of their link.
constexpr guint kReplayWindow = 4'096;  // packets

}  // namespace

std::unique_ptr<SrtpDecoder> SrtpDecoder::Create(GstElement* bin, const SrtpPolicy& policy,
                                                 SrtpKey key) {
  GstElement* element = gst_element_factory_make("srtpdec", nullptr);
  if (element == nullptr) return nullptr;
  g_object_set(element, "replay-window-size", kReplayWindow, nullptr);
  gst_element_set_locked_state(element, TRUE);
  gst_bin_add(GST_BIN(bin), element);
  return std::unique_ptr<SrtpDecoder>(new SrtpDecoder(bin, element, policy, std::move(key)));
}

SrtpDecoder::SrtpDecoder(GstElement* bin, GstElement* element, const SrtpPolicy& policy,
                         SrtpKey key)
    : bin_(bin),
      element_(element),
      policy_(policy),
      key_(std::move(key)),
      sink_(gst_element_get_static_pad(element, "rtp_sink")),
      rtp_(element, "rtp_src", [this](BufferPtr packet) { out_ = std::move(packet); }),
      rtcp_(element, "rtcp_src", [this](BufferPtr packet) { out_ = std::move(packet); }) {
  g_signal_connect(element_, "request-key",
                   G_CALLBACK(+[](GstElement*, guint ssrc, gpointer self) -> GstCaps* {
                     return static_cast<SrtpDecoder*>(self)->CapsFor(ssrc);
                   }),
                   this);
  gst_element_set_state(element_, GST_STATE_PLAYING);
}

SrtpDecoder::~SrtpDecoder() {
  gst_element_set_state(element_, GST_STATE_NULL);
  gst_bin_remove(GST_BIN(bin_), element_);  // also unlinks its pads
}

BufferPtr SrtpDecoder::Decode(GstBuffer* datagram) {
  BeginStream(sink_.get(), "application/x-srtp");
  // srtpdec gets a copy, because it uses a shared buffer after it has released its reference.
  gst_pad_chain(sink_.get(), gst_buffer_copy_deep(datagram));
  return std::move(out_);
}

void SrtpDecoder::Restart(std::uint32_t ssrc, std::uint32_t rollover) {
  rollovers_.erase(ssrc);
  if (rollover != 0) rollovers_[ssrc] = rollover;
  g_signal_emit_by_name(element_, "remove-key", ssrc);
}

void SrtpDecoder::Clear() {
  rollovers_.clear();
  g_signal_emit_by_name(element_, "clear-keys");
}

GstCaps* SrtpDecoder::CapsFor(std::uint32_t ssrc) const {
  const BufferPtr key(gst_buffer_new_memdup(key_.data(), key_.size()));
  const auto guess = rollovers_.find(ssrc);
  return gst_caps_new_simple(
      "application/x-srtp", "srtp-key", GST_TYPE_BUFFER, key.get(), "srtp-cipher", G_TYPE_STRING,
      policy_.cipher.c_str(), "srtp-auth", G_TYPE_STRING, policy_.auth.c_str(), "srtcp-cipher",
      G_TYPE_STRING, policy_.cipher.c_str(), "srtcp-auth", G_TYPE_STRING, policy_.rtcp_auth.c_str(),
      "roc", G_TYPE_UINT, guess == rollovers_.end() ? 0 : guess->second, nullptr);
}

}  // namespace lidar::gst
