// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/srtp/handshake.h"

#include <utility>

namespace lidar::gst {

DtlsHandshake::DtlsHandshake(const Certificates& certificates, bool is_client, Send send)
    : trusted_(certificates.peer), is_client_(is_client), send_(std::move(send)) {
  const auto make = [](const char* factory) {
    GstElement* element = gst_element_factory_make(factory, nullptr);
    return ElementPtr(element != nullptr ? GST_ELEMENT(gst_object_ref_sink(element)) : nullptr);
  };
  decoder_ = make("dtlsdec");
  encoder_ = make("dtlsenc");
  if (!decoder_ || !encoder_) return;
  // dtlsdec and dtlsenc find each other by this id in a table of the process.
  const StringPtr id(g_uuid_string_random());
  g_object_set(decoder_.get(), "pem", certificates.own.c_str(), nullptr);
  g_object_set(decoder_.get(), "connection-id", id.get(), nullptr);
  g_object_set(encoder_.get(), "connection-id", id.get(), "is-client",
               static_cast<gboolean>(is_client), nullptr);
}

std::unique_ptr<DtlsHandshake> DtlsHandshake::Start(const Certificates& certificates,
                                                    bool is_client, Send send) {
  std::unique_ptr<DtlsHandshake> made(new DtlsHandshake(certificates, is_client, std::move(send)));
  if (!made->decoder_ || !made->encoder_ || !made->Start()) return nullptr;
  return made;
}

bool DtlsHandshake::Start() {
  sink_.reset(gst_element_get_static_pad(decoder_.get(), "sink"));
  sender_.emplace(encoder_.get(), "src", [this](BufferPtr datagram) { send_(datagram.get()); });
  // Both ends use the client's key, which is the encoder's key at the client and the decoder's key
  // at the server.
  GstElement* has_key = is_client_ ? encoder_.get() : decoder_.get();
  g_signal_connect(
      has_key, "on-key-received", G_CALLBACK(+[](GstElement* element, DtlsHandshake* self) {
        GstBuffer* key = nullptr;
        g_object_get(element, self->is_client_ ? "encoder-key" : "decoder-key", &key, nullptr);
        const BufferPtr owner(key);
        self->OnKey(key);
      }),
      this);
  // The decoder starts first, because it creates the connection that the encoder looks up.
  for (GstElement* element : {decoder_.get(), encoder_.get()})
    if (gst_element_set_state(element, GST_STATE_PLAYING) == GST_STATE_CHANGE_FAILURE) return false;
  return true;
}

DtlsHandshake::~DtlsHandshake() {
  for (GstElement* element : {encoder_.get(), decoder_.get()})
    if (element != nullptr) gst_element_set_state(element, GST_STATE_NULL);
}

/// Accepts the key if the peer's certificate, which has arrived before the key, is the trusted one.
void DtlsHandshake::OnKey(GstBuffer* key) {
  gchar* pem = nullptr;
  g_object_get(decoder_.get(), "peer-pem", &pem, nullptr);
  const StringPtr owner(pem);
  if (pem == nullptr || CertificateIn(pem) != trusted_) {
    state_ = State::kRefused;
    return;
  }
  key_.resize(gst_buffer_get_size(key));
  gst_buffer_extract(key, 0, key_.data(), key_.size());
  state_ = State::kDone;
}

void DtlsHandshake::Take(GstBuffer* datagram) {
  BeginStream(sink_.get(), "application/x-dtls");
  // The decoder changes the datagram in place, so it gets a copy.
  const GstFlowReturn flow = gst_pad_chain(sink_.get(), gst_buffer_copy_deep(datagram));
  if (flow != GST_FLOW_OK && state_ == State::kOpen) state_ = State::kFailed;
}

}  // namespace lidar::gst
