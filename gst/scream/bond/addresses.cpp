// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/bond/addresses.h"

#include <net/if.h>

#include <algorithm>
#include <sstream>

#include "gst/common/refs.h"

namespace lidar::gst {
namespace {

std::string Trim(const std::string& text) {
  const auto first = text.find_first_not_of(' ');
  return first == std::string::npos ? ""
                                    : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

std::optional<guint> ParsePort(const std::string& text) {
  if (text.empty() || text.size() > 5 || text.find_first_not_of("0123456789") != std::string::npos)
    return std::nullopt;
  const int port = std::stoi(text);
  return port >= 1 && port <= 65535 ? std::optional(static_cast<guint>(port)) : std::nullopt;
}

/// Returns the IP address in the form in which GLib writes it, or an empty text if `text` is not an
/// IP address. A link-local address keeps its interface (fe80::1%eth0).
std::string AddressOf(const std::string& text) {
  const std::string host = WithoutBrackets(text);
  const auto scope = std::min(host.find('%'), host.size());
  const std::unique_ptr<GInetAddress, GObjectUnref> address(
      g_inet_address_new_from_string(host.substr(0, scope).c_str()));
  return address ? StringPtr(g_inet_address_to_string(address.get())).get() + host.substr(scope)
                 : "";
}

std::optional<BondAddress> ParseOne(const std::string& text, std::string* error) {
  BondAddress link;
  link.text = text;
  const auto at = text.rfind('@');
  const std::string peer = text.substr(0, at);
  const std::string local = at == std::string::npos ? "" : text.substr(at + 1);
  const auto colon = peer.rfind(':');
  const auto port = colon == std::string::npos ? std::nullopt : ParsePort(peer.substr(colon + 1));
  link.target.host = peer.substr(0, colon);
  const bool open_v6 = link.target.host.find(':') != std::string::npos && peer.front() != '[';
  if (!port || link.target.host.empty() || open_v6) {
    *error =
        "\"" + text + "\" must be HOST:PORT or HOST:PORT@INTERFACE (an IPv6 address in brackets)";
    return std::nullopt;
  }
  link.target.port = *port;
  link.target.bind_address = AddressOf(local);
  if (link.target.bind_address.empty()) link.interface = local;
  if (link.interface.size() >= IFNAMSIZ || (at != std::string::npos && local.empty())) {
    *error =
        "\"" + text + "\": \"" + local + "\" is neither the name of an interface nor an address";
    return std::nullopt;
  }
  return link;
}

}  // namespace

std::optional<std::vector<BondAddress>> ParseBondAddresses(const std::string& text,
                                                           std::string* error) {
  std::vector<BondAddress> links;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    auto link = ParseOne(Trim(part), error);
    if (!link) return std::nullopt;
    const bool twice = std::any_of(links.begin(), links.end(),
                                   [&](const BondAddress& l) { return l.text == link->text; });
    if (twice) *error = "\"" + link->text + "\" is listed twice";
    if (twice) return std::nullopt;
    links.push_back(std::move(*link));
  }
  if (links.empty() || links.size() > bonding::kMaxLinks) {
    *error = "it must list 1 to " + std::to_string(bonding::kMaxLinks) + " links";
    return std::nullopt;
  }
  return links;
}

}  // namespace lidar::gst
