// SPDX-License-Identifier: LGPL-2.1-or-later
// The stock srtpdec with one key: decodes a datagram, or refuses it if the key does not fit.
#pragma once
#include <gst/gst.h>

#include <cstdint>
#include <map>
#include <memory>

#include "gst/common/refs.h"
#include "gst/scream/srtp/key.h"
#include "gst/scream/srtp/relay.h"

namespace lidar::gst {

/// The bin contains srtpdec but never changes its state, because srtpdec warns of a state change
/// while it decodes. Any thread may create an SrtpDecoder; only the streaming thread that gives it
/// datagrams may use it.
class SrtpDecoder {
 public:
  /// Null if the srtp plugin is missing.
  static std::unique_ptr<SrtpDecoder> Create(GstElement* bin, const SrtpPolicy& policy,
                                             SrtpKey key);
  ~SrtpDecoder();
  SrtpDecoder(const SrtpDecoder&) = delete;
  SrtpDecoder& operator=(const SrtpDecoder&) = delete;

  const SrtpKey& key() const { return key_; }
  /// Returns the decoded datagram if it is RTP or RTCP by this key and no replay, else NULL. Leaves
  /// `datagram` unchanged.
  BufferPtr Decode(GstBuffer* datagram);
  /// Forgets the state of `ssrc` and starts from this rollover counter.
  void Restart(std::uint32_t ssrc, std::uint32_t rollover);
  /// Forgets all streams. Only this frees memory of srtpdec while it runs: in GStreamer 1.22 its
  /// session keeps what Restart() removes.
  void Clear();

 private:
  SrtpDecoder(GstElement* bin, GstElement* element, const SrtpPolicy& policy, SrtpKey key);
  GstCaps* CapsFor(std::uint32_t ssrc) const;

  GstElement* bin_;
  GstElement* element_;  // owned by the bin
  SrtpPolicy policy_;
  SrtpKey key_;
  PadPtr sink_;
  Relay rtp_;  // take the decoded packets
  Relay rtcp_;
  std::map<std::uint32_t, std::uint32_t> rollovers_;  // counters above 0 that were tried
  BufferPtr out_;                                     // of the present datagram
};

}  // namespace lidar::gst
