// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/srtp/layer.h"

#include <algorithm>

#include "gst/common/packet_probe.h"
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

bool ReadKey(const SrtpSettings& settings, const SrtpPolicy& policy, SrtpKey* key,
             std::string* error) {
  const auto read = ReadSrtpKey(settings.key, policy, error);
  if (read) *key = *read;
  return read.has_value();
}

bool ReadForDtls(const SrtpSettings& settings, Certificates* certificates, std::string* error) {
  *error = "srtp-key cannot be set together with dtls-certificate or dtls-peer-certificate";
  if (!settings.key.empty()) return false;
  *error = "with DTLS, srtp-cipher must be aes-128-icm and srtp-auth hmac-sha1-80";
  const SrtpSettings usual;
  if (settings.cipher != usual.cipher || settings.auth != usual.auth) return false;
  *error = "the dtls plugin is missing; install gstreamer1.0-plugins-bad";
  GstElementFactory* factory = gst_element_factory_find("dtlsdec");
  if (factory == nullptr) return false;
  gst_object_unref(factory);
  *error = "dtls-certificate and dtls-peer-certificate must be set together";
  if (settings.dtls_certificate.empty() || settings.dtls_peer_certificate.empty()) return false;
  return ReadCertificates(settings.dtls_certificate, settings.dtls_peer_certificate, certificates,
                          error);
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
  SrtpKey key;
  Certificates certificates;
  if (settings.by_dtls() ? !ReadForDtls(settings, &certificates, error)
                         : !ReadKey(settings, *policy, &key, error))
    return nullptr;
  std::unique_ptr<SrtpLayer> layer(new SrtpLayer(*policy, places));
  layer->encoder_ = SrtpEncoder::Create(places.bin, *policy);
  *error = "the srtp plugin is missing; install gstreamer1.0-plugins-bad";
  if (!layer->encoder_ || !layer->AddKey(key)) return nullptr;
  for (const auto& input : layer->inputs_)
    if (settings.by_dtls())
      input->SetDtls([l = layer.get()](GstBuffer* datagram) { l->dtls_->Take(datagram); });
  *error = "the elements of the srtp plugin cannot be linked";
  if (!layer->Link()) return nullptr;
  if (settings.by_dtls()) layer->CreateDtls(certificates);
  return layer;
}

/// Adds a key to all inputs. The end that sends media encodes with the new key at once. The other
/// end encodes with its first key at once, and with a later key when the media use this key. Does
/// nothing for an empty key.
bool SrtpLayer::AddKey(const SrtpKey& key) {
  if (key.empty()) return true;
  if (!std::all_of(inputs_.begin(), inputs_.end(),
                   [&key](const auto& input) { return input->AddKey(key); }))
    return false;
  if (places_.sends_media || !gate_->is_open()) encoder_->SetKey(key);
  gate_->Open();
  const std::lock_guard lock(mutex_);
  digests_.push_back(DigestOf(key));
  if (digests_.size() > kRememberedKeys) digests_.pop_front();
  return true;
}

void SrtpLayer::CreateDtls(const Certificates& certificates) {
  DtlsKeys::Calls calls;
  calls.send = places_.send_dtls;
  calls.on_key = [this](const SrtpKey& key) { AddKey(key); };
  calls.traffic = [this] {
    const SrtpCounts in = counts();
    return SrtpTraffic{protected_, in.received - in.refused};
  };
  calls.warn = [bin = places_.bin](const char* what, const char* to_do) {
    GST_ELEMENT_WARNING(bin, RESOURCE, NOT_AUTHORIZED, ("%s", what), ("%s", to_do));
  };
  dtls_ = std::make_unique<DtlsKeys>(certificates, places_.sends_media, std::move(calls));
}

void SrtpLayer::SetPlaying(bool playing) {
  if (!dtls_) return;
  playing ? dtls_->Start() : dtls_->Stop();
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

DtlsCounts SrtpLayer::dtls_counts() const {
  DtlsCounts counts = dtls_ ? dtls_->counts() : DtlsCounts{};
  counts.unkeyed = gate_->dropped();
  return counts;
}

BufferPtr SrtpLayer::Protect(GstBuffer* packet) {
  if (!IsRtcp(packet)) ++protected_;
  return encoder_->Protect(packet);
}

bool SrtpLayer::ChangeKey(const std::string& source, std::string* error) {
  *error = "DTLS negotiates the keys";
  if (dtls_) return false;
  const auto key = ReadSrtpKey(source, policy_, error);
  if (!key) return false;
  {
    const std::lock_guard lock(mutex_);
    const std::string digest = DigestOf(*key);
    if (digest == digests_.back()) return true;
    // The packet index begins at 0 with each key. If a key were used again, two packets would be
    // encrypted with the same key and index.
    if (std::find(digests_.begin(), digests_.end(), digest) != digests_.end()) {
      *error = "this key was in use before; set a new key";
      return false;
    }
    if (!places_.sends_media && inputs_.front()->waiting_keys() >= kMaxWaitingKeys) {
      *error = "two new keys already wait for the sender to use them";
      return false;
    }
  }
  return AddKey(*key);
}

bool SrtpLayer::Link() {
  for (std::size_t i = 0; i < places_.links.size(); ++i) {
    const SrtpPlace& place = places_.links[i];
    const PadPtr out = PadOf(place.sender, place.out);
    const PadPtr in = PadOf(place.sender, place.in);
    const PadPtr socket_source = PadOf(place.socket_source, "src");
    gst_pad_unlink(socket_source.get(), in.get());
    if (!inputs_[i]->Link(socket_source.get(), in.get())) return false;
    probes_.push_back(gst_pad_add_probe(out.get(), kPacketProbe, OnOut, this, nullptr));
  }
  return true;
}

bool SrtpLayer::IsDone(GstBuffer* packet) const {
  return places_.links.size() > 1 && !IsRtcp(packet);
}

/// Protects the packets that leave the element. A packet is dropped if srtpenc refuses it, because
/// it was sent before or because the key has protected as many packets as it may.
GstPadProbeReturn SrtpLayer::OnOut(GstPad*, GstPadProbeInfo* info, gpointer data) {
  auto* self = static_cast<SrtpLayer*>(data);
  return MapPackets(info, [self](BufferPtr packet) {
    return self->IsDone(packet.get()) ? std::move(packet) : self->Protect(packet.release());
  });
}

SrtpLayer::~SrtpLayer() {
  dtls_.reset();
  gate_->Open();
  for (std::size_t i = 0; i < probes_.size(); ++i)
    gst_pad_remove_probe(PadOf(places_.links[i].sender, places_.links[i].out).get(), probes_[i]);
  inputs_.clear();
  for (const SrtpPlace& place : places_.links)
    gst_element_link_pads(place.socket_source, "src", place.sender, place.in);
}

}  // namespace lidar::gst
