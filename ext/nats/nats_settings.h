// SPDX-License-Identifier: LGPL-2.1-or-later
// Settings and messages that natssink and natssrc share.
#pragma once
#include <gst/gst.h>

#include <mutex>
#include <set>
#include <string>

#include "ext/nats/connection.h"
#include "gst/common/properties.h"
#include "gst/common/refs.h"

namespace lidar::gst {

struct NatsSettings {
  nats::ConnectionSettings connection;
  std::string subject = "lidar";
  std::string stream;
  std::string queue_group;
  std::string durable;
};

const std::array<Property<NatsSettings>, 8>& NatsRows();

/// Checks the settings, and names the connection after the element. If a setting is wrong, posts an
/// error message that names the setting and returns false.
bool CheckNatsSettings(GstElement* element, NatsSettings* settings);

/// Posts changes of a connection on the bus of an element: the message nats-connection-changed, a
/// warning if the server complains, and an error if the server refuses the client.
class ConnectionWatch {
 public:
  /// If `keeps_trying` is set, a refusal by the server gives a warning instead of an error.
  ConnectionWatch(GstElement* element, bool keeps_trying)
      : element_(GST_ELEMENT(gst_object_ref(element))), keeps_trying_(keeps_trying) {}
  /// These three functions may be called by any thread.
  void Note(const nats::ConnectionState& state);
  void Warn(const std::string& text);
  void PostRefused(const nats::ConnectionState& state);
  /// Posts nothing from now on, because the element stops.
  void Silence();

 private:
  const ElementPtr element_;  // owned, because libnats may call Note() after the stop
  const bool keeps_trying_;
  std::mutex mutex_;
  bool silent_ = false;
  bool connected_ = false;
  bool closed_ = false;
  std::uint64_t errors_ = 0;
  std::set<std::string> complaints_;  // texts that were posted for this connection
};

}  // namespace lidar::gst
