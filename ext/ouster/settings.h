// SPDX-License-Identifier: LGPL-2.1-or-later
// The properties of ouster_src.
#pragma once
#include <gst/gst.h>

#include <optional>
#include <string>

#include "gst/common/properties.h"
#include "gst/common/refs.h"
#include "src/ouster/sensor_stream.h"

namespace lidar::gst {

enum GstLidarOusterReturn { kReturnStrongest, kReturnSecond, kReturnBoth };
enum GstLidarOusterPtsFrom { kPtsFromSensor, kPtsFromArrival };
enum GstLidarOusterInvalid { kInvalidZero, kInvalidNan };

GType OusterReturnType();
GType OusterPtsFromType();
GType OusterInvalidType();

struct OusterSettings {
  std::string location;
  std::string metadata;
  bool is_live = false;
  bool loop = false;
  std::string hostname;
  bool reconnect = true;
  guint lidar_port = 0;
  guint imu_port = 0;
  bool imu = true;
  std::string udp_dest;
  std::string lidar_mode;
  std::string udp_profile_lidar;
  std::string sensor_timestamp_mode;
  std::string azimuth_window;
  gdouble signal_multiplier = 0;
  std::string address;
  std::string multicast_group;
  std::string multicast_iface;
  guint buffer_size = 8U << 20;
  guint slices_per_scan = 0;
  std::string channels;
  gint returns = kReturnStrongest;
  gint pts_from = kPtsFromSensor;
  gdouble ptp_utc_tai_offset = -37;
  gdouble min_range = 0;
  gdouble max_range = 0;
  std::string azimuth_sectors;
  std::string mask_location;
  gint invalid = kInvalidZero;
  bool destagger = false;

  /// Returns true if the source is live. It is always live for UDP, and for files if `is_live` is
  /// set.
  bool live() const { return location.empty() || is_live; }
  bool from_file() const { return !location.empty(); }
  /// Returns the path of the metadata: the property metadata, or else the path of the capture with
  /// the extension json. Returns an empty text if both properties are empty.
  std::string MetadataPath() const;
};

/// Returns the value of the property `stats`.
StructurePtr OusterStats(GObject* source);

extern const std::array<Property<OusterSettings>, 31> kOusterProperties;

/// Converts the properties. If two properties contradict each other, returns nothing and sets
/// `error` to a text for the user.
std::optional<ouster::StreamOptions> ToStreamOptions(const OusterSettings& settings,
                                                     std::string* error);

}  // namespace lidar::gst
