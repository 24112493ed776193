// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/ouster/packet_format.h"

#include <algorithm>

namespace lidar::ouster {
namespace {

using C = Channel;

constexpr ChannelBits kLegacyBits[] = {{C::kRange, 0, 20},
                                       {C::kFlags, 28, 4},
                                       {C::kReflectivity, 32, 8},
                                       {C::kSignal, 48, 16},
                                       {C::kNearIr, 64, 16}};
constexpr ChannelBits kSingleBits[] = {{C::kRange, 0, 19},        {C::kFlags, 19, 5},
                                       {C::kReflectivity, 32, 8}, {C::kSignal, 48, 16},
                                       {C::kNearIr, 64, 16},      {C::kWindow, 88, 8}};
constexpr ChannelBits kDualBits[] = {{C::kRange, 0, 19},        {C::kFlags, 19, 5},
                                     {C::kReflectivity, 24, 8}, {C::kRange2, 32, 19},
                                     {C::kFlags2, 51, 5},       {C::kReflectivity2, 56, 8},
                                     {C::kSignal, 64, 16},      {C::kSignal2, 80, 16},
                                     {C::kNearIr, 96, 16},      {C::kWindow, 120, 8}};
constexpr ChannelBits kLowRateBits[] = {
    {C::kRange, 0, 15, 3}, {C::kFlags, 15, 1}, {C::kReflectivity, 16, 8}, {C::kNearIr, 24, 8, 4}};
constexpr ChannelBits kLowRateWindowBits[] = {
    {C::kRange, 0, 15, 3}, {C::kFlags, 15, 1}, {C::kReflectivity, 16, 8}, {C::kWindow, 24, 8}};
constexpr ChannelBits kLowRateDualBits[] = {{C::kRange, 0, 15, 3},      {C::kFlags, 15, 1},
                                            {C::kReflectivity, 16, 8},  {C::kNearIr, 24, 8, 4},
                                            {C::kRange2, 32, 15, 3},    {C::kFlags2, 47, 1},
                                            {C::kReflectivity2, 48, 8}, {C::kWindow, 56, 8}};
constexpr ChannelBits kLowRateZoneBits[] = {{C::kRange, 0, 15, 3},     {C::kFlags, 15, 1},
                                            {C::kReflectivity, 16, 8}, {C::kNearIr, 24, 8, 4},
                                            {C::kZoneMask, 32, 16},    {C::kWindow, 48, 8}};
constexpr ChannelBits kSingleZoneBits[] = {
    {C::kRange, 0, 19},   {C::kFlags, 19, 5},   {C::kReflectivity, 32, 8}, {C::kWindow, 40, 8},
    {C::kSignal, 48, 16}, {C::kNearIr, 64, 16}, {C::kZoneMask, 80, 16}};
constexpr ChannelBits kDualZoneBits[] = {{C::kRange, 0, 19},        {C::kFlags, 19, 5},
                                         {C::kReflectivity, 24, 8}, {C::kRange2, 32, 19},
                                         {C::kFlags2, 51, 5},       {C::kReflectivity2, 56, 8},
                                         {C::kSignal, 64, 16},      {C::kSignal2, 80, 16},
                                         {C::kZoneMask, 96, 16},    {C::kWindow, 120, 8}};
constexpr ChannelBits kRgbBits[] = {
    {C::kRange, 0, 19},   {C::kFlags, 19, 5}, {C::kReflectivity, 24, 8}, {C::kSignal, 32, 16},
    {C::kNearIr, 48, 16}, {C::kRed, 64, 16},  {C::kGreen, 80, 16},       {C::kBlue, 96, 16}};
constexpr ChannelBits kRgbDualBits[] = {
    {C::kRange, 0, 19},   {C::kFlags, 19, 5},    {C::kReflectivity, 24, 8},
    {C::kRange2, 32, 19}, {C::kFlags2, 51, 5},   {C::kReflectivity2, 56, 8},
    {C::kSignal, 64, 16}, {C::kSignal2, 80, 16}, {C::kNearIr, 96, 16},
    {C::kRed, 112, 16},   {C::kGreen, 128, 16},  {C::kBlue, 144, 16}};
constexpr ChannelBits kFiveWordBits[] = {
    {C::kRange, 0, 19},   {C::kFlags, 19, 5},    {C::kReflectivity, 24, 8},
    {C::kRange2, 32, 19}, {C::kFlags2, 51, 5},   {C::kReflectivity2, 56, 8},
    {C::kSignal, 64, 16}, {C::kSignal2, 80, 16}, {C::kNearIr, 96, 16}};

template <std::size_t N>
constexpr PixelLayout Layout(const ChannelBits (&bits)[N], std::uint32_t bytes) {
  return {bits, N, bytes};
}

struct ProfileRow {
  Profile profile;
  std::string_view name;
  PixelLayout layout;
};
constexpr std::array<ProfileRow, kProfileCount> kProfiles = {{
    {Profile::kLegacy, "LEGACY", Layout(kLegacyBits, 12)},
    {Profile::kRng19Rfl8Sig16Nir16, "RNG19_RFL8_SIG16_NIR16", Layout(kSingleBits, 12)},
    {Profile::kRng19Rfl8Sig16Nir16Dual, "RNG19_RFL8_SIG16_NIR16_DUAL", Layout(kDualBits, 16)},
    {Profile::kRng15Rfl8Nir8, "RNG15_RFL8_NIR8", Layout(kLowRateBits, 4)},
    {Profile::kRng15Rfl8Nir8Dual, "RNG15_RFL8_NIR8_DUAL", Layout(kLowRateDualBits, 8)},
    {Profile::kFusaRng15Rfl8Nir8Dual, "FUSA_RNG15_RFL8_NIR8_DUAL", Layout(kLowRateDualBits, 8)},
    {Profile::kRng15Rfl8Win8, "RNG15_RFL8_WIN8", Layout(kLowRateWindowBits, 4)},
    {Profile::kRng15Rfl8Nir8Zone16, "RNG15_RFL8_NIR8_ZONE16", Layout(kLowRateZoneBits, 8)},
    {Profile::kRng19Rfl8Sig16Nir16Zone16, "RNG19_RFL8_SIG16_NIR16_ZONE16",
     Layout(kSingleZoneBits, 12)},
    {Profile::kRng19Rfl8Sig16Zone16Dual, "RNG19_RFL8_SIG16_ZONE16_DUAL", Layout(kDualZoneBits, 16)},
    {Profile::kRng19Rfl8Sig16Nir16Rgb16, "RNG19_RFL8_SIG16_NIR16_RGB16", Layout(kRgbBits, 16)},
    {Profile::kRng19Rfl8Sig16Nir16Rgb16Dual, "RNG19_RFL8_SIG16_NIR16_RGB16_DUAL",
     Layout(kRgbDualBits, 20)},
    {Profile::kFiveWordPixel, "FIVE_WORD_PIXEL", Layout(kFiveWordBits, 20)},
    {Profile::kOff, "OFF", {}},
}};

constexpr std::array<std::string_view, kChannelCount> kChannelNames = {
    "RANGE",   "REFLECTIVITY", "SIGNAL", "NEAR_IR",   "FLAGS", "RANGE2", "REFLECTIVITY2",
    "SIGNAL2", "FLAGS2",       "WINDOW", "ZONE_MASK", "R",     "G",      "B"};

}  // namespace

const ChannelBits* PixelLayout::Find(Channel channel) const {
  const auto* found =
      std::find_if(begin(), end(), [&](const ChannelBits& b) { return b.channel == channel; });
  return found == end() ? nullptr : found;
}

std::string_view ToString(Profile profile) {
  return kProfiles[static_cast<std::size_t>(profile)].name;
}

std::optional<Profile> ProfileFromString(std::string_view name) {
  for (const ProfileRow& row : kProfiles)
    if (row.name == name) return row.profile;
  return std::nullopt;
}

std::string_view ToString(Channel channel) {
  return kChannelNames[static_cast<std::size_t>(channel)];
}

PixelLayout LayoutOf(Profile profile) {
  return kProfiles[static_cast<std::size_t>(profile)].layout;
}

std::size_t PacketFormat::packet_size() const {
  if (profile == Profile::kOff) return 0;
  return packet_header_size() + columns_per_packet * column_size() + packet_footer_size();
}

std::uint32_t PacketFormat::range_unit_mm() const {
  const ChannelBits* range = LayoutOf(profile).Find(Channel::kRange);
  return range == nullptr ? 1 : 1U << range->scale_shift;
}

bool PacketFormat::has_second_return() const {
  return LayoutOf(profile).Find(Channel::kRange2) != nullptr;
}

}  // namespace lidar::ouster
