// SPDX-License-Identifier: LGPL-2.1-or-later
// gst_lidar_msgs/msg/CodedSlice: our ROS message for a coded slice.
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "src/cdr/messages.h"

namespace lidar::cdr {

struct CodedSlice {
  static constexpr std::string_view kName = "gst_lidar_msgs/msg/CodedSlice";

  Header header;                     // stamp: when the first column was sampled; 0: not known
  std::optional<Duration> duration;  // duration of the slice's sweep
  std::uint32_t scan_id = 0;
  std::uint32_t slice_index = 0;
  std::uint32_t slice_count = 0;  // 0: scan and slice are unknown
  std::uint32_t first_column = 0;
  bool discontinuity = false;  // slices before it are missing
  ByteView data;               // not owned: a part of the message from which it was read
};

std::optional<CodedSlice> ReadCodedSlice(ByteView message);
std::vector<std::uint8_t> WriteCodedSlice(const CodedSlice& slice);

}  // namespace lidar::cdr
