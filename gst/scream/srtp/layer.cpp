// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/srtp/layer.h"

#include <algorithm>

#include "gst/scream/rtp_packet.h"

namespace lidar::gst {
namespace {

constexpr std::size_t kRememberedKeys = 1'024;
constexpr std::size_t kMaxWaitingKeys = 2;

PadPtr PadOf(GstElement* element, const char* name) {
  return PadPtr(gst_element_get_static_pad(element, name));
}

/// Takes what `source` gives and chains it into the pad that is its private data. Both ends are of
/// one streaming thread, so order is kept and no queue is needed.
PadPtr NewRelay(GstPad* target) {
  PadPtr pad(GST_PAD(gst_object_ref_sink(gst_pad_new("srtcp", GST_PAD_SINK))));
  gst_pad_set_element_private(pad.get(), target);
  gst_pad_set_chain_function(pad.get(), [](GstPad* p, GstObject*, GstBuffer* buffer) {
    return gst_pad_chain(GST_PAD(gst_pad_get_element_private(p)), buffer);
  });
  gst_pad_set_event_function(pad.get(), [](GstPad*, GstObject*, GstEvent* event) -> gboolean {
    gst_event_unref(event);  // the target has its own
    return TRUE;
  });
  gst_pad_set_active(pad.get(), TRUE);
  return pad;
}

std::string DigestOf(const SrtpKey& key) {
  const StringPtr digest(g_compute_checksum_for_data(G_CHECKSUM_SHA256, key.data(), key.size()));
  return digest.get();
}

}  // namespace

SrtpLayer::SrtpLayer(const SrtpPolicy& policy, const SrtpLinks& links)
    : policy_(policy), links_(links) {
  input_ = std::make_unique<SrtpInput>(links.bin, policy, [this](const SrtpKey& key) {
    if (!links_.sends_media) EncodeWith(key);
  });
}

std::unique_ptr<SrtpLayer> SrtpLayer::Create(const SrtpSettings& settings, const SrtpLinks& links,
                                             std::string* error) {
  const auto policy = SrtpPolicyOf(settings, error);
  if (!policy) return nullptr;
  const auto key = ReadSrtpKey(settings.key, *policy, error);
  if (!key) return nullptr;
  std::unique_ptr<SrtpLayer> layer(new SrtpLayer(*policy, links));
  *error = "the srtp plugin is missing; install gstreamer1.0-plugins-bad";
  if (!layer->MakeEncoder(*key) || !layer->input_->AddKey(*key)) return nullptr;
  *error = "the elements of the srtp plugin cannot be linked";
  if (!layer->Link()) return nullptr;
  layer->digests_.push_back(DigestOf(*key));
  return layer;
}

bool SrtpLayer::ChangeKey(const std::string& source, std::string* error) {
  const auto key = ReadSrtpKey(source, policy_, error);
  if (!key) return false;
  {
    const std::lock_guard lock(mutex_);
    const std::string digest = DigestOf(*key);
    if (digest == digests_.back()) return true;
    // The packet index begins at 0 with every key: one that comes back would encrypt twice alike.
    if (std::find(digests_.begin(), digests_.end(), digest) != digests_.end()) {
      *error = "this key was in use before; a key must be new";
      return false;
    }
    if (!links_.sends_media && input_->waiting_keys() >= kMaxWaitingKeys) {
      *error = "two new keys wait already for the sender to use them";
      return false;
    }
    digests_.push_back(digest);
    if (digests_.size() > kRememberedKeys) digests_.pop_front();
  }
  input_->AddKey(*key);
  if (links_.sends_media) EncodeWith(*key);
  return true;
}

void SrtpLayer::EncodeWith(const SrtpKey& key) {
  const BufferPtr buffer(gst_buffer_new_memdup(key.data(), key.size()));
  g_object_set(enc_, "key", buffer.get(), nullptr);
}

bool SrtpLayer::MakeEncoder(const SrtpKey& key) {
  enc_ = gst_element_factory_make("srtpenc", nullptr);
  if (enc_ == nullptr) return false;
  gst_bin_add(GST_BIN(links_.bin), enc_);
  for (const char* name : {"rtp-cipher", "rtcp-cipher"})
    gst_util_set_object_arg(G_OBJECT(enc_), name, policy_.cipher.c_str());
  gst_util_set_object_arg(G_OBJECT(enc_), "rtp-auth", policy_.auth.c_str());
  gst_util_set_object_arg(G_OBJECT(enc_), "rtcp-auth", policy_.rtcp_auth.c_str());
  g_object_set(enc_, "allow-repeat-tx", FALSE, nullptr);
  EncodeWith(key);
  return true;
}

bool SrtpLayer::Link() {
  const PadPtr out = PadOf(links_.sender, links_.out);
  const PadPtr in = PadOf(links_.sender, links_.in);
  const PadPtr socket_sink = PadOf(links_.socket_sink, "sink");
  const PadPtr socket_source = PadOf(links_.socket_source, "src");
  gst_pad_unlink(out.get(), socket_sink.get());
  gst_pad_unlink(socket_source.get(), in.get());
  if (!input_->Link(socket_source.get(), in.get())) return false;
  if (links_.sends_media) return LinkMedia(out.get(), socket_sink.get());
  const PadPtr rtcp_in(gst_element_request_pad_simple(enc_, "rtcp_sink_0"));
  return gst_pad_link(out.get(), rtcp_in.get()) == GST_PAD_LINK_OK &&
         gst_pad_link(PadOf(enc_, "rtcp_src_0").get(), socket_sink.get()) == GST_PAD_LINK_OK;
}

bool SrtpLayer::LinkMedia(GstPad* source, GstPad* socket) {
  const PadPtr rtp_in(gst_element_request_pad_simple(enc_, "rtp_sink_0"));
  const PadPtr rtcp_in(gst_element_request_pad_simple(enc_, "rtcp_sink_0"));
  out_relay_ = NewRelay(socket);
  out_rtcp_.reset(GST_PAD(gst_object_ref_sink(gst_pad_new("rtcp", GST_PAD_SRC))));
  gst_pad_set_active(out_rtcp_.get(), TRUE);
  // screamtx says goodbye with RTCP among its RTP.
  out_probe_ = gst_pad_add_probe(
      source, GST_PAD_PROBE_TYPE_BUFFER,
      [](GstPad* pad, GstPadProbeInfo* info, gpointer data) {
        GstBuffer* buffer = GST_PAD_PROBE_INFO_BUFFER(info);
        GstPad* rtcp = static_cast<SrtpLayer*>(data)->out_rtcp_.get();
        if (!IsRtcp(buffer)) return GST_PAD_PROBE_OK;
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
  return gst_pad_link(source, rtp_in.get()) == GST_PAD_LINK_OK &&
         gst_pad_link(PadOf(enc_, "rtp_src_0").get(), socket) == GST_PAD_LINK_OK &&
         gst_pad_link(out_rtcp_.get(), rtcp_in.get()) == GST_PAD_LINK_OK &&
         gst_pad_link(PadOf(enc_, "rtcp_src_0").get(), out_relay_.get()) == GST_PAD_LINK_OK;
}

SrtpLayer::~SrtpLayer() {
  if (out_probe_ != 0) gst_pad_remove_probe(PadOf(links_.sender, links_.out).get(), out_probe_);
  if (enc_ != nullptr) {
    gst_element_set_state(enc_, GST_STATE_NULL);
    gst_bin_remove(GST_BIN(links_.bin), enc_);  // unlinks its pads
  }
  input_.reset();
  for (const PadPtr* pad : {&out_rtcp_, &out_relay_})
    if (*pad) gst_pad_set_active(pad->get(), FALSE);
  gst_element_link_pads(links_.sender, links_.out, links_.socket_sink, "sink");
  gst_element_link_pads(links_.socket_source, "src", links_.sender, links_.in);
}

}  // namespace lidar::gst
