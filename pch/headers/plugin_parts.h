// SPDX-License-Identifier: LGPL-2.1-or-later
// What most files of a plugin include, compiled once.
#include <gst/gst.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>
