// SPDX-License-Identifier: LGPL-2.1-or-later
// A client of the sensor's HTTP API: reads the metadata, and changes the configuration.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "ext/ouster/http_client.h"
#include "ext/ouster/settings.h"
#include "src/ouster/metadata.h"

namespace lidar::gst {

/// The reason why a request failed. If `permanent` is true, another attempt would fail, too.
struct ApiError {
  std::string text;
  bool permanent = false;
};

class SensorApi {
 public:
  /// `client` must outlive this object.
  explicit SensorApi(HttpClient* client) : client_(*client) {}

  std::optional<ouster::Metadata> FetchMetadata(ApiError* error);

  /// Sends the values of `settings` that differ from the sensor's configuration, makes the sensor
  /// apply them and reads them back. Returns true if the sensor has accepted all of them. `sleep`
  /// waits about a second. If `sleep` returns false, this function gives up.
  bool Configure(const OusterSettings& settings, const std::function<bool()>& sleep,
                 ApiError* error);
  /// Returns the destination of the sensor's packets, for example "192.0.2.1:7502", or an empty
  /// text if it is not known.
  std::string Destination();

 private:
  std::optional<std::string> ReadConfig(bool staged, ApiError* error);
  std::optional<std::string> ResolveAuto(ApiError* error);
  bool WriteConfig(const std::string& json, ApiError* error);
  bool WaitUntilRunning(const std::function<bool()>& sleep, ApiError* error);

  HttpClient& client_;
};

}  // namespace lidar::gst
