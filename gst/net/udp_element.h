// SPDX-License-Identifier: LGPL-2.1-or-later
// The common part of elements with a UDP socket: addresses, errors and properties.
#pragma once
#include <gst/gst.h>

#include <memory>
#include <string>

#include "gst/common/properties.h"
#include "gst/net/udp_socket.h"

namespace lidar::gst {

using SharedSocket = std::shared_ptr<GSocket>;
using SharedSocketAddress = std::shared_ptr<GSocketAddress>;
template <>
inline GType GTypeOf<GSocket>() {
  return G_TYPE_SOCKET;
}
template <>
inline GType GTypeOf<GSocketAddress>() {
  return G_TYPE_SOCKET_ADDRESS;
}

/// The local address at which datagrams are received.
struct UdpListen {
  std::string address;
  guint port = 5004;
  std::string multicast_group;
  std::string multicast_iface;
};
/// The destination of datagrams, and the local address from which they are sent.
struct UdpTarget {
  std::string host = "127.0.0.1";
  guint port = 5004;
  std::string bind_address;
  guint bind_port = 0;
};
/// A socket that the application has set.
struct GivenSocket {
  SharedSocket socket;
  bool close = true;  // when the element stops
};
/// The socket in use. The application may have set another socket since the element started.
struct SocketInUse {
  SharedSocket socket;
  bool given = false;

  /// Closes the socket and forgets it. A socket that the application has set is closed only if
  /// `close_given` is true.
  void Close(bool close_given);
};

/// Options of the UDP elements. The bins that contain these elements do not store the options, but
/// forward them.
struct UdpOptions {
  gint dscp = -1;         // of a sink
  guint buffer_size = 0;  // bytes; of a source, like the members below
  Duration timeout{};
  SharedCaps caps;
};

// The rows of properties that elements and bins share.
const std::array<Property<UdpListen>, 4>& UdpListenRows();
const std::array<Property<UdpTarget>, 4>& UdpTargetRows();
const std::array<Property<UdpOptions>, 4>& UdpOptionRows();

// These functions post an error message and return NULL if they fail.
SharedSocket OpenListening(GstElement* element, const UdpListen& listen);
SharedSocketAddress ResolveTarget(GstElement* element, const UdpTarget& target);
SharedSocket OpenSending(GstElement* element, const UdpTarget& target, GSocketFamily family);

/// Returns the socket that the application has set or, if there is none, the socket that `open`
/// opens. The socket is NULL if that fails.
template <class Open>
SocketInUse TakeSocket(const GivenSocket& given, Open open) {
  if (given.socket) return {given.socket, true};
  return {open(), false};
}

/// The getter of the property used-socket. The state of the element must have `used`, and the mutex
/// that guards it.
template <class Self>
SharedSocket UsedSocket(GObject* object) {
  auto& state = *reinterpret_cast<Self*>(object)->state;
  const LockIf lock(true, state.mutex);
  return state.used.socket;
}

/// Installs the methods unlock and unlock_stop of GstBaseSink or GstBaseSrc, which set and clear
/// the state's `wake`.
template <class Self, class Base, class Class>
void WakeOnUnlock(Class* klass) {
  klass->unlock = [](Base* base) -> gboolean {
    reinterpret_cast<Self*>(base)->state->wake.Wake();
    return TRUE;
  };
  klass->unlock_stop = [](Base* base) -> gboolean {
    reinterpret_cast<Self*>(base)->state->wake.Clear();
    return TRUE;
  };
}

}  // namespace lidar::gst
