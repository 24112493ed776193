// SPDX-License-Identifier: LGPL-2.1-or-later
// The links of a screamsink that sends over several links.
#pragma once
#include <gst/gst.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gst/common/properties.h"
#include "gst/scream/bond/addresses.h"
#include "gst/scream/bond/bond.h"
#include "gst/scream/bond/interfaces.h"
#include "gst/scream/srtp/layer.h"

namespace lidar::gst {

struct BondSettings {
  std::string addresses;
  gint method = 0;
  gint target = 0;
};
const std::array<Property<BondSettings>, 3>& BondRows();

/// A link with its socket.
struct OpenLink {
  BondAddress address;
  SharedSocket socket;
  SharedSocketAddress peer;
  bool usable = true;
};
/// Opens the links in `addresses`. Posts a warning for each link that cannot send packets now. If
/// no link can, or if the text is wrong, posts an error message and returns no links.
std::vector<OpenLink> OpenLinks(GstElement* bin, const std::string& addresses);

/// The elements between the pads of a bin and the network: the bond, and the elements of each link.
class SinkLinks {
 public:
  struct Chain {
    GstElement* tx;
    GstElement* sink;
    GstElement* src;
  };

  /// A function that returns true if the buffer is feedback for the link whose receiver is at
  /// `peer`.
  using Takes = std::function<bool(GstBuffer*, GSocketAddress* peer)>;

  SinkLinks(GstElement* bin, const Chain& first, const std::vector<OpenLink>& links,
            const BondSettings& settings, Takes takes);
  ~SinkLinks();
  SinkLinks(const SinkLinks&) = delete;
  SinkLinks& operator=(const SinkLinks&) = delete;

  /// Adds a stream, for which the first link has the pad `tx_pad`. Returns the bond's pad that
  /// receives the stream's packets.
  GstPad* Add(GstPad* tx_pad);
  /// Removes a stream. Returns the stream's pad at the first link, which is not removed.
  PadPtr Remove(GstPad* sink);
  /// Returns the elements of each link, in the order of the links.
  const std::vector<Chain>& chains() const { return chains_; }
  /// Returns true if a warning from the element `warns` is redundant. A warning of a link's sink is
  /// redundant, because the message scream-link-changed reports packets that cannot be sent. A
  /// warning of a link's screamtx is redundant while another link gets feedback.
  bool IsNoNews(GstObject* warns) const;
  /// Sets the layer that protects packets before they go to the links.
  void Protect(std::shared_ptr<SrtpLayer> layer) { BondProtect(bond_, std::move(layer)); }
  /// Adds the array `links` to `stats`.
  void AddStats(GstStructure* stats) const;

 private:
  /// The number of packets that a link's socket has sent, and the number that it failed to send.
  struct Health {
    guint64 sent = 0;
    guint64 errors = 0;
    gint64 failed_us = 0;  // monotonic time of the last failure
  };
  void AddLink(const OpenLink& link);
  /// Finds links that became usable or unusable, and posts a message about each of them.
  void Watch();
  /// Returns true if a call in the last second found new send errors of `link` but no newly sent
  /// packet.
  bool Fails(std::size_t link);
  void Change(std::size_t link, const std::string& trouble);

  GstElement* bin_;
  const Takes takes_;
  GstLidarScreamBond* bond_ = nullptr;  // owned by the bin
  std::vector<Chain> chains_;
  std::vector<OpenLink> links_;
  std::vector<Health> health_;  // used by the bond's thread only
};

}  // namespace lidar::gst
