// SPDX-License-Identifier: LGPL-2.1-or-later
// The sensor's HTTP API: reads its metadata, and sets its configuration.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "ext/ouster/http_client.h"
#include "ext/ouster/settings.h"
#include "src/ouster/metadata.h"

namespace lidar::gst {

/// The result of a failed request. `permanent`: asking again will not help.
struct ApiError {
  std::string text;
  bool permanent = false;
};

class SensorApi {
 public:
  /// `client` must outlive this.
  explicit SensorApi(HttpClient* client) : client_(*client) {}

  std::optional<ouster::Metadata> FetchMetadata(ApiError* error);

  /// Sends the values of `settings` that the sensor lacks, makes it apply them and reads them back.
  /// Returns true if the sensor has all of them. `sleep` waits about a second, and ends the call if
  /// it returns false.
  bool Configure(const OusterSettings& settings, const std::function<bool()>& sleep,
                 ApiError* error);
  /// Returns the destination of the sensor's packets, "192.0.2.1:7502"; empty if unknown.
  std::string Destination();

 private:
  std::optional<std::string> ReadConfig(bool staged, ApiError* error);
  std::optional<std::string> ResolveAuto(ApiError* error);
  bool WriteConfig(const std::string& json, ApiError* error);
  bool WaitUntilRunning(const std::function<bool()>& sleep, ApiError* error);

  HttpClient& client_;
};

}  // namespace lidar::gst
