// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/common/child_process.h"

#include <fcntl.h>
#include <limits.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>

namespace lidar::tools {
namespace {

constexpr int kCloudsFd = 3;
constexpr int kPipeSize = 1 << 20;

struct Pipe {
  FileDescriptor read;
  FileDescriptor write;
};

Pipe MakePipe() {
  int fds[2] = {-1, -1};
  if (pipe2(fds, O_CLOEXEC) != 0)
    throw std::runtime_error(std::string("cannot open a pipe: ") + std::strerror(errno));
  fcntl(fds[1], F_SETPIPE_SZ, kPipeSize);
  return {FileDescriptor(fds[0]), FileDescriptor(fds[1])};
}

/// Runs in the child process. Until exec, it may only call async-signal-safe functions.
[[noreturn]] void Exec(char* const* argv, int output, int clouds, int error_log) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  // Makes a process group, so that Ctrl-C in the terminal reaches only the parent. The parent then
  // ends its children in order.
  setpgid(0, 0);
  dup2(output, STDOUT_FILENO);
  if (error_log >= 0) dup2(error_log, STDERR_FILENO);
  if (clouds == kCloudsFd) {
    fcntl(clouds, F_SETFD, 0);
  } else if (clouds >= 0) {
    dup2(clouds, kCloudsFd);
  }
  execv(argv[0], argv);
  _exit(127);
}

}  // namespace

ChildProcess::ChildProcess(const Config& config) {
  Pipe output = MakePipe();
  Pipe clouds;
  if (config.clouds_pipe) clouds = MakePipe();
  FileDescriptor error_log;
  if (!config.error_log.empty()) {
    error_log = FileDescriptor(
        open(config.error_log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
    if (!error_log) throw std::runtime_error("cannot write " + config.error_log);
  }
  std::vector<std::string> command = config.command;
  std::vector<char*> argv;
  argv.reserve(command.size() + 1);
  for (std::string& word : command) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error(std::string("cannot fork: ") + std::strerror(errno));
  if (pid_ == 0) Exec(argv.data(), output.write.get(), clouds.write.get(), error_log.get());
  fcntl(output.read.get(), F_SETFL, O_NONBLOCK);
  output_ = std::move(output.read);
  clouds_ = std::move(clouds.read);
}

ChildProcess::~ChildProcess() {
  if (Ended()) return;
  Signal(SIGKILL);
  Wait();
}

bool ChildProcess::ReadLines(const std::function<void(const std::string&)>& handler) {
  std::array<char, 65536> chunk{};
  while (true) {
    const ssize_t n = read(output_fd(), chunk.data(), chunk.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return n < 0;
    partial_.append(chunk.data(), static_cast<std::size_t>(n));
    std::size_t start = 0;
    for (std::size_t end = 0; (end = partial_.find('\n', start)) != std::string::npos;
         start = end + 1)
      handler(partial_.substr(start, end - start));
    partial_.erase(0, start);
  }
}

void ChildProcess::Signal(int signal) const {
  if (pid_ > 0 && status_ < 0) kill(pid_, signal);
}

bool ChildProcess::Ended() {
  if (status_ >= 0) return true;
  int status = 0;
  if (waitpid(pid_, &status, WNOHANG) != pid_) return false;
  status_ = status;
  return true;
}

int ChildProcess::Wait() {
  while (status_ < 0) {
    int status = 0;
    if (waitpid(pid_, &status, 0) == pid_) status_ = status;
  }
  return WIFSIGNALED(status_) ? 128 + WTERMSIG(status_) : WEXITSTATUS(status_);
}

std::string OwnFolder() {
  std::array<char, PATH_MAX> path{};
  const ssize_t n = readlink("/proc/self/exe", path.data(), path.size() - 1);
  const std::string name(path.data(), n > 0 ? static_cast<std::size_t>(n) : 0);
  return name.substr(0, name.rfind('/'));
}

}  // namespace lidar::tools
