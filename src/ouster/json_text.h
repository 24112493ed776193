// SPDX-License-Identifier: LGPL-2.1-or-later
// JSON from a sensor, or from whoever answers in its place: bounded in size, depth and time.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace lidar::ouster {

inline constexpr int kMaxJsonDepth = 16;

/// The object in `text`; discarded (`is_discarded()`) where the text is no JSON object or nests
/// deeper than kMaxJsonDepth. Takes time linear in the size of the text. The result may be copied,
/// compared and written without regard to the stack, as its depth is bounded.
nlohmann::json ParseJsonObject(std::string_view text);

}  // namespace lidar::ouster
