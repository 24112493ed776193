// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/apps/edge/edge_config.h"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <utility>

namespace lidar::edge {
namespace {

using nlohmann::json;

/// A JSON object whose set of keys is fixed. Any other key, such as a misspelt one, is an error.
class Section {
 public:
  Section(const json& object, std::string where) : object_(object), where_(std::move(where)) {
    if (!object.is_object()) Fail("must be an object");
  }

  void Read(const char* key, std::string* value) {
    if (const json* v = Find(key)) {
      if (!v->is_string()) Fail(key, "must be a string");
      *value = v->get<std::string>();
    }
  }
  template <class T>
  void ReadCount(const char* key, T* value, std::uint64_t min, std::uint64_t max) {
    if (const json* v = Find(key)) {
      if (!v->is_number_unsigned() || v->get<std::uint64_t>() < min ||
          v->get<std::uint64_t>() > max)
        Fail(key,
             "must be a whole number from " + std::to_string(min) + " to " + std::to_string(max));
      *value = static_cast<T>(v->get<std::uint64_t>());
    }
  }
  void ReadAmount(const char* key, double* value, double min, double max) {
    if (const json* v = Find(key)) {
      if (!v->is_number() || !(v->get<double>() >= min && v->get<double>() <= max))
        Fail(key, "must be a number from " + json(min).dump() + " to " + json(max).dump());
      *value = v->get<double>();
    }
  }
  const json* Find(const char* key) {
    known_.insert(key);
    const auto found = object_.find(key);
    return found == object_.end() ? nullptr : &*found;
  }
  void Finish() const {
    for (const auto& item : object_.items())
      if (known_.count(item.key()) == 0) Fail(item.key(), "is not a known key");
  }
  [[noreturn]] void Fail(const std::string& key, const std::string& what) const {
    throw std::runtime_error(where_ + (where_.empty() ? "" : ".") + key + " " + what);
  }

 private:
  [[noreturn]] void Fail(const std::string& what) const {
    throw std::runtime_error((where_.empty() ? "the configuration" : where_) + " " + what);
  }

