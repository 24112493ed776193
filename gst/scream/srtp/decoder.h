// SPDX-License-Identifier: LGPL-2.1-or-later
// The stock srtpdec with one key: decodes a datagram, or refuses it if it was protected with
// another key.
#pragma once
#include <gst/gst.h>

#include <cstdint>
#include <map>
#include <memory>

#include "gst/common/refs.h"
#include "gst/scream/srtp/key.h"
#include "gst/scream/srtp/relay.h"

namespace lidar::gst {

/// Decodes with an srtpdec that is a child of the bin. The bin does not change the state of
/// srtpdec, because srtpdec warns if its state changes while it decodes. Any thread may create an
/// SrtpDecoder, but only the streaming thread that brings the datagrams may use it.
class SrtpDecoder {
 public:
  /// Returns null if the srtp plugin is missing.
  static std::unique_ptr<SrtpDecoder> Create(GstElement* bin, const SrtpPolicy& policy,
                                             SrtpKey key);
  ~SrtpDecoder();
  SrtpDecoder(const SrtpDecoder&) = delete;
  SrtpDecoder& operator=(const SrtpDecoder&) = delete;

  const SrtpKey& key() const { return key_; }
  /// Returns the decoded datagram if it is RTP or RTCP that was protected with this key and is not
  /// a replay, else NULL. Does not change `datagram`.
  BufferPtr Decode(GstBuffer* datagram);
  /// Removes the state of `ssrc`. Its next packet is decoded with the rollover counter `rollover`.
  void Restart(std::uint32_t ssrc, std::uint32_t rollover);
  /// Removes the state of all streams. Only Clear() frees memory of srtpdec while srtpdec runs,
  /// because in GStreamer 1.22 the session of srtpdec keeps what Restart() removes.
  void Clear();

 private:
  SrtpDecoder(GstElement* bin, GstElement* element, const SrtpPolicy& policy, SrtpKey key);
  GstCaps* CapsFor(std::uint32_t ssrc) const;

  GstElement* bin_;
  GstElement* element_;  // owned by the bin
  SrtpPolicy policy_;
  SrtpKey key_;
  PadPtr sink_;
  Relay rtp_;  // receive the decoded packets
  Relay rtcp_;
  std::map<std::uint32_t, std::uint32_t> rollovers_;  // counters above 0 that Restart() has set
  BufferPtr out_;                                     // decoded from the current datagram
};

}  // namespace lidar::gst
