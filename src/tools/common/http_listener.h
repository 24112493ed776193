// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs an HTTP server in a thread of its own.
#pragma once
#include <httplib.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>

namespace lidar::tools {

/// Listens from its making, when all handlers are set, to its end.
class HttpListener {
 public:
  /// Port 0: any that is free. Throws where the port cannot be had.
  HttpListener(httplib::Server* server, const std::string& address, int port)
      : server_(*server), port_(port) {
    const bool bound = port != 0 ? server_.bind_to_port(address.c_str(), port)
                                 : (port_ = server_.bind_to_any_port(address.c_str())) > 0;
    if (!bound)
      throw std::runtime_error("cannot serve HTTP on " + address + ":" + std::to_string(port));
    thread_ = std::thread([this] { server_.listen_after_bind(); });
    // A server that does not run yet cannot be stopped.
    while (!server_.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ~HttpListener() {
    server_.stop();
    thread_.join();
  }
  HttpListener(const HttpListener&) = delete;
  HttpListener& operator=(const HttpListener&) = delete;

  int port() const { return port_; }

 private:
  httplib::Server& server_;
  int port_;
  std::thread thread_;
};

}  // namespace lidar::tools
