// SPDX-License-Identifier: LGPL-2.1-or-later
// SRTP and SRTCP between the SCReAM elements and the sockets of a bin, by the stock srtp plugin.
#pragma once
#include <gst/gst.h>

#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "gst/common/properties.h"
#include "gst/common/refs.h"
#include "gst/scream/srtp/dtls_keys.h"
#include "gst/scream/srtp/encoder.h"
#include "gst/scream/srtp/input.h"
#include "gst/scream/srtp/key.h"
#include "gst/scream/srtp/key_gate.h"

namespace lidar::gst {

/// The linked pads of a bin's children between which the layer is inserted.
struct SrtpPlace {
  GstElement* sender;         // screamtx or screamrx
  const char* out;            // its pad towards the socket
  const char* in;             // its pad from the socket
  GstElement* socket_source;  // ecnudpsrc
};
struct SrtpPlaces {
  GstElement* bin;
  bool sends_media;
  std::vector<SrtpPlace> links;
  /// Sends a datagram as DtlsKeys::Calls::send does. Any thread calls it.
  std::function<void(GstBuffer*, const DtlsKeys::Addresses&)> send_dtls;
};

/// Exists while its bin is in READY or above. All SSRCs use the same key. The layer protects the
/// packets that leave through SrtpPlace::out, and drops them until there is a key. If there are
/// several links, Protect() protects each RTP packet once for all links. The input of each link has
/// its own replay windows.
class SrtpLayer {
 public:
  /// Returns null and sets `error` if the key, the cipher or the srtp plugin is unusable.
  static std::unique_ptr<SrtpLayer> Create(const SrtpSettings& settings, const SrtpPlaces& places,
                                           std::string* error);
  ~SrtpLayer();
  SrtpLayer(const SrtpLayer&) = delete;
  SrtpLayer& operator=(const SrtpLayer&) = delete;

  /// Returns the sums over all inputs or, for key_changes, the maximum.
  SrtpCounts counts() const;
  /// Returns zeros if DTLS is not used.
  DtlsCounts dtls_counts() const;
  bool by_dtls() const { return dtls_ != nullptr; }
  /// Starts or stops DTLS. DTLS runs only while the bin plays, because the sockets are read only
  /// then.
  void SetPlaying(bool playing);
  /// Returns the gate, which opens when there is a key or when the layer is destroyed. The gate may
  /// outlive the layer.
  std::shared_ptr<KeyGate> gate() const { return gate_; }
  /// Returns the number of bytes that are added to each RTP packet.
  unsigned overhead() const { return policy_.overhead; }
  BufferPtr Protect(GstBuffer* packet);
  /// Adds the key that `source` names. The end that sends media uses the new key at once. The other
  /// end uses it after it has received media that were protected with it. If there is no key, or
  /// the key was used before, sets `error` and returns false.
  bool ChangeKey(const std::string& source, std::string* error);

 private:
  SrtpLayer(const SrtpPolicy& policy, const SrtpPlaces& places);
  bool AddKey(const SrtpKey& key);
  void CreateDtls(const Certificates& certificates);
  bool Link();
  bool IsDone(GstBuffer* packet) const;
  static GstPadProbeReturn OnOut(GstPad* pad, GstPadProbeInfo* info, gpointer self);

  SrtpPolicy policy_;
  SrtpPlaces places_;
  std::unique_ptr<SrtpEncoder> encoder_;
  std::vector<std::unique_ptr<SrtpInput>> inputs_;  // one per link
  std::vector<gulong> probes_;                      // one per link
  std::shared_ptr<KeyGate> gate_ = std::make_shared<KeyGate>();
  std::atomic<std::uint64_t> protected_{0};  // packets of media

  std::mutex mutex_;                 // guards digests_
  std::deque<std::string> digests_;  // of all keys so far

  std::unique_ptr<DtlsKeys> dtls_;  // uses all members above
};

/// srtp-key (write-only), srtp-cipher, srtp-auth, dtls-certificate and dtls-peer-certificate.
const std::array<Property<SrtpSettings>, 5>& SrtpRows();
/// Creates the layer if `settings` ask for it. If that fails, posts an error message and returns
/// false.
bool StartSrtp(const SrtpSettings& settings, const SrtpPlaces& places,
               std::shared_ptr<SrtpLayer>* layer);
/// Gives a running layer its new key. If that fails, posts a warning and returns false.
bool TakeSrtpKey(GstElement* bin, SrtpLayer* layer, const std::string& key);
/// Adds the counters of SRTP and, if DTLS is used, the counters of DTLS. Adds nothing if there is
/// no layer.
void AddSrtpStats(const SrtpLayer* layer, GstStructure* stats);

}  // namespace lidar::gst
