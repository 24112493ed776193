// SPDX-License-Identifier: LGPL-2.1-or-later
// The user's SRTP settings: master key and ciphers.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lidar::gst {

struct SrtpSettings {
  std::string key;  // hex, "file:PATH" or "env:NAME"; empty: no SRTP
  std::string cipher = "aes-128-icm";
  std::string auth = "hmac-sha1-80";
  std::string dtls_certificate;  // file paths; both are set, or neither
  std::string dtls_peer_certificate;

  bool by_dtls() const { return !dtls_certificate.empty() || !dtls_peer_certificate.empty(); }
};

/// Master key and salt.
using SrtpKey = std::vector<std::uint8_t>;

/// The algorithms, by the names of srtpenc and srtpdec.
struct SrtpPolicy {
  std::string cipher;
  std::string auth;
  std::string rtcp_auth;
  std::size_t key_size;  // bytes of an SrtpKey
  unsigned overhead;     // bytes added to each RTP packet
};

/// Returns the algorithms that `settings` name. If one of them is unknown, sets `error` and returns
/// nothing.
std::optional<SrtpPolicy> SrtpPolicyOf(const SrtpSettings& settings, std::string* error);
/// Reads the key from `source`, whose form SrtpSettings::key describes. On failure, sets `error`
/// and returns nothing. The text of an error never contains the key.
std::optional<SrtpKey> ReadSrtpKey(const std::string& source, const SrtpPolicy& policy,
                                   std::string* error);

}  // namespace lidar::gst
