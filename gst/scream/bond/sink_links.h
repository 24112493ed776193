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
};
/// The links of `addresses` whose sockets open; a warning names each other one. Empty after an
/// element error, where none does or the text is wrong.
std::vector<OpenLink> OpenLinks(GstElement* bin, const std::string& addresses);

/// What stands between the pads of a bin and the network: the bond, and the elements of each link.
/// The first link has the bin's own.
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

  /// The pad that packets for `tx_pad`, one of the first link's, go to.
  GstPad* Add(GstPad* tx_pad);
  /// Takes it away; the first link's pad remains, and is returned.
  PadPtr Remove(GstPad* sink);
  /// By link.
  const std::vector<Chain>& chains() const { return chains_; }
  /// Packets are protected before they come to the links.
  void Protect(std::shared_ptr<SrtpLayer> layer) { BondProtect(bond_, std::move(layer)); }
  /// The array `links` of `stats`.
  void AddStats(GstStructure* stats) const;

 private:
  void AddLink(const OpenLink& link);

  GstElement* bin_;
  GstLidarScreamBond* bond_ = nullptr;  // the bin's
  std::vector<Chain> chains_;
  std::vector<OpenLink> links_;
};

}  // namespace lidar::gst
