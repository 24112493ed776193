// SPDX-License-Identifier: LGPL-2.1-or-later
// The bond: the element in a screamsink that sends each stream over several links.
//
//     sink_%u ── Scheduler ──▶ src_0 ── screamtx ── ecnudpsink
//                        └───▶ src_1 ── screamtx ── ecnudpsink
//
// Threads: streaming threads push packets to the links that the scheduler chooses. The bond's own
// thread pushes copies, and sends targets to encoders. One mutex guards the scheduler and the
// packets that are kept for copies. No thread holds the mutex while it pushes. Each screamtx holds
// its own lock while it calls the bond.
#pragma once
#include <gst/gst.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gst/common/refs.h"
#include "gst/scream/bond/link_stats.h"
#include "gst/scream/srtp/layer.h"
#include "gst/scream/tx/gstscreamtx.h"
#include "src/bonding/scheduler.h"

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_SCREAM_BOND (gst_lidar_scream_bond_get_type())
G_DECLARE_FINAL_TYPE(GstLidarScreamBond, gst_lidar_scream_bond, GST, LIDAR_SCREAM_BOND, GstElement)
G_END_DECLS

namespace lidar::gst {

/// Creates a bond of `links`. Each link is a screamtx, which the bond uses until BondRelease(). The
/// returned reference is floating.
GstLidarScreamBond* NewBond(const std::vector<GstLidarScreamTx*>& links, bonding::Method method,
                            bonding::TargetRule rule);
/// Sets the layer that protects each RTP packet before the packet goes to the links. All links then
/// send the same bytes. Call it below READY.
void BondProtect(GstLidarScreamBond* bond, std::shared_ptr<SrtpLayer> layer);
/// Detaches the links from the bond. Call it below READY.
void BondRelease(GstLidarScreamBond* bond);
/// Adds a stream. Its packets enter at the returned sink pad and go to `tx_pads`, which are a pad
/// of each link in the order of the links.
GstPad* BondAddStream(GstLidarScreamBond* bond, const std::vector<GstPad*>& tx_pads);
/// Removes a sink pad; the pads of the links remain.
void BondRemoveStream(GstLidarScreamBond* bond, GstPad* sink);
/// Returns the pads of the links to which the packets of `sink` go, in the order of the links.
std::vector<PadPtr> BondedPads(GstPad* sink);

/// Sets whether the link can send packets at all.
void BondSetUsable(GstLidarScreamBond* bond, std::size_t link, bool usable);
/// Sets a function that the bond's thread calls every 0.1 s. The thread holds no lock during the
/// call. Call BondSetWatch() below READY.
void BondSetWatch(GstLidarScreamBond* bond, std::function<void()> watch);

/// Returns the statistics of `link`, except its name.
BondLinkStats BondStats(GstLidarScreamBond* bond, std::size_t link);

}  // namespace lidar::gst
