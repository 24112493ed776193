// SPDX-License-Identifier: LGPL-2.1-or-later
// The two ends of the demo, each a program of its own.
#pragma once
#include <string>

namespace lidar::demo {

/// Plays a pipeline whose elements `source`, `encoder` and `sender` are watched. Records: captured,
/// encoded, bounds, stats; every captured slice on descriptor 3.
int Send(const std::string& description);

/// Watches `receiver`, `depayloader` and `decoder`. Records: decoded, stats; every decoded
/// slice on descriptor 3.
int Receive(const std::string& description);

}  // namespace lidar::demo
