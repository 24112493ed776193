// SPDX-License-Identifier: LGPL-2.1-or-later
// The stock srtpenc as a function that protects all streams and links of a bin.
#pragma once
#include <gst/gst.h>

#include <memory>
#include <mutex>

#include "gst/common/refs.h"
#include "gst/scream/srtp/key.h"
#include "gst/scream/srtp/relay.h"

namespace lidar::gst {

/// Protects packets with an srtpenc that is a child of the bin. All streams and links share one
/// encoder, because two encoders with the same key would use the same packet index twice. Any
/// thread may call the methods.
class SrtpEncoder {
 public:
  /// Returns null if the srtp plugin is missing.
  static std::unique_ptr<SrtpEncoder> Create(GstElement* bin, const SrtpPolicy& policy);
  ~SrtpEncoder();
  SrtpEncoder(const SrtpEncoder&) = delete;
  SrtpEncoder& operator=(const SrtpEncoder&) = delete;

  void SetKey(const SrtpKey& key);
  /// Returns the protected RTP or RTCP packet, which has the metas of `packet`. Returns NULL if
  /// srtpenc refuses the packet, or if no key was set. Takes ownership of `packet`.
  BufferPtr Protect(GstBuffer* packet);

 private:
  SrtpEncoder(GstElement* bin, GstElement* element);
  /// The pads of srtpenc for one kind of packet, "rtp" or "rtcp".
  struct Way {
    PadPtr sink;
    std::unique_ptr<Relay> relay;  // receives the protected packets
  };
  Way NewWay(const std::string& kind);

  GstElement* bin_;
  GstElement* element_;  // owned by the bin
  Way rtp_;
  Way rtcp_;
  std::mutex mutex_;  // held while srtpenc works, which pushes only to the relays
  bool has_key_ = false;
  BufferPtr out_;
};

}  // namespace lidar::gst
