// SPDX-License-Identifier: LGPL-2.1-or-later
// The layout of lidar packets, as a table of profiles that the parser and the writer share.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace lidar::ouster {

/// The values of `udp_profile_lidar`.
enum class Profile {
  kLegacy,
  kRng19Rfl8Sig16Nir16,
  kRng19Rfl8Sig16Nir16Dual,
  kRng15Rfl8Nir8,
  kRng15Rfl8Nir8Dual,
  kFusaRng15Rfl8Nir8Dual,
  kRng15Rfl8Win8,
  kRng15Rfl8Nir8Zone16,
  kRng19Rfl8Sig16Nir16Zone16,
  kRng19Rfl8Sig16Zone16Dual,
  kRng19Rfl8Sig16Nir16Rgb16,
  kRng19Rfl8Sig16Nir16Rgb16Dual,
  kFiveWordPixel,
  kOff,
};
constexpr std::size_t kProfileCount = 14;

/// The values of `header_type`. LEGACY packets have no header.
enum class HeaderType { kStandard, kFusa };

/// The channels of a pixel. R, G and B are half-precision floats; all others are integers.
enum class Channel {
  kRange,
  kReflectivity,
  kSignal,
  kNearIr,
  kFlags,
  kRange2,
  kReflectivity2,
  kSignal2,
  kFlags2,
  kWindow,
  kZoneMask,
  kRed,
  kGreen,
  kBlue,
};
constexpr std::size_t kChannelCount = 14;

/// The position of a channel in a pixel. No channel crosses the boundary of a 32-bit word.
struct ChannelBits {
  Channel channel;
  std::uint8_t first_bit;  // counted from the least significant bit of the pixel's first byte
  std::uint8_t bits;
  std::uint8_t scale_shift = 0;  // number of low bits of the value that are not in the packet
};

/// The channels of a pixel, in the order of their first bits.
struct PixelLayout {
  const ChannelBits* first = nullptr;
  std::size_t count = 0;
  std::uint32_t bytes = 0;

  const ChannelBits* begin() const { return first; }
  const ChannelBits* end() const { return first + count; }
  /// Returns null if the profile does not have the channel.
  const ChannelBits* Find(Channel channel) const;
};

std::string_view ToString(Profile profile);
/// Returns nothing if the table has no profile of this name.
std::optional<Profile> ProfileFromString(std::string_view name);
std::string_view ToString(Channel channel);
PixelLayout LayoutOf(Profile profile);

/// The offsets and sizes in a lidar packet [bytes].
struct PacketFormat {
  Profile profile = Profile::kLegacy;
  HeaderType header = HeaderType::kStandard;
  std::uint32_t beams = 0;
  std::uint32_t columns_per_packet = 0;

  bool is_legacy() const { return profile == Profile::kLegacy; }
  bool is_fusa() const { return header == HeaderType::kFusa && !is_legacy(); }
  std::size_t packet_header_size() const { return is_legacy() ? 0 : 32; }
  std::size_t packet_footer_size() const { return is_legacy() ? 0 : 32; }
  std::size_t column_header_size() const { return is_legacy() ? 16 : 12; }
  std::size_t column_footer_size() const { return is_legacy() ? 4 : 0; }
  std::size_t pixel_size() const { return LayoutOf(profile).bytes; }
  std::size_t column_size() const {
    return column_header_size() + beams * pixel_size() + column_footer_size();
  }
  /// Returns 0 for the profile OFF.
  std::size_t packet_size() const;
  /// Frame ids are counted modulo this number.
  std::uint64_t frame_id_modulus() const { return std::uint64_t{1} << (is_fusa() ? 32 : 16); }
  /// The unit of the range channels [mm].
  std::uint32_t range_unit_mm() const;
  bool has_second_return() const;

  static constexpr std::size_t kMaxPacketSize = 65507;  // greatest payload of UDP over IPv4
};

/// The offsets in the header of a packet that is not LEGACY [bytes].
struct HeaderLayout {
  std::uint8_t type_bytes;  // size of the type, which is at offset 0
  std::uint8_t frame_id, frame_id_bytes;
  std::uint8_t init_id;  // this field has 3 bytes
  std::uint8_t serial;   // this field has 5 bytes
};
constexpr HeaderLayout kStandardHeader{2, 2, 2, 4, 7};
constexpr HeaderLayout kFusaHeader{1, 4, 4, 1, 11};
constexpr std::uint16_t kLidarPacketType = 1;

}  // namespace lidar::ouster
