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

/// Fills in the element's name. Returns false after an error message that names the wrong setting.
bool CheckNatsSettings(GstElement* element, NatsSettings* settings);

/// Posts the state of a connection: nats-connection-changed, warnings if the server complains, an
/// error if it refuses the client.
class ConnectionWatch {
 public:
  /// `keeps_trying`: a refusal by the server is a warning instead of an error.
  ConnectionWatch(GstElement* element, bool keeps_trying)
      : element_(GST_ELEMENT(gst_object_ref(element))), keeps_trying_(keeps_trying) {}
  /// Any thread may call these.
  void Note(const nats::ConnectionState& state);
  void Warn(const std::string& text);
  void PostRefused(const nats::ConnectionState& state);
  /// Ends all posting, because the element stops.
  void Silence();

 private:
  const ElementPtr element_;  // owned, because threads of libnats may outlive the element's stop
  const bool keeps_trying_;
  std::mutex mutex_;
  bool silent_ = false;
  bool connected_ = false;
  bool closed_ = false;
  std::uint64_t errors_ = 0;
  std::set<std::string> complaints_;  // of this connection; each gave a warning
};

}  // namespace lidar::gst
