// SPDX-License-Identifier: LGPL-2.1-or-later
// SRTP and SRTCP between the SCReAM elements and the socket of a bin, by the stock srtp plugin.
#pragma once
#include <gst/gst.h>

#include <deque>
#include <memory>
#include <mutex>
#include <string>

#include "gst/common/properties.h"
#include "gst/common/refs.h"
#include "gst/scream/srtp/input.h"
#include "gst/scream/srtp/key.h"

namespace lidar::gst {

/// Places of the layer: pads of the bin's children, linked plainly.
struct SrtpLinks {
  GstElement* bin;
  GstElement* sender;         // screamtx or screamrx
  const char* out;            // its pad towards the socket
  const char* in;             // its pad from the socket
  GstElement* socket_sink;    // ecnudpsink
  GstElement* socket_source;  // ecnudpsrc
  bool sends_media;           // out is RTP and in RTCP; else the other way round
};

/// Lives from READY to NULL of its bin. Every SSRC has the one key.
class SrtpLayer {
 public:
  /// Null and `error` where the key, the cipher or the srtp plugin is not usable.
  static std::unique_ptr<SrtpLayer> Create(const SrtpSettings& settings, const SrtpLinks& links,
                                           std::string* error);
  ~SrtpLayer();
  SrtpLayer(const SrtpLayer&) = delete;
  SrtpLayer& operator=(const SrtpLayer&) = delete;

  SrtpCounts counts() const { return input_->counts(); }
  /// Bytes that it adds to each RTP packet.
  unsigned overhead() const { return policy_.overhead; }
  /// Takes the key that `source` names beside the one in use. The end that sends media uses it at
  /// once; the end that answers does once the media does. False and `error` where it is no key or
  /// was used before.
  bool ChangeKey(const std::string& source, std::string* error);

 private:
  SrtpLayer(const SrtpPolicy& policy, const SrtpLinks& links);
  bool MakeEncoder(const SrtpKey& key);
  bool Link();
  bool LinkMedia(GstPad* source, GstPad* socket);
  void EncodeWith(const SrtpKey& key);

  SrtpPolicy policy_;
  SrtpLinks links_;
  GstElement* enc_ = nullptr;  // of the bin
  PadPtr out_rtcp_;            // takes RTCP out of what screamtx sends, to the encoder
  gulong out_probe_ = 0;
  PadPtr out_relay_;  // from the encoder to the socket
  std::unique_ptr<SrtpInput> input_;

  std::mutex mutex_;                 // guards digests_
  std::deque<std::string> digests_;  // of the keys so far
};

/// srtp-key (write-only), srtp-cipher and srtp-auth.
const std::array<Property<SrtpSettings>, 3>& SrtpRows();
/// Makes the layer where `settings` ask for one; false, and an error on the bus, where it cannot.
bool StartSrtp(const SrtpSettings& settings, const SrtpLinks& links,
               std::shared_ptr<SrtpLayer>* layer);
/// Gives a layer that runs its new key; a warning on the bus and false where it cannot.
bool TakeSrtpKey(GstElement* bin, SrtpLayer* layer, const std::string& key);
/// srtp-received, srtp-refused and srtp-key-changes; nothing where there is no layer.
void AddSrtpStats(const SrtpLayer* layer, GstStructure* stats);

}  // namespace lidar::gst
