// SPDX-License-Identifier: LGPL-2.1-or-later
// Parses JSON from a sensor, or from a host that pretends to be one. Size, depth and time are
// bounded.
#pragma once
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace lidar::ouster {

inline constexpr int kMaxJsonDepth = 16;
/// The greatest number of strings, lists and objects in a text. It is limited because each of them
/// takes up to 100 times as much memory as its text.
inline constexpr std::size_t kMaxJsonItems = 1U << 16;

/// Parses `text`. If `text` is not JSON or exceeds the bounds above, returns a value for which
/// `is_discarded()` is true. Takes time linear in the size of the text. The result can be copied,
/// compared and written without a stack overflow, because its depth is bounded.
nlohmann::json ParseJson(std::string_view text);

/// Parses `text` like ParseJson(), but also discards a value that is not an object.
nlohmann::json ParseJsonObject(std::string_view text);

}  // namespace lidar::ouster
