// SPDX-License-Identifier: LGPL-2.1-or-later
// The part of the sensor's HTTP API that drivers use, and some paths for faults.
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "src/tools/bench/ouster_replay/sensor.h"

namespace lidar::tools {

/// Serves the following paths, from threads of its own.
///   GET  /api/v1/sensor/metadata              GET  /replay/stats
///   GET  /api/v1/sensor/config?staging=       POST /replay/faults  (sets fields of Faults)
///   POST /api/v1/sensor/config?staging=&reinit=&persist=
///   POST /replay/restart
/// With `old_firmware`, the paths of firmware before 2.4 replace .../config.
class HttpApi {
 public:
  struct Options {
    std::string address = "127.0.0.1";
    int port = 0;  // 0: any free one
    bool old_firmware = false;
  };
  /// The threads of the server call `stats`. Throws std::runtime_error if the server cannot listen.
  HttpApi(const Options& options, Sensor* sensor, std::function<std::string()> stats);
  ~HttpApi();
  HttpApi(const HttpApi&) = delete;
  HttpApi& operator=(const HttpApi&) = delete;

  int port() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lidar::tools
