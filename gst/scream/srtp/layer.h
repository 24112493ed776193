// SPDX-License-Identifier: LGPL-2.1-or-later
// SRTP and SRTCP between the SCReAM elements and the sockets of a bin, by the stock srtp plugin.
#pragma once
#include <gst/gst.h>

#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "gst/common/properties.h"
#include "gst/common/refs.h"
#include "gst/scream/srtp/encoder.h"
#include "gst/scream/srtp/input.h"
#include "gst/scream/srtp/key.h"

namespace lidar::gst {

/// Pads of the bin's children, linked plainly: where the layer goes.
struct SrtpPlace {
  GstElement* sender;         // screamtx or screamrx
  const char* out;            // its pad towards the socket
  const char* in;             // its pad from the socket
  GstElement* socket_sink;    // ecnudpsink
  GstElement* socket_source;  // ecnudpsrc
};
struct SrtpPlaces {
  GstElement* bin;
  bool sends_media;
  std::vector<SrtpPlace> links;
};

/// Lives from READY to NULL of its bin. Every SSRC has the one key. Packets that leave by `out` are
/// protected there, but RTP over several links is protected once for all of them, by Protect().
/// Each link's input has replay windows of its own.
class SrtpLayer {
 public:
  /// Returns null and sets `error` if the key, the cipher or the srtp plugin is not usable.
  static std::unique_ptr<SrtpLayer> Create(const SrtpSettings& settings, const SrtpPlaces& places,
                                           std::string* error);
  ~SrtpLayer();
  SrtpLayer(const SrtpLayer&) = delete;
  SrtpLayer& operator=(const SrtpLayer&) = delete;

  /// The sum over all inputs.
  SrtpCounts counts() const;
  /// Bytes that it adds to each RTP packet.
  unsigned overhead() const { return policy_.overhead; }
  BufferPtr Protect(GstBuffer* packet) { return encoder_->Protect(packet); }
  /// Takes the key that `source` names beside the one in use. The end that sends media uses it at
  /// once; the end that answers does once the media does. Returns false and sets `error` if it is
  /// no key or was used before.
  bool ChangeKey(const std::string& source, std::string* error);

 private:
  SrtpLayer(const SrtpPolicy& policy, const SrtpPlaces& places);
  bool AddKey(const SrtpKey& key);
  bool Link();
  bool IsDone(GstBuffer* packet) const;
  static GstPadProbeReturn OnOut(GstPad* pad, GstPadProbeInfo* info, gpointer self);

  SrtpPolicy policy_;
  SrtpPlaces places_;
  std::unique_ptr<SrtpEncoder> encoder_;
  std::vector<std::unique_ptr<SrtpInput>> inputs_;  // by link
  std::vector<gulong> probes_;                      // by link

  std::mutex mutex_;                 // guards digests_
  std::deque<std::string> digests_;  // of the keys so far
};

/// srtp-key (write-only), srtp-cipher and srtp-auth.
const std::array<Property<SrtpSettings>, 3>& SrtpRows();
/// Makes the layer if `settings` ask for it; false, and an error on the bus, if that fails.
bool StartSrtp(const SrtpSettings& settings, const SrtpPlaces& places,
               std::shared_ptr<SrtpLayer>* layer);
/// Gives a layer that runs its new key; a warning on the bus and false if it cannot.
bool TakeSrtpKey(GstElement* bin, SrtpLayer* layer, const std::string& key);
/// Adds srtp-received, srtp-refused and srtp-key-changes; nothing without a layer.
void AddSrtpStats(const SrtpLayer* layer, GstStructure* stats);

}  // namespace lidar::gst
