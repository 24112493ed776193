// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/edge/metrics_server.h"

#include <httplib.h>

#include <chrono>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

namespace lidar::edge {

class MetricsServer::Impl {
 public:
  Impl(const std::string& address, int port) : port_(port) {
    // Whoever connects and says nothing holds one of few threads, and not for long.
    server_.new_task_queue = [] { return new httplib::ThreadPool(2); };
    server_.set_read_timeout(2, 0);
    server_.set_write_timeout(2, 0);
    server_.set_keep_alive_max_count(1);
    server_.set_payload_max_length(1024);
    server_.Get("/metrics", [this](const httplib::Request&, httplib::Response& response) {
      const std::lock_guard lock(mutex_);
      response.set_content(text_, "text/plain; version=0.0.4");
    });
    const bool bound = port != 0 ? server_.bind_to_port(address.c_str(), port)
                                 : (port_ = server_.bind_to_any_port(address.c_str())) > 0;
    if (!bound)
      throw std::runtime_error("cannot serve HTTP on " + address + ":" + std::to_string(port));
    thread_ = std::thread([this] { server_.listen_after_bind(); });
    // A server that does not run yet cannot be stopped.
    while (!server_.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ~Impl() {
    server_.stop();
    thread_.join();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  int port() const { return port_; }
  void Publish(std::string text) {
    const std::lock_guard lock(mutex_);
    text_ = std::move(text);
  }

 private:
  std::mutex mutex_;  // guards text_
  std::string text_;
  httplib::Server server_;
  int port_;
  std::thread thread_;
};

MetricsServer::MetricsServer(const std::string& address, int port)
    : impl_(std::make_unique<Impl>(address, port)) {}
MetricsServer::~MetricsServer() = default;
int MetricsServer::port() const { return impl_->port(); }
void MetricsServer::Publish(std::string text) { impl_->Publish(std::move(text)); }

}  // namespace lidar::edge
