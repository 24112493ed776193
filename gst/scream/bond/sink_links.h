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
/// Opens the links of `addresses`; a warning names each link that cannot carry packets now. Posts
/// an element error and returns nothing if no link can, or if the text is wrong.
std::vector<OpenLink> OpenLinks(GstElement* bin, const std::string& addresses);

/// The elements between the pads of a bin and the network: the bond, and each link's own elements.
class SinkLinks {
 public:
  struct Chain {
    GstElement* tx;
    GstElement* sink;
    GstElement* src;
  };

  /// Returns true if a link whose receiver is at `peer` takes the buffer as feedback.
  using Takes = std::function<bool(GstBuffer*, GSocketAddress* peer)>;

  SinkLinks(GstElement* bin, const Chain& first, const std::vector<OpenLink>& links,
            const BondSettings& settings, Takes takes);
  ~SinkLinks();
  SinkLinks(const SinkLinks&) = delete;
  SinkLinks& operator=(const SinkLinks&) = delete;

  /// Adds a stream with the pad `tx_pad` of the first link. Returns the bond's pad, which takes the
  /// stream's packets.
  GstPad* Add(GstPad* tx_pad);
  /// Removes a stream. Returns the first link's pad, which remains.
  PadPtr Remove(GstPad* sink);
  /// The elements of each link, in the order of the links.
  const std::vector<Chain>& chains() const { return chains_; }
  /// Returns true for a redundant warning: scream-link-changed already reports packets that cannot
  /// be sent, and a silent link does not matter while another one works.
  bool IsNoNews(GstObject* warns) const;
  /// Sets the layer that protects packets before they come to the links.
  void Protect(std::shared_ptr<SrtpLayer> layer) { BondProtect(bond_, std::move(layer)); }
  /// Adds the array `links` to `stats`.
  void AddStats(GstStructure* stats) const;

 private:
  /// Numbers of packets that a link's socket sent and failed to send.
  struct Health {
    guint64 sent = 0;
    guint64 errors = 0;
    gint64 failed_us = 0;  // monotonic time of the last failure
  };
  void AddLink(const OpenLink& link);
  /// Detects links that became unusable or usable.
  void Watch();
  /// Returns true if a call in the last second found new errors and no new sent packet.
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
