// SPDX-License-Identifier: LGPL-2.1-or-later
// JSON from a sensor or an impostor: bounded in size, depth and time.
#pragma once
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace lidar::ouster {

inline constexpr int kMaxJsonDepth = 16;
/// Limit of the number of strings, lists and objects, because each takes up to 100 times as much
/// memory as its text.
inline constexpr std::size_t kMaxJsonItems = 1U << 16;

/// The value in `text`; discarded (`is_discarded()`) if the text is not JSON or exceeds the bounds
/// above. Takes time linear in the size of the text. The result may be copied, compared and written
/// without regard to the stack, because its depth is bounded.
nlohmann::json ParseJson(std::string_view text);

/// The same; discarded also if the value is not an object.
nlohmann::json ParseJsonObject(std::string_view text);

}  // namespace lidar::ouster
