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
  std::map<std::string, std::string> query;  // values are valid UTF-8, as JSON requires
};

struct HttpReply {
  int status = 200;
  std::string json;
  std::string location;  // address to which the client is redirected
};

/// Listens from its construction to its destruction. Calls `handler` and `delay` in its own thread.
class HttpServer {
 public:
  using Handler = std::function<HttpReply(const HttpRequest&)>;
  /// Returns the time before a request is handled [ms]. Other requests are handled meanwhile.
  using Delay = std::function<unsigned(const HttpRequest&)>;

  /// `port` may be 0 for any free port. Throws std::runtime_error if the server cannot listen.
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
