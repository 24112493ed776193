// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/fleet/metrics_server.h"

#include <httplib.h>

#include <mutex>
#include <optional>
#include <utility>

#include "src/tools/common/http_listener.h"

namespace lidar::fleet {

class MetricsServer::Impl {
 public:
  Impl(const std::string& address, int port) {
    // A client that connects and says nothing holds one of few threads, and not for long.
    server_.new_task_queue = [] { return new httplib::ThreadPool(2); };
    server_.set_read_timeout(2, 0);
    server_.set_write_timeout(2, 0);
    server_.set_keep_alive_max_count(1);
    server_.set_payload_max_length(1024);
    server_.Get("/metrics", [this](const httplib::Request&, httplib::Response& response) {
      const std::lock_guard lock(mutex_);
      response.set_content(text_, "text/plain; version=0.0.4");
    });
    listener_.emplace(&server_, address, port);
  }

  int port() const { return listener_->port(); }
  void Publish(std::string text) {
    const std::lock_guard lock(mutex_);
    text_ = std::move(text);
  }

 private:
  std::mutex mutex_;  // guards text_
  std::string text_;
  httplib::Server server_;
  std::optional<tools::HttpListener> listener_;  // the last, so that it ends first
};

MetricsServer::MetricsServer(const std::string& address, int port)
    : impl_(std::make_unique<Impl>(address, port)) {}
MetricsServer::~MetricsServer() = default;
int MetricsServer::port() const { return impl_->port(); }
void MetricsServer::Publish(std::string text) { impl_->Publish(std::move(text)); }

}  // namespace lidar::fleet
