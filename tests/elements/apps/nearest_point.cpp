// SPDX-License-Identifier: LGPL-2.1-or-later
// Clouds of a pipeline in a program: prints the nearest point of each scan.
#include <gst/app/gstappsink.h>
#include <gst/lidar/gstlidarcloudinfo.h>

#include <cmath>
#include <cstdio>
#include <string>

static double nearest_point(const GstLidarCloud& cloud) {
  const GstLidarField* x = gst_lidar_cloud_info_find(&cloud.info, "x");
  const GstLidarField* y = gst_lidar_cloud_info_find(&cloud.info, "y");
  const GstLidarField* z = gst_lidar_cloud_info_find(&cloud.info, "z");
  double nearest = INFINITY;
  for (gsize i = 0; x && y && z && i < cloud.n_points; ++i) {
    const double range =
        std::hypot(gst_lidar_cloud_get(&cloud, x, i), gst_lidar_cloud_get(&cloud, y, i),
                   gst_lidar_cloud_get(&cloud, z, i));
    if (range > 0 && range < nearest) nearest = range;
  }
  return nearest;
}

static void show(GstSample* sample) {
  GstLidarCloudInfo info;
  GstLidarCloud cloud;
  GstBuffer* buffer = gst_sample_get_buffer(sample);
  if (!gst_lidar_cloud_info_from_caps(&info, gst_sample_get_caps(sample)) ||
      !gst_lidar_cloud_map(&cloud, &info, buffer, GST_MAP_READ))
    return;
  std::printf("%" G_GUINT64_FORMAT ": (%u, %u) points, the nearest at %.2f m\n",
              gst_lidar_buffer_get_capture_time(buffer), info.height, info.width,
              nearest_point(cloud));
  gst_lidar_cloud_unmap(&cloud);
}

/// Shows all scans until the end. Prints an error and returns false if an element fails: then no
/// sample comes.
static bool show_all(GstElement* pipeline) {
  GstElement* sink = gst_bin_get_by_name(GST_BIN(pipeline), "sink");
  GstBus* bus = gst_element_get_bus(pipeline);
  GstMessage* failure = nullptr;
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  for (bool ended = false; !ended;) {
    GstSample* sample = gst_app_sink_try_pull_sample(GST_APP_SINK(sink), 100 * GST_MSECOND);
    if (sample != nullptr) {
      show(sample);
      gst_sample_unref(sample);
      continue;
    }
    failure = gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR);
    ended = failure != nullptr || gst_app_sink_is_eos(GST_APP_SINK(sink));
  }
  if (failure != nullptr) {
    GError* error = nullptr;
    gst_message_parse_error(failure, &error, nullptr);
    std::fprintf(stderr, "%s\n", error->message);
    g_error_free(error);
    gst_message_unref(failure);
  }
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(bus);
  gst_object_unref(sink);
  return failure == nullptr;
}

int main(int argc, char** argv) {
  gst_init(&argc, &argv);
  gst_lidar_init();
  const std::string source = argc > 1 ? argv[1] : "";
  GError* error = nullptr;
  GstElement* pipeline =
      gst_parse_launch((source + " ! appsink name=sink sync=false").c_str(), &error);
  // If an element is missing, there are both an error and a pipeline of the other elements.
  const bool ended = error == nullptr && show_all(pipeline);
  if (error != nullptr) {
    std::fprintf(stderr, "%s\n", error->message);
    g_error_free(error);
  }
  if (pipeline != nullptr) gst_object_unref(pipeline);
  return ended ? 0 : 1;
}
