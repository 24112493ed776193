// SPDX-License-Identifier: LGPL-2.1-or-later
// A TCP server that answers every request as the test says, and not as a sensor would.
#pragma once
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <thread>
#include <utility>

namespace lidar::test {

/// The server's end of a connection to one client.
class Exchange {
 public:
  Exchange(int fd, const std::atomic<bool>& stopping) : fd_(fd), stopping_(stopping) {}
  /// Sends `text`. Returns false if the client has closed the connection or the test is over.
  bool Send(const std::string& text) const {
    return !stopping_ && send(fd_, text.data(), text.size(), MSG_NOSIGNAL) > 0;
  }
  /// Sends an answer with status 200 and this body.
  bool Answer(const std::string& body) const {
    std::string text =
        "HTTP/1.1 200 OK\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
    while (!text.empty()) {
      const ssize_t sent = stopping_ ? -1 : send(fd_, text.data(), text.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      text.erase(0, static_cast<std::size_t>(sent));
    }
    return true;
  }
  /// Waits for `time`. Returns false if the client has closed the connection or the test is over.
  bool Wait(std::chrono::milliseconds time) const {
    std::this_thread::sleep_for(time);
    char next = 0;
    return !stopping_ && recv(fd_, &next, 1, MSG_PEEK | MSG_DONTWAIT) != 0;
  }

 private:
  int fd_;
  const std::atomic<bool>& stopping_;
};

class HostileServer {
 public:
  using Behaviour = std::function<void(const Exchange&)>;

  /// Calls `behave` for each request. Closes the connection when `behave` returns.
  explicit HostileServer(Behaviour behave)
      : behave_(std::move(behave)), listener_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(listen(listener_, 8), 0);
    socklen_t size = sizeof address;
    getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { Run(); });
  }
  ~HostileServer() {
    stopping_ = true;
    thread_.join();
    close(listener_);
  }
  HostileServer(const HostileServer&) = delete;
  HostileServer& operator=(const HostileServer&) = delete;

  std::string host() const { return "127.0.0.1:" + std::to_string(port_); }
  int requests() const { return requests_; }

 private:
  static bool Readable(int fd) {
    pollfd wanted{fd, POLLIN, 0};
    return poll(&wanted, 1, 20) > 0;
  }
  void Run() {
    while (!stopping_) {
      if (!Readable(listener_)) continue;
      const int fd = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
      if (fd < 0) continue;
      const timeval patience{0, 100'000};  // maximum time of a send to a client that does not read
      setsockopt(fd, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
      char request[4096];
      while (!stopping_ && !Readable(fd)) continue;
      if (!stopping_ && recv(fd, request, sizeof request, 0) > 0) {
        ++requests_;
        behave_(Exchange(fd, stopping_));
      }
      close(fd);
    }
  }

  const Behaviour behave_;
  const int listener_;
  int port_ = 0;
  std::atomic<bool> stopping_{false};
  std::atomic<int> requests_{0};
  std::thread thread_;
};

}  // namespace lidar::test
