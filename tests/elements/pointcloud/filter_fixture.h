// SPDX-License-Identifier: LGPL-2.1-or-later
// A fixture with a pointcloudfilter.
#pragma once
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "gst/lidar/cloud_info.h"
#include "gst/lidar/gstlidar.h"
#include "tests/support/element_bus.h"
#include "tests/support/harness.h"

namespace lidar::gst {

class Filter : public ::testing::Test {
 protected:
  /// Starts the element. `properties` has the syntax of gst-launch.
  void Start(const std::string& properties, const std::string& caps) {
    const ElementPtr filter(gst_parse_launch(("pointcloudfilter " + properties).c_str(), nullptr));
    h_.reset(gst_harness_new_with_element(filter.get(), "sink", "src"));
    bus_.emplace(h_->element);
    gst_harness_set_src_caps_str(h_.get(), caps.c_str());
  }
  std::string Error() { return bus_->Text(GST_MESSAGE_ERROR); }
  GstFlowReturn Push(const std::vector<std::uint8_t>& bytes, guint first_column = 0) {
    GstBuffer* buffer = gst_buffer_new_memdup(bytes.data(), bytes.size());
    GST_BUFFER_PTS(buffer) = 0;
    GST_BUFFER_DURATION(buffer) = GST_SECOND;
    const GstLidarSlice slice{1, 0, 2, first_column};
    gst_lidar_buffer_set_slice(buffer, &slice);
    gst_lidar_buffer_set_capture_time(buffer, 77);
    return gst_harness_push(h_.get(), buffer);
  }
  std::optional<CloudInfo> Info() {
    const CapsPtr caps(gst_pad_get_current_caps(h_->sinkpad));
    return CloudInfo::FromCaps(caps.get());
  }

  test::Harness h_;
  std::optional<test::ElementBus> bus_;
};

inline std::string CloudCaps(const std::string& fields, int step, int width, int height,
                             const std::string& more = "") {
  return "application/x-pointcloud2,width=" + std::to_string(width) +
         ",height=" + std::to_string(height) + ",point-step=" + std::to_string(step) +
         ",fields=(string)\"" + fields + "\"" + more;
}

}  // namespace lidar::gst
