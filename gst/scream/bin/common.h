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

/// Valid from READY to NULL. `mutex` guards the members, and is not held during calls into
/// children.
struct BinState {
  std::mutex mutex;
  SocketInUse used;
  std::shared_ptr<SrtpLayer> srtp;
  std::string srtp_key;  // value of the property when the key was read
};

/// Creates a child with its factory's name and adds it. Returns NULL if the plugin is missing.
GstElement* AddChild(GstElement* bin, const char* factory);
struct Child {
  GstElement* element;
  const char* factory;
};
/// Returns false, with an error on the bus, if one of `children` is missing.
bool HasChildren(GstElement* bin, std::initializer_list<Child> children);
/// Sets a child's socket (NULL: none), which the child does not own.
void GiveSocket(GstElement* child, GSocket* socket);
/// Starts and stops DTLS with PLAYING.
void PlaySrtp(BinState& state, GstStateChange change);
/// Removes the layer's elements from the bin.
void EndSrtp(BinState& state);
/// Takes the socket from the children, ends SRTP and closes the socket. A socket of the user is
/// closed only if the user asked for it.
void CloseBin(BinState& state, std::initializer_list<GstElement*> children, bool close_given);
/// Sends a datagram through the interface (empty: by the routes), or drops it if it cannot leave at
/// once.
void SendDatagram(GSocket* socket, GSocketAddress* to, const std::string& interface,
                  GstBuffer* datagram);
/// Bytes of the UDP and IP headers of a packet to `peer`.
guint OverheadOf(GSocketAddress* peer);
/// Returns `stats` of the child, or NULL without a child. Transfer full.
StructurePtr StatsOf(GstElement* child);
/// Copies a field of the child's statistics, if there is one.
void CopyStat(GstElement* child, const char* field, GstStructure* to);

/// Returns the child that has the properties of a table's rows.
template <class Self, GstElement* Self::*child>
GObject* ChildOf(GObject* bin) {
  GstElement* element = reinterpret_cast<Self*>(bin)->*child;
  return element == nullptr ? nullptr : G_OBJECT(element);
}

/// Gives a running bin the new srtp-key. A refused key changes nothing.
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
