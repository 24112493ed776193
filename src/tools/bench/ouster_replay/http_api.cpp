// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/ouster_replay/http_api.h"

#include <map>
#include <utility>

#include "src/ouster/json_text.h"
#include "src/tools/bench/ouster_replay/http_server.h"

namespace lidar::tools {
namespace {

using nlohmann::json;

HttpReply Ok(std::string text = "{}") { return {200, std::move(text), {}}; }

HttpReply Failure(int status, const std::string& why) {
  return {status, json{{"error", {{"title", why}}}}.dump(), {}};
}

std::string Parameter(const HttpRequest& request, const char* name) {
  const auto found = request.query.find(name);
  return found != request.query.end() ? found->second : "";
}

bool Flag(const HttpRequest& request, const char* name) {
  const std::string value = Parameter(request, name);
  return value == "true" || value == "True" || value == "1";
}

/// Returns true for a path of the sensor. Other paths begin with /replay/, and the sensor's faults
/// do not affect them.
bool IsSensorPath(const HttpRequest& request) { return request.path.rfind("/replay/", 0) != 0; }

/// Parses "key value" to an object with this key. The value is JSON or a bare word.
json ParseArguments(const std::string& text) {
  const std::size_t space = text.find(' ');
  if (space == std::string::npos) return {};
  const std::string word = text.substr(space + 1);
  json value = ouster::ParseJson(word);
  if (value.is_discarded()) value = word;
  return {{text.substr(0, space), value}};
}

}  // namespace

class HttpApi::Impl {
 public:
  Impl(const Options& options, Sensor* sensor, std::function<std::string()> stats)
      : sensor_(*sensor), stats_(std::move(stats)) {
    routes_["GET /api/v1/sensor/metadata"] = [this](const HttpRequest&) {
      return Ok(sensor_.MetadataJson());
    };
    if (options.old_firmware)
      AddCommands();
    else
      AddConfig();
    AddReplay();
    server_ = std::make_unique<HttpServer>(
        options.address, options.port, [this](const HttpRequest& r) { return Handle(r); },
        [this](const HttpRequest& r) {
          return IsSensorPath(r) ? static_cast<unsigned>(sensor_.faults().http_delay_ms) : 0U;
        });
  }
  int port() const { return server_->port(); }

 private:
  HttpReply Handle(const HttpRequest& request) {
    const int status = sensor_.faults().http_status;
    if (IsSensorPath(request) && status != 0) return Failure(status, "as requested");
    const auto route = routes_.find(request.method + " " + request.path);
    return route != routes_.end() ? route->second(request) : Failure(404, "no such path");
  }

  static HttpReply OkUnless(const std::string& error) {
    return error.empty() ? Ok() : Failure(400, error);
  }

  void AddConfig() {
    routes_["GET /api/v1/sensor/config"] = [this](const HttpRequest& request) {
      return Ok(sensor_.ConfigJson(Flag(request, "staging")));
    };
    routes_["POST /api/v1/sensor/config"] = [this](const HttpRequest& request) {
      return OkUnless(sensor_.SetConfig(ouster::ParseJson(request.body),
                                        {Flag(request, "staging"), Flag(request, "reinit")},
                                        request.peer));
    };
  }

  void AddCommands() {
    const std::string base = "GET /api/v1/sensor/cmd/";
    routes_[base + "get_config_param"] = [this](const HttpRequest& request) {
      return Ok(sensor_.ConfigJson(Parameter(request, "args") == "staged"));
    };
    routes_[base + "set_config_param"] = [this](const HttpRequest& request) {
      return OkUnless(sensor_.SetConfig(ParseArguments(Parameter(request, "args")), {true, false},
                                        request.peer));
    };
    routes_[base + "set_udp_dest_auto"] = [this](const HttpRequest& request) {
      return OkUnless(sensor_.SetConfig({{"udp_dest", "@auto"}}, {true, false}, request.peer));
    };
    routes_[base + "reinitialize"] = [this](const HttpRequest&) {
      sensor_.Restart();
      return Ok();
    };
  }

  void AddReplay() {
    routes_["GET /replay/stats"] = [this](const HttpRequest&) { return Ok(stats_()); };
    routes_["POST /replay/restart"] = [this](const HttpRequest&) {
      sensor_.Restart();
      return Ok();
    };
    routes_["POST /replay/faults"] = [this](const HttpRequest& request) {
      return OkUnless(sensor_.MergeFaults(ouster::ParseJson(request.body)));
    };
  }

  Sensor& sensor_;
  std::function<std::string()> stats_;
  std::map<std::string, HttpServer::Handler> routes_;  // by method and path
  std::unique_ptr<HttpServer> server_;                 // declared last, so that it ends first
};

HttpApi::HttpApi(const Options& options, Sensor* sensor, std::function<std::string()> stats)
    : impl_(std::make_unique<Impl>(options, sensor, std::move(stats))) {}
HttpApi::~HttpApi() = default;
int HttpApi::port() const { return impl_->port(); }

}  // namespace lidar::tools
