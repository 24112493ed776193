// SPDX-License-Identifier: LGPL-2.1-or-later
// The stock srtpdec with one key: says of each datagram whether the key fits.
#pragma once
#include <gst/gst.h>

#include <cstdint>
#include <map>
#include <memory>

#include "gst/common/refs.h"
#include "gst/scream/srtp/key.h"

namespace lidar::gst {

/// A child of the bin while it lives, and never stopped by it: srtpdec complains of a state change
/// while it decodes. Everything but the making of it belongs to the one streaming thread that gives
/// it datagrams.
class SrtpDecoder {
 public:
  /// Null if the srtp plugin is missing.
  static std::unique_ptr<SrtpDecoder> Create(GstElement* bin, const SrtpPolicy& policy,
                                             SrtpKey key);
  ~SrtpDecoder();
  SrtpDecoder(const SrtpDecoder&) = delete;
  SrtpDecoder& operator=(const SrtpDecoder&) = delete;

  const SrtpKey& key() const { return key_; }
  /// `datagram` decoded, where it is RTP or RTCP by this key and no replay; else NULL. Leaves
  /// `datagram` alone.
  BufferPtr Decode(GstBuffer* datagram);
  /// Forgets all of `ssrc` but this guess of its rollover counter.
  void Restart(std::uint32_t ssrc, std::uint32_t rollover);
  /// Forgets every stream. The only way to get memory back from srtpdec while it runs: in
  /// GStreamer 1.22 what Restart removes stays in its session.
  void Clear();

 private:
  SrtpDecoder(GstElement* bin, GstElement* element, const SrtpPolicy& policy, SrtpKey key);
  PadPtr NewRelay(const char* source);
  void Start();
  GstCaps* CapsFor(std::uint32_t ssrc) const;

  GstElement* bin_;
  GstElement* element_;  // of the bin
  SrtpPolicy policy_;
  SrtpKey key_;
  PadPtr sink_;
  PadPtr rtp_;  // take what comes out
  PadPtr rtcp_;
  std::map<std::uint32_t, std::uint32_t> rollovers_;  // guesses past 0
  BufferPtr out_;                                     // of the datagram in work
};

}  // namespace lidar::gst
