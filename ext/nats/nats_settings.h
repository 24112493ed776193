// SPDX-License-Identifier: LGPL-2.1-or-later
// What natssink and natssrc have in common: how they reach a server, and what they tell of it.
#pragma once
#include <gst/gst.h>

#include <mutex>
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

/// With the element's name. False after an error message that names the setting that is wrong.
bool CheckNatsSettings(GstElement* element, NatsSettings* settings);

/// Posts what becomes of a connection: the message nats-connection-changed, warnings where the
/// server complains, and an error where it refuses us.
class ConnectionWatch {
 public:
  /// `keeps_trying`: a server that refuses us is a warning.
  ConnectionWatch(GstElement* element, bool keeps_trying)
      : element_(GST_ELEMENT(gst_object_ref(element))), keeps_trying_(keeps_trying) {}
  /// Runs in any thread.
  void Note(const nats::ConnectionState& state);
  void Warn(const std::string& text);
  void PostRefused(const nats::ConnectionState& state);
  /// Nothing is posted any more: the element stops by itself.
  void Silence();

 private:
  const ElementPtr element_;  // threads of libnats may still be here when it stops
  const bool keeps_trying_;
  std::mutex mutex_;
  bool silent_ = false;
  bool connected_ = false;
  bool closed_ = false;
  std::uint64_t errors_ = 0;
};

}  // namespace lidar::gst
