// SPDX-License-Identifier: LGPL-2.1-or-later
// What screamsink and screamsrc share: children by name, and a socket that two of them use.
#pragma once
#include <gio/gio.h>
#include <gst/gst.h>

#include <memory>

#include "gst/net/udp_socket.h"

namespace lidar::gst {


/// Makes a child called like its factory (`name` where given) and adds it; NULL, with an error on
/// the bus once the bin starts, where the plugin is missing.
GstElement* AddChild(GstElement* bin, const char* factory, const char* name);
/// Posts which element is missing; for the start of a bin without all its children.
void ReportMissing(GstElement* bin, const char* factory);
/// Sets the same property of `child` where it has one.
void Forward(GstElement* child, GParamSpec* spec, const GValue* value);
/// Gives `socket` to a child that does not own it.
void GiveSocket(GstElement* child, GSocket* socket);
/// The UDP and IP header bytes of a packet on `socket` to `peer`.
guint OverheadOf(GSocketAddress* peer);

}  // namespace lidar::gst
