// SPDX-License-Identifier: LGPL-2.1-or-later
// Sends requests to the sensor in a thread of its own, so that packets never wait for an answer.
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
    std::optional<ouster::Metadata> metadata;  // empty: the request failed
    ApiError error;
    std::string destination;  // destination of the sensor's packets, if known
  };

  /// Returns null and sets `error` for a malformed hostname, or if no thread can be made. The
  /// thread calls `notify` when there is a result to take.
  static std::unique_ptr<SensorLink> Create(const OusterSettings& settings,
                                            std::function<void()> notify, std::string* error);
  ~SensorLink();
  SensorLink(const SensorLink&) = delete;
  SensorLink& operator=(const SensorLink&) = delete;

  /// Configures the sensor as the settings ask and fetches its metadata. A request during another
  /// one is ignored. A failure is a result, too; the link then tries again, ever more slowly,
  /// unless the settings forbid it.
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

  mutable std::mutex mutex_;  // guards all below
  std::condition_variable changed_;
  bool stopping_ = false;
  bool requested_ = false;
  std::optional<Result> result_;
  std::thread thread_;
};

}  // namespace lidar::gst
