// SPDX-License-Identifier: LGPL-2.1-or-later
// The links of a screamsink that sends over several.
#pragma once
#include <gst/gst.h>

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
/// The links of `addresses` whose names are found and whose sockets open; a warning names each that
/// cannot carry packets now. Empty after an element error, where none can or the text is wrong.
std::vector<OpenLink> OpenLinks(GstElement* bin, const std::string& addresses);

/// The elements between the pads of a bin and the network: the bond, and the elements of each link.
class SinkLinks {
 public:
  struct Chain {
    GstElement* tx;
    GstElement* sink;
    GstElement* src;
  };

  SinkLinks(GstElement* bin, const Chain& first, const std::vector<OpenLink>& links,
            const BondSettings& settings);
  ~SinkLinks();
  SinkLinks(const SinkLinks&) = delete;
  SinkLinks& operator=(const SinkLinks&) = delete;

  /// Adds a stream; returns its pad for the packets of `tx_pad`, a pad of the first link.
  GstPad* Add(GstPad* tx_pad);
  /// Takes it away; the first link's pad remains, and is returned.
  PadPtr Remove(GstPad* sink);
  /// The chains by link.
  const std::vector<Chain>& chains() const { return chains_; }
  /// True for a warning that adds nothing: scream-link-changed reports what cannot be sent, and a
  /// silent link does not matter if another one works.
  bool IsNoNews(GstObject* warns) const;
  /// Packets are protected before they come to the links.
  void Protect(std::shared_ptr<SrtpLayer> layer) { BondProtect(bond_, std::move(layer)); }
  /// The array `links` of `stats`.
  void AddStats(GstStructure* stats) const;

 private:
  /// Counts of packets that a link's socket sent and failed to send.
  struct Health {
    guint64 sent = 0;
    guint64 errors = 0;
    gint64 failed_us = 0;  // monotonic time
  };
  void AddLink(const OpenLink& link);
  /// Looks for links that vanished or came back.
  void Watch();
  /// Whether packets failed, and none left, since the last look, or lately.
  bool Fails(std::size_t link);
  void Change(std::size_t link, const std::string& trouble);

  GstElement* bin_;
  GstLidarScreamBond* bond_ = nullptr;  // the bin's
  std::vector<Chain> chains_;
  std::vector<OpenLink> links_;
  std::vector<Health> health_;  // of the bond's thread
};

}  // namespace lidar::gst
