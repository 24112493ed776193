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

/// Linked pads of the bin's children, between which the layer is inserted.
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

/// Lives from READY to NULL of its bin. All SSRCs use the same key. The layer protects packets that
/// leave by `out`, and drops them until it has a key. Protect() protects RTP over several links
/// once for all links. The input of each link has its own replay windows.
class SrtpLayer {
 public:
  /// Returns null and sets `error` if the key, the cipher or the srtp plugin is unusable.
  static std::unique_ptr<SrtpLayer> Create(const SrtpSettings& settings, const SrtpPlaces& places,
                                           std::string* error);
  ~SrtpLayer();
  SrtpLayer(const SrtpLayer&) = delete;
  SrtpLayer& operator=(const SrtpLayer&) = delete;

  /// Sums over all inputs.
  SrtpCounts counts() const;
  /// All zero without DTLS.
  DtlsCounts dtls_counts() const;
  bool by_dtls() const { return dtls_ != nullptr; }
  /// DTLS runs only while the bin plays, because the sockets are read only then.
  void SetPlaying(bool playing);
  /// The gate opens with the first key or at the end of the layer, and may outlive the layer.
  std::shared_ptr<KeyGate> gate() const { return gate_; }
  /// Bytes added to each RTP packet.
  unsigned overhead() const { return policy_.overhead; }
  BufferPtr Protect(GstBuffer* packet);
  /// Adds the key that `source` names. The end that sends media uses it at once; the other end uses
  /// it once the media use it. Returns false and sets `error` if there is no key or it was used
  /// before.
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

  std::unique_ptr<DtlsKeys> dtls_;  // uses all of the above
};

/// srtp-key (write-only), srtp-cipher, srtp-auth, dtls-certificate and dtls-peer-certificate.
const std::array<Property<SrtpSettings>, 5>& SrtpRows();
/// Creates the layer if `settings` ask for it. Returns false and posts an error if that fails.
bool StartSrtp(const SrtpSettings& settings, const SrtpPlaces& places,
               std::shared_ptr<SrtpLayer>* layer);
/// Gives a running layer its new key. Returns false and posts a warning if that fails.
bool TakeSrtpKey(GstElement* bin, SrtpLayer* layer, const std::string& key);
/// Adds the counters of SRTP, and of DTLS where it is used; nothing without a layer.
void AddSrtpStats(const SrtpLayer* layer, GstStructure* stats);

}  // namespace lidar::gst
