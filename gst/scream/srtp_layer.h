// SPDX-License-Identifier: LGPL-2.1-or-later
// SRTP and SRTCP between the SCReAM elements and the socket of a bin, by the stock srtp plugin.
#pragma once
#include <gst/gst.h>

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "common/refs.h"

namespace lidar::gst {

struct SrtpSettings {
  std::string key;  // hex, "file:PATH" or "env:NAME"; empty: no SRTP
  std::string cipher = "aes-128-icm";
  std::string auth = "hmac-sha1-80";
};

/// The master key and salt, or none and what to do in `error`.
std::optional<std::vector<std::uint8_t>> ReadSrtpKey(const SrtpSettings& settings,
                                                     std::string* error);

/// Where the layer goes: pads of the bin's children, linked plainly.
struct SrtpLinks {
  GstElement* bin;
  GstElement* sender;         // screamtx or screamrx
  const char* out;            // its pad towards the socket
  const char* in;             // its pad from the socket
  GstElement* socket_sink;    // ecnudpsink
  GstElement* socket_source;  // ecnudpsrc
  bool sends_media;           // out is RTP and in RTCP; else the other way round
};

struct SrtpCounts {
  std::uint64_t received = 0;  // datagrams
  std::uint64_t refused = 0;   // wrong key, replayed, damaged or not protected
};

/// Lives from READY to NULL of its bin. Every SSRC has the one key; a stream that is joined after
/// its sequence numbers wrapped has its rollover counter searched, one guess a packet.
class SrtpLayer {
 public:
  /// Null and `error` where the key, the cipher or the srtp plugin is not usable.
  static std::unique_ptr<SrtpLayer> Create(const SrtpSettings& settings, const SrtpLinks& links,
                                           std::string* error);
  ~SrtpLayer();
  SrtpLayer(const SrtpLayer&) = delete;
  SrtpLayer& operator=(const SrtpLayer&) = delete;

  SrtpCounts counts() const;
  /// Bytes that it adds to each RTP packet.
  unsigned overhead() const;

 private:
  struct Stream {
    std::uint32_t rollover = 0;  // the guess in use
    bool known = false;          // a packet passed with it
    unsigned failures = 0;       // since the last that passed
  };

  SrtpLayer(const SrtpSettings& settings, const SrtpLinks& links, std::vector<std::uint8_t> key);
  bool MakeElements(std::string* error);
  bool LinkOut();
  bool LinkIn();
  GstCaps* KeyFor(std::uint32_t ssrc);
  void OnDatagram(GstBuffer* buffer);
  void OnPassed();
  void OnRefused(std::unique_lock<std::mutex>* lock);

  SrtpSettings settings_;
  SrtpLinks links_;
  std::vector<std::uint8_t> key_;
  GstElement* enc_ = nullptr;  // of the bin
  GstElement* dec_ = nullptr;
  PadPtr out_rtcp_;  // takes RTCP out of what screamtx sends, to the encoder
  gulong out_probe_ = 0;
  PadPtr out_relay_;  // from the encoder to the socket
  PadPtr in_entry_;   // from the socket to the decoder
  PadPtr in_relay_;   // RTCP from the decoder into the stream of RTP

  mutable std::mutex mutex_;  // guards all below; never held while pushing or posting
  std::map<std::uint32_t, Stream> streams_;
  SrtpCounts counts_;
  std::optional<std::uint32_t> undecided_;  // SSRC of the datagram in the decoder
  bool warned_ = false;
};

/// Makes the layer where `settings` ask for one; false, and an error on the bus, where it cannot.
bool StartSrtp(const SrtpSettings& settings, const SrtpLinks& links,
               std::shared_ptr<SrtpLayer>* layer);
/// The properties srtp-key (write-only), srtp-cipher and srtp-auth, as ids from `first_id` on.
void InstallSrtpProperties(GObjectClass* object, guint first_id);
void SetSrtpProperty(SrtpSettings* settings, guint index, const GValue* value);
void GetSrtpProperty(const SrtpSettings& settings, guint index, GValue* value);
/// srtp-received and srtp-refused; nothing where there is no layer.
void AddSrtpStats(const SrtpLayer* layer, GstStructure* stats);

}  // namespace lidar::gst
