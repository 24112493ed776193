// SPDX-License-Identifier: LGPL-2.1-or-later
// Caps as text, and back from text that anybody may have written.
#pragma once
#include <gst/gst.h>

#include <algorithm>
#include <string>

#include "gst/common/refs.h"

namespace lidar::gst {

inline std::string CapsToText(const GstCaps* caps) {
  const StringPtr text(gst_caps_to_string(caps));
  return text.get();
}

/// Null where `text` is not the fixed caps of one stream in the system's memory.
inline CapsPtr FixedCapsFromText(const std::string& text) {
  // GStreamer's parser recurses with each bracket; only the names of fields are lists in ours.
  constexpr std::ptrdiff_t kMaxNesting = 1024;
  constexpr std::size_t kMaxSize = 1U << 20;  // a sensor model of 512 beams takes 30 kB
  const auto is_plain = [](char c) { return c >= ' ' && c <= '~'; };
  const auto nests = [](char c) { return c == '{' || c == '<' || c == '['; };
  if (text.empty() || text.size() > kMaxSize ||
      std::count_if(text.begin(), text.end(), nests) > kMaxNesting ||
      !std::all_of(text.begin(), text.end(), is_plain))
    return nullptr;
  CapsPtr caps(gst_caps_from_string(text.c_str()));
  if (!caps || gst_caps_get_size(caps.get()) != 1 || !gst_caps_is_fixed(caps.get()) ||
      !gst_caps_features_is_equal(gst_caps_get_features(caps.get(), 0),
                                  GST_CAPS_FEATURES_MEMORY_SYSTEM_MEMORY))
    return nullptr;
  return caps;
}

}  // namespace lidar::gst
