// SPDX-License-Identifier: LGPL-2.1-or-later
// The interface by which a screamtx, as one of several links of a stream, calls its owner.
#pragma once
#include <gst/gst.h>

#include <memory>
#include <optional>

#include "gst/scream/tx/gstscreamtx.h"
#include "src/rtcp/ccfb.h"
#include "src/scream/controller.h"

namespace lidar::gst {

/// screamtx calls the methods from any of its threads, with its lock held.
class TxLink {
 public:
  virtual ~TxLink() = default;
  /// Returns true if this link still has to send the packet.
  virtual bool Wants(Time now, guint32 ssrc, guint16 seq) = 0;
  /// Called when this link sends a packet. Returns the sequence number by which this link's
  /// controller identifies the packet.
  virtual guint16 OnSent(Time now, guint32 ssrc, guint16 seq) = 0;
  /// Called when this link drops a packet. Returns true if another link has delivered the packet.
  virtual bool OnDropped(Time now, guint32 ssrc, guint16 seq) = 0;
  /// Converts the sequence numbers in a report to those that OnSent() has returned. Returns nothing
  /// if the report names packets that this link never sent.
  virtual std::optional<rtcp::CongestionFeedback> OnFeedback(
      Time now, const rtcp::CongestionFeedback& report) = 0;
  /// Returns the number of bytes at the end of each packet that are not media.
  virtual gsize trailer() const = 0;
  /// Called after each report, with the controller's statistics.
  virtual void OnPath(const scream::Statistics& statistics) = 0;
};

/// Sets the owner, or null if this screamtx is the only link. Call it below READY.
void TxSetLink(GstLidarScreamTx* tx, std::shared_ptr<TxLink> link);

}  // namespace lidar::gst
