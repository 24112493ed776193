// SPDX-License-Identifier: LGPL-2.1-or-later
// The two ends of the demo. Each of them runs as a process of its own.
#pragma once
#include <string>

namespace lidar::demo {

/// Plays a pipeline, and watches its elements `source`, `encoder` and `sender`. Writes the records
/// "captured", "encoded", "bounds" and "stats" to the standard output, and each captured slice to
/// descriptor 3.
int Send(const std::string& description);

/// Plays a pipeline, and watches its elements `receiver`, `depayloader`, `decoder` and, if present,
/// `odometry`. Writes the records "decoded", "posed" and "stats" to the standard output, and each
/// decoded slice to descriptor 3.
int Receive(const std::string& description);

}  // namespace lidar::demo
