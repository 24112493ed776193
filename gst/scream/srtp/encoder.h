// SPDX-License-Identifier: LGPL-2.1-or-later
// The stock srtpenc as a function: what all streams and links of a bin are protected with.
#pragma once
#include <gst/gst.h>

#include <memory>
#include <mutex>

#include "gst/common/refs.h"
#include "gst/scream/srtp/key.h"

namespace lidar::gst {

/// A child of the bin while it lives. There is one for a key: two would use a packet index twice.
/// Any thread may call.
class SrtpEncoder {
 public:
  /// Null if the srtp plugin is missing.
  static std::unique_ptr<SrtpEncoder> Create(GstElement* bin, const SrtpPolicy& policy,
                                             const SrtpKey& key);
  ~SrtpEncoder();
  SrtpEncoder(const SrtpEncoder&) = delete;
  SrtpEncoder& operator=(const SrtpEncoder&) = delete;

  void SetKey(const SrtpKey& key);
  /// RTP or RTCP, protected, with its metas; NULL if srtpenc refuses it. Takes the buffer.
  BufferPtr Protect(GstBuffer* packet);

 private:
  SrtpEncoder(GstElement* bin, GstElement* element);
  /// A direction through the element: "rtp" or "rtcp".
  struct Way {
    PadPtr sink;
    PadPtr relay;  // takes what comes out
  };
  Way NewWay(const std::string& kind);

  GstElement* bin_;
  GstElement* element_;  // of the bin
  Way rtp_;
  Way rtcp_;
  std::mutex mutex_;  // held while the element works; it pushes into the relays only
  BufferPtr out_;
};

}  // namespace lidar::gst
