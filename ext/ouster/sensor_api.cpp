// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/ouster/sensor_api.h"

#include <nlohmann/json.hpp>

#include "src/ouster/json_text.h"

namespace lidar::gst {
namespace {

using nlohmann::json;

constexpr long kNotFound = 404;
constexpr const char* kAuto = "@auto";

/// Parses a JSON object. Returns an empty object for any other text.
json ParseObject(const std::string& text) {
  json root = ouster::ParseJsonObject(text);
  if (root.is_discarded()) return json::object();
  return root;
}

/// Converts `value` to text. Bytes that are not UTF-8 are replaced, because json::dump() would
/// throw an exception otherwise. Such bytes may come from a property.
std::string Write(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// Parses a window such as "180000,360000" [millidegrees].
std::optional<json> ParseWindow(const std::string& text) {
  const json window = json::parse("[" + text + "]", nullptr, false);
  if (!window.is_array() || window.size() != 2 || !window[0].is_number_unsigned() ||
      !window[1].is_number_unsigned())
    return std::nullopt;
  // The type is explicit, because nlohmann_json 3.12 converts an optional to JSON.
  return std::make_optional<json>(window);
}

/// Returns the parameters that the settings want to change, by their names in the API.
std::optional<json> Wanted(const OusterSettings& s, ApiError* error) {
  json wanted = json::object();
  if (!s.udp_dest.empty()) wanted["udp_dest"] = s.udp_dest;
  if (s.lidar_port != 0) wanted["udp_port_lidar"] = s.lidar_port;
  if (s.imu_port != 0) wanted["udp_port_imu"] = s.imu_port;
  if (!s.lidar_mode.empty()) wanted["lidar_mode"] = s.lidar_mode;
  if (!s.udp_profile_lidar.empty()) wanted["udp_profile_lidar"] = s.udp_profile_lidar;
  if (!s.sensor_timestamp_mode.empty()) wanted["timestamp_mode"] = s.sensor_timestamp_mode;
  if (!s.azimuth_window.empty()) {
    const auto window = ParseWindow(s.azimuth_window);
    if (!window) {
      *error = {"azimuth-window must be like \"180000,360000\" [millidegrees]", true};
      return std::nullopt;
    }
    wanted["azimuth_window"] = *window;
  }
  const auto whole = static_cast<int>(s.signal_multiplier);
  if (s.signal_multiplier > 0 && s.signal_multiplier == whole)
    wanted["signal_multiplier"] = whole;
  else if (s.signal_multiplier > 0)
    wanted["signal_multiplier"] = s.signal_multiplier;
  return std::make_optional<json>(wanted);
}

/// Returns the entries of `wanted` that differ from the configuration `has`.
json Missing(const json& wanted, const json& has) {
  json missing = json::object();
  for (const auto& [key, value] : wanted.items())
    if (!has.contains(key) || has[key] != value) missing[key] = value;
  return missing;
}

}  // namespace

std::optional<ouster::Metadata> SensorApi::FetchMetadata(ApiError* error) {
  const HttpResponse response = client_.Get("sensor/metadata");
  if (!response.ok) {
    const bool too_old = response.status == kNotFound;
    *error = {response.error + (too_old ? "; its firmware may be older than 2.1" : ""), too_old};
    return std::nullopt;
  }
  std::string why;
  auto metadata = ouster::ParseMetadata(response.body, &why);
  // The error is not permanent, because a sensor that is starting up sends incomplete metadata.
  if (!metadata) *error = {"the sensor's metadata cannot be used: " + why, false};
  return metadata;
}

std::optional<std::string> SensorApi::ReadConfig(bool staged, ApiError* error) {
  HttpResponse response =
      client_.Get(staged ? "sensor/config?staging=true" : "sensor/config?staging=false");
  if (response.status == kNotFound)  // firmware before 2.4
    response = client_.Get(std::string("sensor/cmd/get_config_param?args=") +
                           (staged ? "staged" : "active"));
  if (response.ok) return response.body;
  *error = {response.error, false};
  return std::nullopt;
}

/// Returns the address of this machine as the sensor sees it. To find it, sets `@auto` in the
/// staged configuration, which is not activated, and reads the address back.
std::optional<std::string> SensorApi::ResolveAuto(ApiError* error) {
  HttpResponse response = client_.Post("sensor/config?staging=true&reinit=false&persist=false",
                                       R"({"udp_dest":"@auto"})");
  if (response.status == kNotFound)  // firmware before 2.4
    response = client_.Get("sensor/cmd/set_udp_dest_auto");
  if (!response.ok) {
    *error = {response.error, false};
    return std::nullopt;
  }
  const auto text = ReadConfig(/*staged=*/true, error);
  if (!text) return std::nullopt;
  const json staged = ParseObject(*text);
  if (staged.contains("udp_dest") && staged["udp_dest"].is_string())
    return staged["udp_dest"].get<std::string>();
  *error = {"the sensor does not report the udp_dest that it chose for @auto", false};
  return std::nullopt;
}

bool SensorApi::WriteConfig(const std::string& text, ApiError* error) {
  HttpResponse response = client_.Post("sensor/config?reinit=true&persist=false", text);
  if (response.status == kNotFound) {  // firmware before 2.4
    const json parameters = ParseObject(text);
    for (const auto& [key, value] : parameters.items()) {
      response =
          client_.Get("sensor/cmd/set_config_param?args=" + key + "+" +
                      client_.Escape(value.is_string() ? value.get<std::string>() : Write(value)));
      if (!response.ok) break;
    }
    if (response.ok) response = client_.Get("sensor/cmd/reinitialize");
  }
  if (response.ok) return true;
  const bool refused = response.status >= 400 && response.status < 500;
  *error = {"the sensor does not accept the configuration " + text + ": " + response.error +
                (refused ? " " + response.body.substr(0, 200) : ""),
            refused};
  return false;
}

bool SensorApi::WaitUntilRunning(const std::function<bool()>& sleep, ApiError* error) {
  constexpr int kAttempts = 90;  // time for a motor to spin up
  std::string last = "unknown";
  for (int i = 0; i < kAttempts; ++i) {
    const HttpResponse response = client_.Get("sensor/metadata");
    const json root = ParseObject(response.body);
    const json info = root.value("sensor_info", root);
    if (response.ok && info.is_object()) {
      const auto status = info.find("status");
      if (status == info.end() || *status == "RUNNING") return true;
      last = Write(*status);
    }
    if (!sleep()) break;
  }
  *error = {
      "the sensor does not run again after its configuration was changed; its status is " + last,
      false};
  return false;
}

bool SensorApi::Configure(const OusterSettings& settings, const std::function<bool()>& sleep,
                          ApiError* error) {
  auto wanted = Wanted(settings, error);
  if (!wanted) return false;
  if (wanted->empty()) return true;
  if (settings.udp_dest == kAuto) {
    const auto ours = ResolveAuto(error);
    if (!ours) return false;
    (*wanted)["udp_dest"] = *ours;
  }
  auto text = ReadConfig(/*staged=*/false, error);
  if (!text) return false;
  const json change = Missing(*wanted, ParseObject(*text));
  if (change.empty()) return true;
  if (!WriteConfig(Write(change), error) || !WaitUntilRunning(sleep, error)) return false;
  text = ReadConfig(/*staged=*/false, error);
  if (!text) return false;
  const json refused = Missing(*wanted, ParseObject(*text));
  if (refused.empty()) return true;
  *error = {"the sensor did not apply " + Write(refused), true};
  return false;
}

std::string SensorApi::Destination() {
  ApiError ignored;
  const auto text = ReadConfig(/*staged=*/false, &ignored);
  const json config = text ? ParseObject(*text) : json::object();
  if (!config.contains("udp_dest") || !config["udp_dest"].is_string()) return {};
  const json port = config.value("udp_port_lidar", json());
  return config["udp_dest"].get<std::string>() +
         (port.is_number_unsigned() ? ":" + port.dump() : "");
}

}  // namespace lidar::gst
