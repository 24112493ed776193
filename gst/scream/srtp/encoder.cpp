// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/srtp/encoder.h"

#include <string>
#include <utility>

#include "gst/scream/rtp_packet.h"

namespace lidar::gst {
namespace {

// The window is large, so that a packet can be protected after many packets with higher numbers.
constexpr guint kWindow = 4'096;  // packets

}  // namespace

std::unique_ptr<SrtpEncoder> SrtpEncoder::Create(GstElement* bin, const SrtpPolicy& policy) {
  GstElement* element = gst_element_factory_make("srtpenc", nullptr);
  if (element == nullptr) return nullptr;
  for (const char* name : {"rtp-cipher", "rtcp-cipher"})
    gst_util_set_object_arg(G_OBJECT(element), name, policy.cipher.c_str());
  gst_util_set_object_arg(G_OBJECT(element), "rtp-auth", policy.auth.c_str());
  gst_util_set_object_arg(G_OBJECT(element), "rtcp-auth", policy.rtcp_auth.c_str());
  g_object_set(element, "allow-repeat-tx", FALSE, "replay-window-size", kWindow, nullptr);
  gst_element_set_locked_state(element, TRUE);
  gst_bin_add(GST_BIN(bin), element);
  return std::unique_ptr<SrtpEncoder>(new SrtpEncoder(bin, element));
}

SrtpEncoder::SrtpEncoder(GstElement* bin, GstElement* element) : bin_(bin), element_(element) {
  rtp_ = NewWay("rtp");
  rtcp_ = NewWay("rtcp");
}

SrtpEncoder::~SrtpEncoder() {
  gst_element_set_state(element_, GST_STATE_NULL);
  gst_bin_remove(GST_BIN(bin_), element_);  // also unlinks its pads
}

SrtpEncoder::Way SrtpEncoder::NewWay(const std::string& kind) {
  Way way;
  way.sink.reset(gst_element_request_pad_simple(element_, (kind + "_sink_0").c_str()));
  way.relay = std::make_unique<Relay>(element_, (kind + "_src_0").c_str(),
                                      [this](BufferPtr packet) { out_ = std::move(packet); });
  return way;
}

void SrtpEncoder::SetKey(const SrtpKey& key) {
  const BufferPtr buffer(gst_buffer_new_memdup(key.data(), key.size()));
  const std::lock_guard lock(mutex_);
  g_object_set(element_, "key", buffer.get(), nullptr);
  // Starts srtpenc only after its first key is set. If the first key were set in PLAYING, srtpenc
  // of GStreamer 1.22 would never free its session.
  if (!std::exchange(has_key_, true)) gst_element_set_state(element_, GST_STATE_PLAYING);
}

BufferPtr SrtpEncoder::Protect(GstBuffer* packet) {
  BufferPtr owner(packet);
  const bool rtcp = IsRtcp(packet);
  GstPad* sink = (rtcp ? rtcp_ : rtp_).sink.get();
  const std::lock_guard lock(mutex_);
  if (!has_key_) return nullptr;  // srtpenc would generate a key itself
  BeginStream(sink, rtcp ? "application/x-rtcp" : "application/x-rtp");
  gst_pad_chain(sink, owner.release());
  return std::move(out_);
}

}  // namespace lidar::gst
