// SPDX-License-Identifier: LGPL-2.1-or-later
// The common part of screamsink and screamsrc: children, their shared socket, and SRTP.
#pragma once
#include <gio/gio.h>
#include <gst/gst.h>

#include <initializer_list>
#include <memory>
#include <mutex>
#include <string>

#include "gst/common/properties.h"
#include "gst/net/udp_element.h"
#include "gst/scream/srtp/layer.h"

namespace lidar::gst {

/// The state of a bin that is in READY or above. `mutex` guards the members. It is not held during
/// calls into children.
struct BinState {
  std::mutex mutex;
  SocketInUse used;
  std::shared_ptr<SrtpLayer> srtp;
  std::string srtp_key;  // value of the property when the key was read
};

/// Creates a child, named after its factory, and adds it to the bin. Returns NULL if the plugin is
/// missing.
GstElement* AddChild(GstElement* bin, const char* factory);
struct Child {
  GstElement* element;
  const char* factory;
};
/// Returns true if all `children` exist. If one is missing, posts an error message and returns
/// false.
bool HasChildren(GstElement* bin, std::initializer_list<Child> children);
/// Sets the socket that the child uses but does not own. NULL removes the socket.
void GiveSocket(GstElement* child, GSocket* socket);
/// Starts DTLS when the bin changes to PLAYING, and stops DTLS at other state changes.
void PlaySrtp(BinState& state, GstStateChange change);
/// Ends the SRTP layer, which removes its elements from the bin.
void EndSrtp(BinState& state);
/// Ends SRTP, removes the socket from the children and closes the socket. A socket that the user
/// has set is closed only if `close_given` is true.
void CloseBin(BinState& state, std::initializer_list<GstElement*> children, bool close_given);
/// Sends a datagram through `interface` or, if it is empty, through the interface that the routes
/// select. Drops the datagram if it cannot be sent at once.
void SendDatagram(GSocket* socket, GSocketAddress* to, const std::string& interface,
                  GstBuffer* datagram);
/// Returns the size of the UDP and IP headers of a packet to `peer` [bytes].
guint OverheadOf(GSocketAddress* peer);
/// Returns the property stats of the child, or NULL if there is no child.
StructurePtr StatsOf(GstElement* child);
/// Copies a field of the child's statistics to `to`, if the field exists.
void CopyStat(GstElement* child, const char* field, GstStructure* to);

/// Returns the child that has the properties which a bin forwards, or null if there is no child.
template <class Self, GstElement* Self::*child>
GObject* ChildOf(GObject* bin) {
  GstElement* element = reinterpret_cast<Self*>(bin)->*child;
  return element == nullptr ? nullptr : G_OBJECT(element);
}

/// Gives a running bin the new value of srtp-key. If the key is refused, the property keeps its old
/// value.
template <class Self>
void ChangeSrtpKey(GObject* bin, GParamSpec* spec) {
  if (g_strcmp0(spec->name, "srtp-key") != 0) return;
  auto& state = *reinterpret_cast<Self*>(bin)->state;
  std::unique_lock lock(state.mutex);
  if (!state.used.socket) return;
  const std::shared_ptr<SrtpLayer> layer = state.srtp;
  const std::string key = state.settings.srtp.key;
  lock.unlock();
  const bool taken = TakeSrtpKey(GST_ELEMENT(bin), layer.get(), key);
  lock.lock();
  if (taken) state.srtp_key = key;
  state.settings.srtp.key = state.srtp_key;
}

}  // namespace lidar::gst
