// SPDX-License-Identifier: LGPL-2.1-or-later
// Serves HTTP from a thread of its own.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>

namespace lidar::tools {

struct HttpRequest {
  std::string method;
  std::string path;
  std::string body;
  std::string peer;                          // address of the client
  std::map<std::string, std::string> query;  // values are UTF-8, as in JSON
};

struct HttpReply {
  int status = 200;
  std::string json;
  std::string location;  // of a redirect
};

/// Listens during its lifetime. Calls both functions in its thread.
class HttpServer {
 public:
  using Handler = std::function<HttpReply(const HttpRequest&)>;
  /// Delay of a request's handling [ms]; other requests continue meanwhile.
  using Delay = std::function<unsigned(const HttpRequest&)>;

  /// Port 0: any free one. Throws std::runtime_error if the port is taken.
  HttpServer(const std::string& address, int port, Handler handler, Delay delay = nullptr);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  int port() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lidar::tools
