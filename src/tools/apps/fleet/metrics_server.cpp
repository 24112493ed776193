// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/apps/fleet/metrics_server.h"

#include <netdb.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include <cerrno>
#include <stdexcept>
#include <utility>
#include <vector>

namespace lidar::fleet {
namespace {

constexpr std::size_t kMaxRequest = 8 << 10;
constexpr int kBacklog = 16;
/// Interval at which silent connections are closed, and at which a failed accept is repeated.
constexpr std::chrono::milliseconds kPatrol{200};

struct FreeAddress {
  void operator()(addrinfo* info) const { freeaddrinfo(info); }
};

tools::FileDescriptor Listen(const std::string& address, int port) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  addrinfo* raw = nullptr;
  const int found = getaddrinfo(address.empty() ? nullptr : address.c_str(),
                                std::to_string(port).c_str(), &hints, &raw);
  const std::unique_ptr<addrinfo, FreeAddress> info(found == 0 ? raw : nullptr);
  for (const addrinfo* a = info.get(); a != nullptr; a = a->ai_next) {
    tools::FileDescriptor fd(
        socket(a->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, a->ai_protocol));
    const int yes = 1;
    if (fd) setsockopt(fd.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    if (fd && bind(fd.get(), a->ai_addr, a->ai_addrlen) == 0 && listen(fd.get(), kBacklog) == 0)
      return fd;
  }
  throw std::runtime_error("cannot serve HTTP on " + address + ":" + std::to_string(port));
}

int PortOf(int fd) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  char port[NI_MAXSERV] = "0";
  auto* raw = reinterpret_cast<sockaddr*>(&address);
  if (getsockname(fd, raw, &size) == 0)
    getnameinfo(raw, size, nullptr, 0, port, sizeof port, NI_NUMERICSERV);
  return std::stoi(port);
}

std::string Response(const char* status, const std::string& text) {
  return std::string("HTTP/1.1 ") + status +
         "\r\nContent-Type: text/plain; version=0.0.4\r\nConnection: close\r\nContent-Length: " +
         std::to_string(text.size()) + "\r\n\r\n" + text;
}

bool MustWait() { return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR; }

}  // namespace

MetricsServer::MetricsServer(const std::string& address, int port,
                             std::chrono::milliseconds client_timeout)
    : client_timeout_(client_timeout),
      listener_(Listen(address, port)),
      wake_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      port_(PortOf(listener_.get())) {
  if (!wake_) throw std::runtime_error("cannot serve HTTP: no file descriptor is left");
  thread_ = std::thread([this] { Run(); });
}

MetricsServer::~MetricsServer() {
  ending_ = true;
  eventfd_write(wake_.get(), 1);
  thread_.join();
}

void MetricsServer::Publish(std::string text) {
  auto shared = std::make_shared<const std::string>(std::move(text));
  const std::lock_guard lock(mutex_);
  text_ = std::move(shared);
}

void MetricsServer::Run() {
  while (!ending_) {
    std::vector<pollfd> fds = {{wake_.get(), POLLIN, 0}, {listener_.get(), POLLIN, 0}};
    for (const Connection& c : connections_)
      fds.push_back({c.socket.get(), static_cast<short>(c.answer.empty() ? POLLIN : POLLOUT), 0});
    poll(fds.data(), fds.size(), connections_.empty() ? -1 : static_cast<int>(kPatrol.count()));
    const auto now = Clock::now();
    std::size_t i = 2;
    for (auto c = connections_.begin(); c != connections_.end(); ++i) {
      const bool in_time = now < c->until;
      if (!in_time) ++cut_;
      const bool stays = in_time && (fds[i].revents == 0 || GoesOn(&*c));
      c = stays ? std::next(c) : connections_.erase(c);
    }
    if (fds[1].revents != 0) Accept();
  }
}

/// Accepts a connection. If there are kMaxConnections already, closes the oldest of them, because
/// it had the most time.
void MetricsServer::Accept() {
  tools::FileDescriptor socket(
      accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
  if (!socket && !MustWait()) {
    // No file descriptor is left, so all connections are closed. The listener stays readable, so
    // Run() would spin if there were no pause.
    cut_ += connections_.size();
    connections_.clear();
    pollfd wake{wake_.get(), POLLIN, 0};
    poll(&wake, 1, static_cast<int>(kPatrol.count()));
  }
  if (!socket) return;
  if (connections_.size() == kMaxConnections) {
    connections_.pop_front();
    ++cut_;
  }
  connections_.push_back({std::move(socket), Clock::now() + client_timeout_, "", "", 0});
}

/// Receives or sends as much as is possible without waiting. Returns false once the connection is
/// over.
bool MetricsServer::GoesOn(Connection* connection) {
  if (connection->answer.empty() && !Receive(connection)) return false;
  if (connection->answer.empty()) return true;
  const std::string& answer = connection->answer;
  const ssize_t n = send(connection->socket.get(), answer.data() + connection->sent,
                         answer.size() - connection->sent, MSG_NOSIGNAL);
  if (n < 0) return MustWait();
  connection->sent += static_cast<std::size_t>(n);
  return connection->sent < answer.size();
}

bool MetricsServer::Receive(Connection* connection) {
  char bytes[1'024];
  const ssize_t n = recv(connection->socket.get(), bytes, sizeof bytes, 0);
  if (n < 0) return MustWait();
  std::string& request = connection->request;
  request.append(bytes, static_cast<std::size_t>(n));
  if (n == 0 || request.size() > kMaxRequest) return false;
  if (request.find("\r\n\r\n") != std::string::npos) connection->answer = AnswerTo(request);
  return true;
}

std::string MetricsServer::AnswerTo(const std::string& request) {
  const std::string wanted = request.substr(0, request.find("\r\n"));
  if (wanted.rfind("GET /metrics ", 0) != 0 && wanted.rfind("GET /metrics?", 0) != 0)
    return Response("404 Not Found", "The statistics are at /metrics.\n");
  std::shared_ptr<const std::string> text;
  {
    const std::lock_guard lock(mutex_);
    text = text_;
  }
  return Response("200 OK", *text);
}

}  // namespace lidar::fleet