  const json& object_;
  const std::string where_;
  std::set<std::string> known_;
};

/// Returns true if `text` can be a word of a NATS subject and also the value of a Prometheus label.
bool IsWord(const std::string& text) {
  const auto is_good = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_';
  };
  return !text.empty() && text.size() <= 64 && std::all_of(text.begin(), text.end(), is_good);
}

constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 50;
// A kernel filter has at most 4,096 steps, and each robot needs 3.
constexpr std::size_t kMaxSharing = 1'000;

NatsConfig ReadNats(const json& object) {
  NatsConfig nats;
  nats::ConnectionSettings& connection = nats.connection.emplace();
  Section s(object, "nats");
  s.Read("url", &connection.url);
  s.Read("credentials-file", &connection.credentials_file);
  s.Read("tls-ca-file", &connection.tls_ca_file);
  s.Read("tls-cert-file", &connection.tls_cert_file);
  s.Read("tls-key-file", &connection.tls_key_file);
  s.Read("prefix", &nats.prefix);
  s.Read("jetstream", &nats.jetstream);
  s.ReadCount("replicas", &nats.replicas, 1, 5);
  s.ReadCount("max-age", &nats.max_age_s, 0, 366 * 86'400);
  s.ReadCount("max-bytes", &nats.max_bytes, 0, kMaxBytes);
  s.ReadCount("buffer-size", &nats.buffer_size, 65'536, 1 << 30);
  s.Finish();
  if (connection.url.empty()) s.Fail("url", "is empty");
  if (!IsWord(nats.prefix)) s.Fail("prefix", "must be 1 to 64 letters, digits, - and _");
  if (!nats.jetstream.empty() && !IsWord(nats.jetstream))
    s.Fail("jetstream", "must be 1 to 64 letters, digits, - and _");
  return nats;
}

/// Parses a decimal number, or hexadecimal digits after 0x. Returns nothing for other text.
std::optional<std::uint32_t> ReadSsrc(std::string_view text) {
  const bool hex = text.substr(0, 2) == "0x";
  if (hex) text.remove_prefix(2);
  std::uint32_t value = 0;
  const auto end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value, hex ? 16 : 10);
  return result.ec == std::errc() && result.ptr == end ? std::optional(value) : std::nullopt;
}

/// Parses a range of SSRCs, which is "FIRST-LAST" or a single SSRC.
std::optional<SsrcRange> ReadSsrcs(const std::string& text) {
  const auto dash = text.find('-');
  const auto first = ReadSsrc(std::string_view(text).substr(0, dash));
  const auto last = dash == text.npos ? first : ReadSsrc(std::string_view(text).substr(dash + 1));
  if (!first || !last || *last < *first) return std::nullopt;
  return SsrcRange{*first, *last};
}

void ReadPlace(Section* s, RobotConfig* robot) {
  std::string ssrc;
  s->ReadCount("port", &robot->port, 1, 65'535);
  s->Read("ssrc", &ssrc);
  if (!ssrc.empty()) {
    robot->ssrc = ReadSsrcs(ssrc);
    if (!robot->ssrc) s->Fail("ssrc", "must be a number, or two numbers FIRST-LAST");
    if (robot->port != 0) s->Fail("ssrc", "cannot be set together with port");
  } else if (robot->port == 0) {
    s->Fail("port", "or ssrc must be set");
  }
}

void ReadSecurity(Section* s, RobotConfig* robot) {
  s->Read("srtp-key", &robot->srtp_key);
  s->Read("srtp-cipher", &robot->srtp_cipher);
  s->Read("dtls-certificate", &robot->dtls_certificate);
  s->Read("dtls-peer-certificate", &robot->dtls_peer_certificate);
  if (robot->dtls_certificate.empty() != robot->dtls_peer_certificate.empty())
    s->Fail("dtls-certificate", "and dtls-peer-certificate must be set together");
  if (robot->dtls_certificate.empty()) return;
  if (!robot->srtp_key.empty()) s->Fail("srtp-key", "cannot be set together with dtls-certificate");
  if (robot->ssrc)
    s->Fail("dtls-certificate", "needs port instead of ssrc: DTLS packets have no SSRC");
}

RobotConfig ReadRobot(const json& object, std::size_t index) {
  RobotConfig robot;
  Section s(object, "robots[" + std::to_string(index) + "]");
  s.Read("name", &robot.name);
  s.Read("sensor", &robot.sensor);
  ReadPlace(&s, &robot);
  ReadSecurity(&s, &robot);
  s.Read("record", &robot.record);
  s.ReadCount("record-max-file-size", &robot.record_max_file_size, 0, kMaxBytes);
  s.ReadCount("record-max-files", &robot.record_max_files, 0, 1'000'000);
  s.ReadAmount("max-mbps", &robot.max_mbps, 0, 1e5);
  s.Finish();
  if (!IsWord(robot.name)) s.Fail("name", "must be 1 to 64 letters, digits, - and _");
  if (!IsWord(robot.sensor)) s.Fail("sensor", "must be 1 to 64 letters, digits, - and _");
  const bool limited = robot.record_max_files > 0 || robot.record_max_file_size > 0;
  if ((limited || !robot.record.empty()) && robot.record.find('%') == std::string::npos)
    s.Fail("record", "must have a number such as %05d: each session writes new files");
  return robot;
}

void CheckTwins(const std::vector<RobotConfig>& robots) {
  std::set<std::uint16_t> ports;
  std::set<std::string> names;
  std::set<std::string> records;
  for (const RobotConfig& robot : robots) {
    if (robot.port != 0 && !ports.insert(robot.port).second)
      throw std::runtime_error("port " + std::to_string(robot.port) + " is used by two robots");
    if (!names.insert(robot.name + "/" + robot.sensor).second)
      throw std::runtime_error(robot.name + " has two sensors called " + robot.sensor);
    if (!robot.record.empty() && !records.insert(robot.record).second)
      throw std::runtime_error("record " + robot.record + " is used by two robots");
  }
}

void CheckSharedPort(const EdgeConfig& config) {
  std::vector<const RobotConfig*> sharing;
  for (const RobotConfig& robot : config.robots) {
    if (robot.ssrc) sharing.push_back(&robot);
    if (robot.port != 0 && robot.port == config.port)
      throw std::runtime_error("port " + std::to_string(robot.port) +
                               " is the shared port and also the port of " + robot.name);
  }
  if (sharing.empty() != (config.port == 0))
    throw std::runtime_error(sharing.empty() ? "port is set, but no robot has an ssrc"
                                             : "port must be set, because robots have an ssrc");
  if (sharing.size() > kMaxSharing)
    throw std::runtime_error("at most " + std::to_string(kMaxSharing) + " robots can share a port");
  std::sort(sharing.begin(), sharing.end(), [](const RobotConfig* a, const RobotConfig* b) {
    return a->ssrc->first < b->ssrc->first;
  });
  for (std::size_t i = 1; i < sharing.size(); ++i)
    if (sharing[i]->ssrc->first <= sharing[i - 1]->ssrc->last)
      throw std::runtime_error(sharing[i - 1]->name + " and " + sharing[i]->name +
                               " have overlapping ssrc");
}

/// Checks that the JetStream stream has room for all data that the robots may send within max-age.
/// A full stream drops its oldest messages, so one robot could otherwise displace the messages of
/// other robots.
void CheckShares(const EdgeConfig& config) {
  const NatsConfig& nats = config.nats;
  if (nats.jetstream.empty() || nats.max_bytes == 0) return;
  if (nats.max_age_s == 0)
    throw std::runtime_error("nats.max-bytes needs nats.max-age: without it the stream fills up");
  double mbps = 0;
  for (const RobotConfig& robot : config.robots) {
    if (robot.max_mbps == 0)
      throw std::runtime_error("with nats.max-bytes every robot needs max-mbps: " + robot.name +
                               " has none");
    mbps += robot.max_mbps;
  }
  const double needed = mbps * 125'000 * static_cast<double>(nats.max_age_s);
  if (needed > static_cast<double>(nats.max_bytes))
    throw std::runtime_error("nats.max-bytes must be at least " +
                             std::to_string(static_cast<std::uint64_t>(needed)) +
                             ", the bytes that all robots may send in max-age");
}

}  // namespace

EdgeConfig ParseEdgeConfig(const std::string& json_text) {
  const json root = json::parse(json_text, nullptr, false, true);
  if (root.is_discarded()) throw std::runtime_error("the configuration is not JSON");
  EdgeConfig config;
  Section s(root, "");
  s.Read("address", &config.address);
  s.ReadCount("port", &config.port, 1, 65'535);
  if (const json* nats = s.Find("nats")) config.nats = ReadNats(*nats);
  s.Read("http-address", &config.http_address);
  s.ReadCount("http-port", &config.http_port, 0, 65'535);
  s.ReadAmount("interval", &config.interval_s, 0.1, 3600);
  const json* robots = s.Find("robots");
  s.Finish();
  if (robots == nullptr || !robots->is_array() || robots->empty())
    s.Fail("robots", "must be a list of at least one robot");
  for (std::size_t i = 0; i < robots->size(); ++i)
    config.robots.push_back(ReadRobot((*robots)[i], i));
  CheckTwins(config.robots);
  CheckSharedPort(config);
  CheckShares(config);
  return config;
}

std::string StreamSubject(const NatsConfig& nats, const RobotConfig& robot) {
  return nats.prefix + "." + robot.name + ".lidar." + robot.sensor;
}

std::string StatisticsSubject(const NatsConfig& nats, const RobotConfig& robot) {
  return nats.prefix + "." + robot.name + ".statistics." + robot.sensor;
}

}  // namespace lidar::edge
