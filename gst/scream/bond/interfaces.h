// SPDX-License-Identifier: LGPL-2.1-or-later
// The machine's interfaces and addresses now, and what a link lacks of them.
#pragma once
#include <gio/gio.h>

#include <map>
#include <set>
#include <string>

#include "gst/scream/bond/addresses.h"

namespace lidar::gst {

class Interfaces {
 public:
  static Interfaces Now();
  /// Why no packet can leave by the link for a peer of that family; empty if one can.
  std::string Lacks(const BondAddress& link, GSocketFamily family) const;

  struct Interface {
    bool up = false;
    std::set<GSocketFamily> families;  // that it has an address of
  };
  std::map<std::string, Interface> by_name;
  std::set<std::string> addresses;
};

}  // namespace lidar::gst
