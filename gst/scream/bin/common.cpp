// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/bin/common.h"

#include <sys/socket.h>
#include <sys/uio.h>

#include "gst/common/buffer_map.h"
#include "gst/net/datagram.h"

namespace lidar::gst {

GstElement* AddChild(GstElement* bin, const char* factory) {
  GstElement* child = gst_element_factory_make(factory, factory);
  if (child != nullptr) gst_bin_add(GST_BIN(bin), child);
  return child;
}

bool HasChildren(GstElement* bin, std::initializer_list<Child> children) {
  for (const Child& child : children) {
    if (child.element != nullptr) continue;
    GST_ELEMENT_ERROR(bin, CORE, MISSING_PLUGIN, ("The element %s is missing.", child.factory),
                      ("check the installation with: gst-inspect-1.0 %s", child.factory));
    return false;
  }
  return true;
}

void GiveSocket(GstElement* child, GSocket* socket) {
  g_object_set(child, "socket", socket, "close-socket", FALSE, nullptr);
}

void PlaySrtp(BinState& state, GstStateChange change) {
  const GstState next = GST_STATE_TRANSITION_NEXT(change);
  std::unique_lock lock(state.mutex);
  const std::shared_ptr<SrtpLayer> srtp = state.srtp;
  lock.unlock();
  if (srtp) srtp->SetPlaying(next == GST_STATE_PLAYING);
}

void EndSrtp(BinState& state) {
  std::unique_lock lock(state.mutex);
  const std::shared_ptr<SrtpLayer> srtp = std::move(state.srtp);
  lock.unlock();  // the layer is destroyed without the lock
}

void CloseBin(BinState& state, std::initializer_list<GstElement*> children, bool close_given) {
  EndSrtp(state);
  for (GstElement* child : children)
    if (child != nullptr) GiveSocket(child, nullptr);
  const std::lock_guard lock(state.mutex);
  state.used.Close(close_given);
}

void SendDatagram(GSocket* socket, GSocketAddress* to, const std::string& interface,
                  GstBuffer* datagram) {
  const int fd = g_socket_get_fd(socket);
  const unsigned index = interface.empty() ? 0 : net::InterfaceIndex(fd, interface);
  const BufferMap map(datagram, GST_MAP_READ);
  if (!map || (index == 0 && !interface.empty())) return;
  NativeAddress address = ToNative(to, g_socket_get_family(socket));
  iovec bytes{const_cast<guint8*>(map.data()), map.size()};
  msghdr message{};
  message.msg_name = address.get();
  message.msg_namelen = address.length;
  message.msg_iov = &bytes;
  message.msg_iovlen = 1;
  net::SendControl control;
  net::SetControl(0, address, index, &control, &message);
  sendmsg(fd, &message, MSG_DONTWAIT | MSG_NOSIGNAL);
}

guint OverheadOf(GSocketAddress* peer) {
  constexpr guint kUdp = 8;
  return kUdp + (g_socket_address_get_family(peer) == G_SOCKET_FAMILY_IPV6 ? 40 : 20);
}

StructurePtr StatsOf(GstElement* child) {
  GstStructure* stats = nullptr;
  if (child != nullptr) g_object_get(child, "stats", &stats, nullptr);
  return StructurePtr(stats);
}

void CopyStat(GstElement* child, const char* field, GstStructure* to) {
  const StructurePtr stats = StatsOf(child);
  const GValue* value = stats ? gst_structure_get_value(stats.get(), field) : nullptr;
  if (value != nullptr) gst_structure_set_value(to, field, value);
}

}  // namespace lidar::gst
