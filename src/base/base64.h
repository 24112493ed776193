// SPDX-License-Identifier: LGPL-2.1-or-later
// Encodes bytes as Base64 text (RFC 4648, section 4), and decodes such text.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lidar {

inline constexpr std::string_view kBase64Digits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

inline std::string Base64(const std::vector<std::uint8_t>& bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = bytes.size() - i < 3 ? bytes.size() - i : 3;
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < n ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += k <= n ? kBase64Digits[group >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

/// Decodes `text`. Skips line breaks, padding and all other characters that are not Base64 digits.
inline std::vector<std::uint8_t> FromBase64(std::string_view text) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(text.size() / 4 * 3);
  constexpr std::uint8_t kNone = 64;
  std::array<std::uint8_t, 256> digits{};
  digits.fill(kNone);
  for (std::uint8_t i = 0; i < kNone; ++i) digits[static_cast<std::uint8_t>(kBase64Digits[i])] = i;
  std::uint32_t bits = 0;
  unsigned known = 0;
  for (const char c : text) {
    const std::uint8_t digit = digits[static_cast<std::uint8_t>(c)];
    if (digit == kNone) continue;
    bits = bits << 6 | digit;
    known += 6;
    if (known < 8) continue;
    known -= 8;
    bytes.push_back(static_cast<std::uint8_t>(bits >> known));
  }
  return bytes;
}

}  // namespace lidar
