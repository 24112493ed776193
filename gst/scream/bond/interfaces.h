// SPDX-License-Identifier: LGPL-2.1-or-later
// The network interfaces and addresses of this machine, and a check whether a link can use them.
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
  /// Returns an empty text if the link can send packets to a peer of `family`, else the reason why
  /// it cannot.
  std::string Lacks(const BondAddress& link, GSocketFamily family) const;

  struct Interface {
    bool up = false;
    std::set<GSocketFamily> families;  // address families of the interface
  };
  std::map<std::string, Interface> by_name;
  std::set<std::string> addresses;
};

}  // namespace lidar::gst
