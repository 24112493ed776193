// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/net/udp_element.h"

#include "gst/common/refs.h"

namespace lidar::gst {
namespace {

SharedSocket Share(GSocket* socket) { return SharedSocket(socket, GObjectUnref{}); }

void FailToListen(GstElement* element, const UdpListen& listen, const GError* error) {
  const bool taken = g_error_matches(error, G_IO_ERROR, G_IO_ERROR_ADDRESS_IN_USE) != FALSE;
  GST_ELEMENT_ERROR(
      element, RESOURCE, OPEN_READ,
      ("Cannot receive on UDP port %u: %s.", listen.port, error->message),
      ("address '%s', multicast-group '%s'%s", listen.address.c_str(),
       listen.multicast_group.c_str(), taken ? "; is another program using the port?" : ""));
}

void FailToSend(GstElement* element, const char* what, const UdpTarget& t, const GError* error) {
  GST_ELEMENT_ERROR(element, RESOURCE, OPEN_WRITE, ("%s: %s.", what, error->message),
                    ("host %s port %u bind-address '%s' bind-port %u", t.host.c_str(), t.port,
                     t.bind_address.c_str(), t.bind_port));
}

}  // namespace

const std::array<Property<UdpListen>, 4>& UdpListenRows() {
  static const std::array<Property<UdpListen>, 4> rows = {{
      {"address", "Local address to receive on; empty for any, IPv6 and IPv4", &UdpListen::address},
      {"port", "UDP port to receive on; 0 for any free one", &UdpListen::port, 0, 65535},
      {"multicast-group", "Multicast group to join; empty for none", &UdpListen::multicast_group},
      {"multicast-iface", "Network interface for multicast; empty: the kernel chooses it",
       &UdpListen::multicast_iface},
  }};
  return rows;
}

const std::array<Property<UdpTarget>, 4>& UdpTargetRows() {
  static const std::array<Property<UdpTarget>, 4> rows = {{
      {"host", "Host to send to: a name or an address", &UdpTarget::host},
      {"port", "UDP port to send to", &UdpTarget::port, 1, 65535},
      {"bind-address", "Local address to send from; empty for any", &UdpTarget::bind_address},
      {"bind-port", "Local UDP port to send from; 0 for any", &UdpTarget::bind_port, 0, 65535},
  }};
  return rows;
}

const std::array<Property<UdpOptions>, 4>& UdpOptionRows() {
  static const std::array<Property<UdpOptions>, 4> rows = {{
      {"qos-dscp", "Differentiated services code point; -1 keeps the socket's", &UdpOptions::dscp,
       -1, 63, GST_PARAM_MUTABLE_PLAYING},
      {"buffer-size",
       "Kernel receive buffer [bytes]; 0 asks for 2 MiB and takes what the kernel grants",
       &UdpOptions::buffer_size, 0, G_MAXINT},
      {"timeout", "Silence after which a message GstEcnUdpSrcTimeout is posted [ns]; 0 for never",
       &UdpOptions::timeout, 0, static_cast<gdouble>(G_MAXINT64)},
      {"caps", "Caps of the stream; NULL: the caps that downstream wants", &UdpOptions::caps},
  }};
  return rows;
}

SharedSocket OpenListening(GstElement* element, const UdpListen& listen) {
  const bool multicast = !listen.multicast_group.empty();
  UdpBind bind{listen.address, listen.port, G_SOCKET_FAMILY_INVALID, multicast};
  if (multicast)
    bind.family = listen.multicast_group.find(':') != std::string::npos ? G_SOCKET_FAMILY_IPV6
                                                                        : G_SOCKET_FAMILY_IPV4;
  GError* error = nullptr;
  SharedSocket socket = Share(OpenUdpSocket(bind, &error));
  if (socket && multicast)
    JoinMulticast(socket.get(), listen.multicast_group, listen.multicast_iface, &error);
  if (error == nullptr) return socket;
  const ErrorPtr owner(error);
  FailToListen(element, listen, error);
  return nullptr;
}

SharedSocketAddress ResolveTarget(GstElement* element, const UdpTarget& target) {
  GError* error = nullptr;
  SharedSocketAddress peer(ResolveUdpAddress(target.host, target.port, &error), GObjectUnref{});
  const ErrorPtr owner(error);
  if (error != nullptr) FailToSend(element, "Cannot resolve the host", target, error);
  return peer;
}

SharedSocket OpenSending(GstElement* element, const UdpTarget& target, GSocketFamily family) {
  const UdpBind bind{target.bind_address, target.bind_port, family, false};
  GError* error = nullptr;
  SharedSocket socket = Share(OpenUdpSocket(bind, &error));
  const ErrorPtr owner(error);
  if (error != nullptr) FailToSend(element, "Cannot open a UDP socket", target, error);
  return socket;
}

void SocketInUse::Close(bool close_given) {
  if (socket && (!given || close_given)) g_socket_close(socket.get(), nullptr);
  *this = {};
}

}  // namespace lidar::gst
