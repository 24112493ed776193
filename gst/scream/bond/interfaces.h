// SPDX-License-Identifier: LGPL-2.1-or-later
// The machine's interfaces and addresses, and which of them a link lacks.
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
  /// Returns the reason why the link cannot carry packets for a peer of that family, or an empty
  /// text if it can carry them.
  std::string Lacks(const BondAddress& link, GSocketFamily family) const;

  struct Interface {
    bool up = false;
    std::set<GSocketFamily> families;  // of its addresses
  };
  std::map<std::string, Interface> by_name;
  std::set<std::string> addresses;
};

}  // namespace lidar::gst
