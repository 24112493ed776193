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

std::string DigestOf(const SrtpKey& key) {
  const StringPtr digest(g_compute_checksum_for_data(G_CHECKSUM_SHA256, key.data(), key.size()));
  return digest.get();
}

}  // namespace

SrtpLayer::SrtpLayer(const SrtpPolicy& policy, const SrtpPlaces& places)
    : policy_(policy), places_(places) {
  for (std::size_t i = 0; i < places.links.size(); ++i)
    inputs_.push_back(std::make_unique<SrtpInput>(places.bin, policy, [this](const SrtpKey& key) {
      if (!places_.sends_media) encoder_->SetKey(key);
    }));
}

std::unique_ptr<SrtpLayer> SrtpLayer::Create(const SrtpSettings& settings, const SrtpPlaces& places,
                                             std::string* error) {
  const auto policy = SrtpPolicyOf(settings, error);
  if (!policy) return nullptr;
  const auto key = ReadSrtpKey(settings.key, *policy, error);
  if (!key) return nullptr;
  std::unique_ptr<SrtpLayer> layer(new SrtpLayer(*policy, places));
  layer->encoder_ = SrtpEncoder::Create(places.bin, *policy, *key);
  *error = "the srtp plugin is missing; install gstreamer1.0-plugins-bad";
  if (!layer->encoder_ || !layer->AddKey(*key)) return nullptr;
  *error = "the elements of the srtp plugin cannot be linked";
  if (!layer->Link()) return nullptr;
  layer->digests_.push_back(DigestOf(*key));
  return layer;
}

bool SrtpLayer::AddKey(const SrtpKey& key) {
  return std::all_of(inputs_.begin(), inputs_.end(),
                     [&key](const auto& input) { return input->AddKey(key); });
}

SrtpCounts SrtpLayer::counts() const {
  SrtpCounts sum;
  for (const auto& input : inputs_) {
    const SrtpCounts counts = input->counts();
    sum.received += counts.received;
    sum.refused += counts.refused;
    sum.copies += counts.copies;
    sum.key_changes = std::max(sum.key_changes, counts.key_changes);
  }
  return sum;
}

bool SrtpLayer::ChangeKey(const std::string& source, std::string* error) {
  const auto key = ReadSrtpKey(source, policy_, error);
  if (!key) return false;
  {
    const std::lock_guard lock(mutex_);
    const std::string digest = DigestOf(*key);
    if (digest == digests_.back()) return true;
    // The packet index begins at 0 with each key: a repeated key would encrypt two packets alike.
    if (std::find(digests_.begin(), digests_.end(), digest) != digests_.end()) {
      *error = "this key was in use before; a key must be new";
      return false;
    }
    if (!places_.sends_media && inputs_.front()->waiting_keys() >= kMaxWaitingKeys) {
      *error = "two new keys wait already for the sender to use them";
      return false;
    }
    digests_.push_back(digest);
    if (digests_.size() > kRememberedKeys) digests_.pop_front();
  }
  AddKey(*key);
  if (places_.sends_media) encoder_->SetKey(*key);
  return true;
}

bool SrtpLayer::Link() {
  for (std::size_t i = 0; i < places_.links.size(); ++i) {
    const SrtpPlace& place = places_.links[i];
    const PadPtr out = PadOf(place.sender, place.out);
    const PadPtr in = PadOf(place.sender, place.in);
    const PadPtr socket_source = PadOf(place.socket_source, "src");
    gst_pad_unlink(socket_source.get(), in.get());
    if (!inputs_[i]->Link(socket_source.get(), in.get())) return false;
    probes_.push_back(gst_pad_add_probe(
        out.get(),
        static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_BUFFER_LIST),
        OnOut, this, nullptr));
  }
  return true;
}

bool SrtpLayer::IsDone(GstBuffer* packet) const {
  return places_.links.size() > 1 && !IsRtcp(packet);
}

/// A refused packet was sent before, or the key is used up: the packet must not leave.
GstPadProbeReturn SrtpLayer::OnOut(GstPad*, GstPadProbeInfo* info, gpointer data) {
  auto* self = static_cast<SrtpLayer*>(data);
  if ((GST_PAD_PROBE_INFO_TYPE(info) & GST_PAD_PROBE_TYPE_BUFFER) != 0) {
    GstBuffer* packet = GST_PAD_PROBE_INFO_BUFFER(info);
    if (self->IsDone(packet)) return GST_PAD_PROBE_OK;
    info->data = self->Protect(packet).release();
    return info->data != nullptr ? GST_PAD_PROBE_OK : GST_PAD_PROBE_HANDLED;
  }
  const BufferListPtr list(GST_PAD_PROBE_INFO_BUFFER_LIST(info));
  const guint n = gst_buffer_list_length(list.get());
  GstBufferList* out = gst_buffer_list_new_sized(n);
  for (guint i = 0; i < n; ++i) {
    BufferPtr packet(gst_buffer_ref(gst_buffer_list_get(list.get(), i)));
    if (!self->IsDone(packet.get())) packet = self->Protect(packet.release());
    if (packet) gst_buffer_list_add(out, packet.release());
  }
  info->data = out;
  if (gst_buffer_list_length(out) > 0) return GST_PAD_PROBE_OK;
  return GST_PAD_PROBE_DROP;
}

SrtpLayer::~SrtpLayer() {
  for (std::size_t i = 0; i < probes_.size(); ++i)
    gst_pad_remove_probe(PadOf(places_.links[i].sender, places_.links[i].out).get(), probes_[i]);
  inputs_.clear();
  for (const SrtpPlace& place : places_.links)
    gst_element_link_pads(place.socket_source, "src", place.sender, place.in);
}

}  // namespace lidar::gst
