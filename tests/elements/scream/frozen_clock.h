// SPDX-License-Identifier: LGPL-2.1-or-later
// The monotonic clock of the test programs in which srtp_input_test.cpp replaces GLib's function.
#pragma once
#include <glib.h>

#include <atomic>
#include <functional>

namespace lidar::test {

inline std::atomic<gint64> frozen_at{0};  // [us]; 0: the real time
inline std::atomic<unsigned> looks{0};    // number of times that any thread has read the clock
inline thread_local std::function<void()> on_look;

}  // namespace lidar::test
