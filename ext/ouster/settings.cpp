// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/ouster/settings.h"

#include "gst/common/enum_type.h"

namespace lidar::gst {
namespace {

using S = OusterSettings;

}  // namespace

GType OusterReturnType() {
  static const GEnumValue values[] = {{kReturnStrongest, "The strongest return", "strongest"},
                                      {kReturnSecond, "The second strongest return", "second"},
                                      {kReturnBoth, "Both: adds range2, intensity2", "both"},
                                      {0, nullptr, nullptr}};
  static const GType type = RegisterEnum("GstLidarOusterReturn", values);
  return type;
}

GType OusterPtsFromType() {
  static const GEnumValue values[] = {
      {kPtsFromSensor, "The sensor's sampling times, without the network's jitter", "sensor"},
      {kPtsFromArrival, "The arrival of the slice's first packet", "arrival"},
      {0, nullptr, nullptr}};
  static const GType type = RegisterEnum("GstLidarOusterPtsFrom", values);
  return type;
}

GType OusterInvalidType() {
  static const GEnumValue values[] = {{kInvalidZero, "x, y and z are zero", "zero"},
                                      {kInvalidNan, "x, y and z are not a number", "nan"},
                                      {0, nullptr, nullptr}};
  static const GType type = RegisterEnum("GstLidarOusterInvalid", values);
  return type;
}

const std::array<Property<S>, 31> kOusterProperties = {{
    {"location", "Capture file (pcap, pcapng) to read instead of receiving", &S::location},
    {"metadata", "Metadata JSON of the sensor; empty: with location, the .json beside it",
     &S::metadata},
    {"is-live", "With location: play packets at the pace of their capture", &S::is_live},
    {"loop", "With location: start over at the end of the file", &S::loop},
    {"hostname",
     "Sensor to ask for its metadata, as os1.local, 192.0.2.7 or fe80::1%eth0; empty: ask none",
     &S::hostname},
    {"reconnect", "Wait for a sensor that does not answer; false: post an error", &S::reconnect},
    {"lidar-port",
     "UDP port of the lidar packets, set on the sensor if hostname is given; 0: as in the metadata",
     &S::lidar_port, 0, 65535},
    {"imu-port",
     "UDP port of the IMU packets, set on the sensor if hostname is given; 0: as in the metadata",
     &S::imu_port, 0, 65535},
    {"imu", "Receive IMU packets, for the pad imu", &S::imu},
    {"udp-dest",
     "Destination address to set on the sensor; @auto: this machine's; empty: unchanged",
     &S::udp_dest},
    {"lidar-mode", "Lidar mode to set on the sensor, as 1024x10; empty: unchanged", &S::lidar_mode},
    {"udp-profile-lidar",
     "Packet profile to set on the sensor, as RNG19_RFL8_SIG16_NIR16; empty: unchanged",
     &S::udp_profile_lidar},
    {"sensor-timestamp-mode",
     "Timestamp mode to set on the sensor, as TIME_FROM_PTP_1588; empty: unchanged",
     &S::sensor_timestamp_mode},
    {"azimuth-window",
     "Azimuth window to set on the sensor [millidegrees], as 180000,360000; empty: unchanged",
     &S::azimuth_window},
    {"signal-multiplier",
     "Signal multiplier to set on the sensor: 0.25, 0.5, 1, 2 or 3; 0: unchanged",
     &S::signal_multiplier, 0, 3},
    {"address", "Local address to receive on; empty for any, IPv6 and IPv4", &S::address},
    {"multicast-group", "Multicast group that the sensor sends to; empty for none",
     &S::multicast_group},
    {"multicast-iface", "Network interface for multicast; empty: the kernel chooses it",
     &S::multicast_iface},
    {"buffer-size", "Receive buffer to ask the kernel for [bytes]; 0: the kernel's default",
     &S::buffer_size, 0, G_MAXINT},
    {"slices-per-scan",
     "Buffers a scan; 0: automatic, a sweep of about 12.5 ms; rounded down to a divisor of the "
     "columns",
     &S::slices_per_scan, 0, 4096},
    {"channels",
     "Extra fields of a point, comma-separated: reflectivity, signal, near-ir, flags, window, "
     "ring, t (ns since the slice's first column)",
     &S::channels},
    {"return", "Return to use of a dual-return profile",
     EnumField<S>{&S::returns, OusterReturnType}},
    {"pts-from", "Clock that timestamps follow", EnumField<S>{&S::pts_from, OusterPtsFromType}},
    {"ptp-utc-tai-offset", "Offset from PTP time (TAI) to UTC [s]; 0 if the PTP master gives UTC",
     &S::ptp_utc_tai_offset, -100, 100},
    {"min-range", "Nearer returns count as missing [m]", &S::min_range, 0, 1000},
    {"max-range", "Farther returns count as missing [m]; 0 for no limit", &S::max_range, 0, 1000},
    {"azimuth-sectors",
     "Sectors to keep [degrees in the sensor frame, from x towards y], as 0-90,270-360; empty: all",
     &S::azimuth_sectors},
    {"mask-location", "Destaggered PGM image, beams x columns: returns at black pixels are removed",
     &S::mask_location},
    {"invalid", "Values of points without a return", EnumField<S>{&S::invalid, OusterInvalidType}},
    {"destagger",
     "Shift beams so that each column of the buffer is one direction; gives whole scans without a "
     "sensor model",
     &S::destagger},
    {"stats", "Counters of packets, slices and errors", OusterStats},
}};

std::string OusterSettings::MetadataPath() const {
  if (!metadata.empty() || location.empty()) return metadata;
  const std::size_t dot = location.find_last_of("./");
  const bool has_extension = dot != std::string::npos && location[dot] == '.';
  return (has_extension ? location.substr(0, dot) : location) + ".json";
}

std::optional<ouster::StreamOptions> ToStreamOptions(const OusterSettings& s, std::string* error) {
  ouster::StreamOptions options;
  auto channels = ouster::ParseChannels(s.channels, error);
  if (!channels) return std::nullopt;
  options.points.channels = *std::move(channels);
  auto sectors = ouster::ParseSectors(s.azimuth_sectors);
  if (!sectors) {
    *error = "azimuth-sectors must be like \"0-90,270-360\" [degrees]";
    return std::nullopt;
  }
  options.points.sectors = *std::move(sectors);
  if (s.max_range > 0 && s.max_range <= s.min_range) {
    *error = "max-range must be above min-range";
    return std::nullopt;
  }
  options.points.returns = static_cast<ouster::Return>(s.returns);
  options.points.min_range_m = s.min_range;
  options.points.max_range_m = s.max_range;
  options.points.destagger = s.destagger;
  options.points.invalid = static_cast<ouster::Invalid>(s.invalid);
  options.slices_per_scan = s.slices_per_scan;
  options.times =
      s.pts_from == kPtsFromArrival ? ouster::TimeSource::kArrival : ouster::TimeSource::kSensor;
  options.clock = s.live() ? ouster::ClockMapper::Mode::kFollow : ouster::ClockMapper::Mode::kHold;
  options.ptp_utc_offset = FromSeconds(s.ptp_utc_tai_offset);
  return options;
}

}  // namespace lidar::gst
