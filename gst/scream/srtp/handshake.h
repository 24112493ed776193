// SPDX-License-Identifier: LGPL-2.1-or-later
// A DTLS handshake by the stock dtlsdec and dtlsenc. These elements are not in a bin, so their
// errors end only the handshake, and not the pipeline.
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
  /// A function that sends a datagram to the peer. Threads of dtlsenc call it.
  using Send = std::function<void(GstBuffer*)>;

  /// Starts a handshake. A client sends its hello at once; a server waits for the peer's hello.
  /// Returns null if the dtls plugin is missing.
  static std::unique_ptr<DtlsHandshake> Start(const Certificates& certificates, bool is_client,
                                              Send send);
  ~DtlsHandshake();
  DtlsHandshake(const DtlsHandshake&) = delete;
  DtlsHandshake& operator=(const DtlsHandshake&) = delete;

  /// Processes a datagram from the peer. Only one thread at a time may call it.
  void Take(GstBuffer* datagram);
  State state() const { return state_; }
  /// Returns the client's SRTP key (RFC 5764), which is valid in the state kDone.
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
  std::optional<Relay> sender_;  // receives what the encoder sends
  std::atomic<State> state_{State::kOpen};
  SrtpKey key_;  // written before `state_` becomes kDone
};

}  // namespace lidar::gst
