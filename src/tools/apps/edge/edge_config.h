// SPDX-License-Identifier: LGPL-2.1-or-later
// Settings of lidar-edge: ports of robots, and destinations of their streams.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ext/nats/connection.h"

namespace lidar::edge {

struct NatsConfig {
  std::optional<nats::ConnectionSettings> connection;  // empty: no NATS
  std::string prefix = "fleet";                        // of all subjects
  std::string jetstream;                               // stream that keeps messages; empty: none
  int replicas = 1;                                    // of the stream, if the sink creates it
  std::uint64_t max_age_s = 3600;
  std::uint64_t max_bytes = 0;          // 0: no limit
  std::uint64_t buffer_size = 8 << 20;  // most waiting bytes of a robot
};

struct SsrcRange {
  std::uint32_t first = 0;
  std::uint32_t last = 0;
};

struct RobotConfig {
  std::string name;
  std::string sensor = "lidar";
  std::uint16_t port = 0;         // own port; 0: the common one
  std::optional<SsrcRange> ssrc;  // SSRCs on the common port
  std::string srtp_key;           // file:PATH or env:NAME; empty: no SRTP
  std::string srtp_cipher = "aes-128-icm";
  std::string dtls_certificate;            // ours with its key, a file; empty: no DTLS
  std::string dtls_peer_certificate;       // the robot's
  std::string record;                      // pattern of file names; empty: no recording
  std::uint64_t record_max_file_size = 0;  // bytes
  std::uint64_t record_max_files = 0;
  double max_mbps = 0;  // 0: no limit
};

struct EdgeConfig {
  std::string address;     // to which robots send; empty: any
  std::uint16_t port = 0;  // for robots without a port of their own
  NatsConfig nats;
  std::string http_address = "127.0.0.1";
  int http_port = -1;  // -1: no server; 0: any port
  double interval_s = 5;
  std::vector<RobotConfig> robots;
};

/// Throws std::runtime_error that names the wrong key.
EdgeConfig ParseEdgeConfig(const std::string& json_text);

std::string StreamSubject(const NatsConfig& nats, const RobotConfig& robot);
std::string StatisticsSubject(const NatsConfig& nats, const RobotConfig& robot);

}  // namespace lidar::edge
