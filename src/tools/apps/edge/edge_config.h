// SPDX-License-Identifier: LGPL-2.1-or-later
// The settings of lidar-edge: the ports of the robots, and the destinations of their streams.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ext/nats/connection.h"

namespace lidar::edge {

struct NatsConfig {
  std::optional<nats::ConnectionSettings> connection;  // empty: no NATS
  std::string prefix = "fleet";                        // first word of all subjects
  std::string jetstream;  // name of the JetStream stream that keeps the messages; empty: none
  int replicas = 1;       // number of replicas of the stream, if the sink creates it
  std::uint64_t max_age_s = 3600;
  std::uint64_t max_bytes = 0;          // 0: no limit
  std::uint64_t buffer_size = 8 << 20;  // for each robot, limit of the bytes that wait to be sent
};

struct SsrcRange {
  std::uint32_t first = 0;
  std::uint32_t last = 0;
};

struct RobotConfig {
  std::string name;
  std::string sensor = "lidar";
  std::uint16_t port = 0;         // the robot's own port; 0: it uses the common port
  std::optional<SsrcRange> ssrc;  // SSRCs that the robot may use on the common port
  std::string srtp_key;           // file:PATH or env:NAME; empty: no SRTP
  std::string srtp_cipher = "aes-128-icm";
  std::string dtls_certificate;            // file with our certificate and its key; empty: no DTLS
  std::string dtls_peer_certificate;       // file with the robot's certificate
  std::string record;                      // pattern of file names; empty: no recording
  std::uint64_t record_max_file_size = 0;  // bytes
  std::uint64_t record_max_files = 0;
  double max_mbps = 0;  // 0: no limit
};

struct EdgeConfig {
  std::string address;     // local address to which robots send; empty: any
  std::uint16_t port = 0;  // common port of the robots that have no port of their own
  NatsConfig nats;
  std::string http_address = "127.0.0.1";
  int http_port = -1;  // -1: no server; 0: any port
  double interval_s = 5;
  std::vector<RobotConfig> robots;
};

/// Parses the configuration. If a key or its value is wrong, throws a std::runtime_error that names
/// the key.
EdgeConfig ParseEdgeConfig(const std::string& json_text);

std::string StreamSubject(const NatsConfig& nats, const RobotConfig& robot);
std::string StatisticsSubject(const NatsConfig& nats, const RobotConfig& robot);

}  // namespace lidar::edge
