// SPDX-License-Identifier: LGPL-2.1-or-later
// A nats-server process that a test starts, on a free port of the loopback interface.
#pragma once
#include <gst/gst.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "gst/common/refs.h"
#include "tests/elements/nats/http_get.h"
#include "tests/support/files.h"
#include "tests/support/patience.h"

namespace lidar::test {

class NatsServer {
 public:
  /// Returns the path of nats-server. Debian installs it in a folder that may be missing in a
  /// user's PATH.
  static std::string Program() {
    for (const char* path : {"/usr/sbin/nats-server", "/usr/local/bin/nats-server"})
      if (access(path, X_OK) == 0) return path;
    gchar* found = g_find_program_in_path("nats-server");
    const std::string program = found != nullptr ? found : "";
    g_free(found);
    return program;
  }

  NatsServer() = default;
  ~NatsServer() { Kill(); }
  NatsServer(const NatsServer&) = delete;
  NatsServer& operator=(const NatsServer&) = delete;

  /// Starts the server with JetStream. Uses the same port at each start.
  void Start(const std::vector<std::string>& options = {}) {
    options_ = options;
    ASSERT_TRUE(Eventually([this] { return TryToStart(); })) << "nats-server does not start";
  }
  void Restart() { Start(options_); }
  /// Kills the process. Like a power cut, this gives it no time to save anything.
  void Kill() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    pid_ = -1;
  }
  /// Stops the process by SIGSTOP. Returns once the process has stopped.
  void Freeze() {
    kill(pid_, SIGSTOP);
    waitpid(pid_, nullptr, WUNTRACED);
  }
  void Thaw() { kill(pid_, SIGCONT); }

  std::string url(const std::string& scheme = "nats", const std::string& user = "") const {
    return scheme + "://" + user + "127.0.0.1:" + port_;
  }
  const std::string& folder() const { return folder_; }
  /// Returns the number of times that `text` occurs in the server's log.
  std::size_t Logged(const std::string& text) const {
    const std::string log = ReadFile(folder_ + "/log");
    std::size_t count = 0;
    for (auto at = log.find(text); at != log.npos; at = log.find(text, at + 1)) ++count;
    return count;
  }
  /// Makes good.creds and bad.creds in the folder, and returns the options of a server that accepts
  /// only good.creds. Returns an empty list if a tool for this is missing.
  std::vector<std::string> OptionsForCredentials() const {
    const std::string make = std::string(g_getenv("NATS_MAKE_CREDENTIALS")) + " " + folder_;
    if (std::system(make.c_str()) != 0) return {};
    return {"-c", folder_ + "/operator.conf", "-js=false"};
  }
  /// Returns the number of the server's subscriptions whose subject equals `subject`.
  std::size_t Subscriptions(const std::string& subject) const {
    const std::string sign = "\"subject\": \"" + subject + "\"";
    const std::string text =
        HttpGet("127.0.0.1:" + monitor_, "/subsz?subs=1&test=" + subject).value_or("");
    std::size_t count = 0;
    for (auto at = text.find(sign); at != text.npos; at = text.find(sign, at + 1)) ++count;
    return count;
  }
  pid_t pid() const { return pid_; }

 private:
  /// Starts the process. Returns false if it exits, for example because another program has taken
  /// the port.
  bool TryToStart() {
    Kill();
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
      if (entry.path().extension() == ".ports") std::filesystem::remove(entry.path());
    std::vector<std::string> words = {Program(),
                                      "-a",
                                      "127.0.0.1",
                                      "-p",
                                      port_,
                                      "-m",
                                      "-1",
                                      "-js",
                                      "-sd",
                                      folder_ + "/store",
                                      "--ports_file_dir",
                                      folder_,
                                      "-l",
                                      folder_ + "/log"};
    words.insert(words.end(), options_.begin(), options_.end());
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    pid_ = fork();
    if (pid_ == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      execv(arguments[0], arguments.data());
      _exit(127);
    }
    return WaitForPort();
  }
  bool WaitForPort() {
    const std::string path = folder_ + "/nats-server_" + std::to_string(pid_) + ".ports";
    std::string text;
    const bool there = Eventually([&] {
      text = ReadFile(path);
      return text.find('}') != text.npos || waitpid(pid_, nullptr, WNOHANG) == pid_;
    });
    const std::string port = PortBehind(text, 0);
    if (!there || port.empty()) return false;
    port_ = port;
    monitor_ = PortBehind(text, text.find("monitoring"));
    return true;
  }
  static std::string PortBehind(const std::string& text, std::size_t from) {
    const std::string host = "127.0.0.1:";
    const auto at = text.find(host, from);
    if (at == text.npos) return "";
    const auto begin = at + host.size();
    return text.substr(begin, text.find_first_not_of("0123456789", begin) - begin);
  }

  const TempFolder owner_;
  const std::string& folder_ = owner_.path();
  std::string port_ = "-1";  // any free port
  std::string monitor_;      // port for HTTP requests about the server's state
  std::vector<std::string> options_;
  pid_t pid_ = -1;
};

/// The base class of tests that need a server.
class NatsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (NatsServer::Program().empty())
      GTEST_SKIP() << "nats-server is not installed (Debian: nats-server)";
  }
  std::string At(const std::string& more = "") const {
    return " url=" + server_.url() + " " + more + " ";
  }

  NatsServer server_;
};

}  // namespace lidar::test
