// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/srtp/key.h"

#include <glib.h>

#include <array>

namespace lidar::gst {
namespace {

struct Cipher {
  const char* name;
  std::size_t key_size;
  bool authenticates;  // needs no HMAC
};
constexpr std::array<Cipher, 4> kCiphers = {{{"aes-128-icm", 30, false},
                                             {"aes-256-icm", 46, false},
                                             {"aes-128-gcm", 28, true},
                                             {"aes-256-gcm", 44, true}}};

const Cipher* FindCipher(const std::string& name) {
  for (const Cipher& c : kCiphers)
    if (name == c.name) return &c;
  return nullptr;
}

bool ReadText(const std::string& source, std::string* text, std::string* error) {
  if (source.rfind("env:", 0) == 0) {
    const gchar* value = g_getenv(source.c_str() + 4);
    if (value == nullptr) {
      *error = "the environment has no variable " + source.substr(4);
      return false;
    }
    *text = value;
  } else if (source.rfind("file:", 0) == 0) {
    gchar* content = nullptr;
    GError* problem = nullptr;
    if (!g_file_get_contents(source.c_str() + 5, &content, nullptr, &problem)) {
      *error = problem->message;
      g_error_free(problem);
      return false;
    }
    *text = content;
    g_free(content);
  } else {
    *text = source;
  }
  while (!text->empty() && g_ascii_isspace(text->back())) text->pop_back();
  return true;
}

}  // namespace

std::optional<SrtpPolicy> SrtpPolicyOf(const SrtpSettings& settings, std::string* error) {
  const Cipher* cipher = FindCipher(settings.cipher);
  if (cipher == nullptr) {
    *error = "srtp-cipher must be aes-128-icm, aes-256-icm, aes-128-gcm or aes-256-gcm";
    return std::nullopt;
  }
  const bool is_short = settings.auth == "hmac-sha1-32";
  if (!is_short && settings.auth != "hmac-sha1-80") {
    *error = "srtp-auth must be hmac-sha1-80 or hmac-sha1-32";
    return std::nullopt;
  }
  if (cipher->authenticates) return SrtpPolicy{cipher->name, "null", "null", cipher->key_size, 16};
  // RFC 3711 has no short tag for SRTCP.
  return SrtpPolicy{cipher->name, settings.auth, "hmac-sha1-80", cipher->key_size,
                    is_short ? 4U : 10U};
}

std::optional<SrtpKey> ReadSrtpKey(const std::string& source, const SrtpPolicy& policy,
                                   std::string* error) {
  std::string text;
  if (!ReadText(source, &text, error)) return std::nullopt;
  SrtpKey key;
  bool hex = text.size() == 2 * policy.key_size;
  for (std::size_t i = 0; hex && i < text.size(); i += 2) {
    const int high = g_ascii_xdigit_value(text[i]);
    const int low = g_ascii_xdigit_value(text[i + 1]);
    hex = high >= 0 && low >= 0;
    key.push_back(static_cast<std::uint8_t>(16 * high + low));
  }
  if (hex) return key;
  *error = "the SRTP key must be " + std::to_string(2 * policy.key_size) +
           " hexadecimal digits (master key and salt) for " + policy.cipher;
  return std::nullopt;
}

}  // namespace lidar::gst
