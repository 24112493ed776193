// SPDX-License-Identifier: LGPL-2.1-or-later
// Sends requests to the sensor in a separate thread, so that packets never have to wait for an
// answer.
#pragma once
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "ext/ouster/sensor_api.h"

namespace lidar::gst {

class SensorLink {
 public:
  struct Result {
    std::optional<ouster::Metadata> metadata;  // empty if the request failed
    ApiError error;
    std::string destination;  // where the sensor sends its packets, if known
  };

  /// Returns null and sets `error` if the hostname is malformed or if no thread can be started. The
  /// thread calls `notify` whenever Take() has a new result.
  static std::unique_ptr<SensorLink> Create(const OusterSettings& settings,
                                            std::function<void()> notify, std::string* error);
  ~SensorLink();
  SensorLink(const SensorLink&) = delete;
  SensorLink& operator=(const SensorLink&) = delete;

  /// Starts a request, which configures the sensor according to the settings and fetches its
  /// metadata. Does nothing if a request is already running. A failed request also has a result.
  /// After a failure the request is repeated at increasing intervals, unless `reconnect` is false
  /// or the error is permanent.
  void Request();
  bool busy() const;
  std::optional<Result> Take();

 private:
  SensorLink(const OusterSettings& settings, std::unique_ptr<HttpClient> client,
             std::function<void()> notify);
  void Run();
  Result Ask();
  bool Sleep(std::chrono::milliseconds time);

  const OusterSettings settings_;
  const std::unique_ptr<HttpClient> client_;
  const std::function<void()> notify_;

  mutable std::mutex mutex_;  // guards all members below
  std::condition_variable changed_;
  bool stopping_ = false;
  bool requested_ = false;
  std::optional<Result> result_;
  std::thread thread_;
};

}  // namespace lidar::gst
