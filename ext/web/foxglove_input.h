// SPDX-License-Identifier: LGPL-2.1-or-later
// The sink behind each pad of foxglovesink. It converts buffers to messages, without waiting for
// clients.
#pragma once
#include <gst/base/gstbasesink.h>

#include <memory>
#include <string>

#include "ext/web/server.h"

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_FOXGLOVE_INPUT (gst_lidar_foxglove_input_get_type())
G_DECLARE_FINAL_TYPE(GstLidarFoxgloveInput, gst_lidar_foxglove_input, GST, LIDAR_FOXGLOVE_INPUT,
                     GstBaseSink)
G_END_DECLS

namespace lidar::web {

/// The state that all inputs of an element share. It exists while the element is in a state above
/// NULL.
struct Hub {
  std::unique_ptr<Server> server;
  guint max_points = 0;
  std::atomic<guint64> clouds{0};
  std::atomic<guint64> points{0};  // points sent to clients
  std::atomic<guint64> malformed{0};
  std::atomic<guint64> scan_duration{0};  // from the newest caps; 0: unknown
};

struct InputSettings {
  std::string topic;  // empty: chosen by the kind of data
  std::string frame_id = "lidar";
  std::string recording;  // location of mcapsink's files; empty: no recording
  guint number = 0;       // number of the pad; makes topics differ
};

void SetHub(GstLidarFoxgloveInput* input, std::shared_ptr<Hub> hub);
InputSettings SettingsOf(GstLidarFoxgloveInput* input);
void SetSettings(GstLidarFoxgloveInput* input, const InputSettings& settings);

}  // namespace lidar::web
