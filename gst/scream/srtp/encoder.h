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

/// srtpenc is a child of the bin. Each key has one encoder, because two encoders would use a packet
/// index twice. All threads may call it.
class SrtpEncoder {
 public:
  /// Null if the srtp plugin is missing.
  static std::unique_ptr<SrtpEncoder> Create(GstElement* bin, const SrtpPolicy& policy);
  ~SrtpEncoder();
  SrtpEncoder(const SrtpEncoder&) = delete;
  SrtpEncoder& operator=(const SrtpEncoder&) = delete;

  void SetKey(const SrtpKey& key);
  /// Returns the protected RTP or RTCP packet with its metas; NULL if srtpenc refuses it, or before
  /// a key was set. Takes the buffer.
  BufferPtr Protect(GstBuffer* packet);

 private:
  SrtpEncoder(GstElement* bin, GstElement* element);
  /// A direction through the element: "rtp" or "rtcp".
  struct Way {
    PadPtr sink;
    std::unique_ptr<Relay> relay;  // takes the protected packets
  };
  Way NewWay(const std::string& kind);

  GstElement* bin_;
  GstElement* element_;  // owned by the bin
  Way rtp_;
  Way rtcp_;
  std::mutex mutex_;  // held while the element works; it only pushes to the relays
  bool has_key_ = false;
  BufferPtr out_;
};

}  // namespace lidar::gst
