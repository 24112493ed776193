// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/ouster_replay/http_api.h"

#include <httplib.h>

#include <chrono>
#include <optional>
#include <thread>
#include <utility>

#include "src/tools/common/http_listener.h"

namespace lidar::tools {
namespace {

using httplib::Request;
using httplib::Response;
using nlohmann::json;

constexpr const char* kJson = "application/json";

void Fail(Response* response, int status, const std::string& why) {
  response->status = status;
  response->set_content(json{{"error", {{"title", why}}}}.dump(), kJson);
}

bool Flag(const Request& request, const char* name) {
  const std::string value = request.get_param_value(name);
  return value == "true" || value == "True" || value == "1";
}

/// "key value", the value being JSON or a bare word.
json ParseArguments(const std::string& text) {
  const std::size_t space = text.find(' ');
  if (space == std::string::npos) return {};
  const std::string word = text.substr(space + 1);
  json value = json::parse(word, nullptr, false);
  if (value.is_discarded()) value = word;
  return {{text.substr(0, space), value}};
}

}  // namespace

class HttpApi::Impl {
 public:
  Impl(const Options& options, Sensor* sensor, std::function<std::string()> stats)
      : sensor_(*sensor), stats_(std::move(stats)) {
    AddFaults();
    AddMetadata();
    if (options.old_firmware)
      AddCommands();
    else
      AddConfig();
    AddReplay();
    listener_.emplace(&server_, options.address, options.port);
  }
  int port() const { return listener_->port(); }

 private:
  void AddFaults() {
    server_.set_pre_routing_handler([this](const Request& request, Response& response) {
      if (request.path.rfind("/replay/", 0) == 0)
        return httplib::Server::HandlerResponse::Unhandled;
      const Faults faults = sensor_.faults();
      std::this_thread::sleep_for(std::chrono::milliseconds(faults.http_delay_ms));
      if (faults.http_status == 0) return httplib::Server::HandlerResponse::Unhandled;
      Fail(&response, faults.http_status, "as requested");
      return httplib::Server::HandlerResponse::Handled;
    });
  }

  void AddMetadata() {
    server_.Get("/api/v1/sensor/metadata", [this](const Request&, Response& response) {
      response.set_content(sensor_.MetadataJson(), kJson);
    });
  }

  void Set(const json& config, const Sensor::Change& change, const Request& request,
           Response* response) {
    const std::string error = sensor_.SetConfig(config, change, request.remote_addr);
    if (error.empty())
      response->set_content("{}", kJson);
    else
      Fail(response, 400, error);
  }

  void AddConfig() {
    server_.Get("/api/v1/sensor/config", [this](const Request& request, Response& response) {
      response.set_content(sensor_.ConfigJson(Flag(request, "staging")), kJson);
    });
    server_.Post("/api/v1/sensor/config", [this](const Request& request, Response& response) {
      Set(json::parse(request.body, nullptr, false),
          {Flag(request, "staging"), Flag(request, "reinit")}, request, &response);
    });
  }

  void AddCommands() {
    const std::string base = "/api/v1/sensor/cmd/";
    server_.Get(base + "get_config_param", [this](const Request& request, Response& response) {
      response.set_content(sensor_.ConfigJson(request.get_param_value("args") == "staged"), kJson);
    });
    server_.Get(base + "set_config_param", [this](const Request& request, Response& response) {
      Set(ParseArguments(request.get_param_value("args")), {true, false}, request, &response);
    });
    server_.Get(base + "set_udp_dest_auto", [this](const Request& request, Response& response) {
      Set({{"udp_dest", "@auto"}}, {true, false}, request, &response);
    });
    server_.Get(base + "reinitialize", [this](const Request&, Response& response) {
      sensor_.Restart();
      response.set_content("{}", kJson);
    });
  }

  void AddReplay() {
    server_.Get("/replay/stats", [this](const Request&, Response& response) {
      response.set_content(stats_(), kJson);
    });
    server_.Post("/replay/restart", [this](const Request&, Response& response) {
      sensor_.Restart();
      response.set_content("{}", kJson);
    });
    server_.Post("/replay/faults", [this](const Request& request, Response& response) {
      const std::string error = sensor_.MergeFaults(json::parse(request.body, nullptr, false));
      if (error.empty())
        response.set_content("{}", kJson);
      else
        Fail(&response, 400, error);
    });
  }

  Sensor& sensor_;
  std::function<std::string()> stats_;
  httplib::Server server_;
  std::optional<HttpListener> listener_;  // the last, so that it ends first
};

HttpApi::HttpApi(const Options& options, Sensor* sensor, std::function<std::string()> stats)
    : impl_(std::make_unique<Impl>(options, sensor, std::move(stats))) {}
HttpApi::~HttpApi() = default;
int HttpApi::port() const { return impl_->port(); }

}  // namespace lidar::tools
