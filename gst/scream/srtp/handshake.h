// SPDX-License-Identifier: LGPL-2.1-or-later
// One DTLS handshake by the stock dtlsdec and dtlsenc, which are in no bin: their errors end the
// handshake, not the pipeline.
#pragma once
#include <gst/gst.h>

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "gst/common/certificates.h"
#include "gst/common/refs.h"
#include "gst/scream/srtp/key.h"
#include "gst/scream/srtp/relay.h"

namespace lidar::gst {

class DtlsHandshake {
 public:
  enum class State { kOpen, kDone, kRefused, kFailed };
  /// Sends a datagram to the peer. Threads of dtlsenc call it.
  using Send = std::function<void(GstBuffer*)>;

  /// Null without the dtls plugin. A client begins at once; a server waits for the peer's hello.
  static std::unique_ptr<DtlsHandshake> Start(const Certificates& certificates, bool is_client,
                                              Send send);
  ~DtlsHandshake();
  DtlsHandshake(const DtlsHandshake&) = delete;
  DtlsHandshake& operator=(const DtlsHandshake&) = delete;

  /// Takes a datagram of the peer; one thread at a time.
  void Take(GstBuffer* datagram);
  State state() const { return state_; }
  /// The client's SRTP key (RFC 5764); valid in kDone.
  const SrtpKey& key() const { return key_; }

 private:
  DtlsHandshake(const Certificates& certificates, bool is_client, Send send);
  bool Start();
  void OnKey(GstBuffer* key);

  std::string trusted_;
  bool is_client_;
  Send send_;
  ElementPtr decoder_;
  ElementPtr encoder_;
  PadPtr sink_;                  // of the decoder
  std::optional<Relay> sender_;  // takes what the encoder sends
  std::atomic<State> state_{State::kOpen};
  SrtpKey key_;  // written before state_
};

}  // namespace lidar::gst
