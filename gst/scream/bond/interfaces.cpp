// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/bond/interfaces.h"

#include <ifaddrs.h>
#include <net/if.h>

#include <memory>

namespace lidar::gst {

Interfaces Interfaces::Now() {
  Interfaces now;
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return now;
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> owner(first, freeifaddrs);
  for (const ifaddrs* a = first; a != nullptr; a = a->ifa_next) {
    Interface& interface = now.by_name[a->ifa_name];
    interface.up = (a->ifa_flags & IFF_UP) != 0 && (a->ifa_flags & IFF_RUNNING) != 0;
    if (a->ifa_addr == nullptr) continue;
    const bool v4 = a->ifa_addr->sa_family == AF_INET;
    if (!v4 && a->ifa_addr->sa_family != AF_INET6) continue;
    interface.families.insert(v4 ? G_SOCKET_FAMILY_IPV4 : G_SOCKET_FAMILY_IPV6);
    const SocketAddressPtr address(g_socket_address_new_from_native(
        a->ifa_addr, v4 ? sizeof(sockaddr_in) : sizeof(sockaddr_in6)));
    const std::string host = HostOf(address.get());
    const auto scope = host.find('%');
    now.addresses.insert(host);
    if (scope != std::string::npos) now.addresses.insert(host.substr(0, scope + 1) + a->ifa_name);
  }
  return now;
}

std::string Interfaces::Lacks(const BondAddress& link, GSocketFamily family) const {
  if (!link.interface.empty()) {
    const auto found = by_name.find(link.interface);
    if (found == by_name.end()) return "there is no interface " + link.interface;
    if (!found->second.up) return "the interface " + link.interface + " is down";
    // If this interface has no address of the family, the kernel would send from the address of
    // another interface.
    if (found->second.families.count(family) == 0)
      return "the interface " + link.interface + " has no IPv" +
             (family == G_SOCKET_FAMILY_IPV6 ? "6" : "4") + " address";
  }
  const std::string& local = link.target.bind_address;
  const bool loopback = local.compare(0, 4, "127.") == 0;
  if (local.empty() || loopback || addresses.count(local) > 0) return "";
  return "no interface has the address " + local;
}

}  // namespace lidar::gst
