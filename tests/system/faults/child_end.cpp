// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/system/faults/child_end.h"

#include <unistd.h>

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace lidar::test {

using std::chrono::milliseconds;

ChildEnd::ChildEnd(const char* role, std::uint16_t port, const std::string& options) {
  const gchar* program = g_getenv("FAULT_END");
  if (program == nullptr) throw std::runtime_error("FAULT_END does not name the program fault-end");
  process_ = g_subprocess_new(
      static_cast<GSubprocessFlags>(G_SUBPROCESS_FLAGS_STDIN_PIPE | G_SUBPROCESS_FLAGS_STDOUT_PIPE),
      nullptr, program, role, std::to_string(port).c_str(), options.c_str(), nullptr);
  if (process_ == nullptr) throw std::runtime_error("fault-end cannot be started");
  answers_ = g_data_input_stream_new(g_subprocess_get_stdout_pipe(process_));
  // Waits until the end plays, because only then does it answer.
  Report();
}

ChildEnd::~ChildEnd() {
  if (process_ != nullptr) Close();
}

bool ChildEnd::Close() {
  g_output_stream_close(g_subprocess_get_stdin_pipe(process_), nullptr, nullptr);
  const bool good = g_subprocess_wait_check(process_, nullptr, nullptr) != FALSE;
  g_clear_object(&answers_);
  g_clear_object(&process_);
  return good;
}

ChildReport ChildEnd::Ask(const std::string& command) {
  const std::string line = command + "\n";
  g_output_stream_write_all(g_subprocess_get_stdin_pipe(process_), line.data(), line.size(),
                            nullptr, nullptr, nullptr);
  gchar* answer = g_data_input_stream_read_line(answers_, nullptr, nullptr, nullptr);
  if (answer == nullptr) throw std::runtime_error("fault-end has ended");
  std::istringstream words(answer);
  g_free(answer);
  ChildReport r;
  words >> r.sent >> r.received >> r.lost >> r.bad >> r.clouds >> r.feedback >>
      r.dropped_by_kernel >> r.wall_clock;
  return r;
}

milliseconds ChildEnd::NextCloud(milliseconds limit) {
  const auto start = std::chrono::steady_clock::now();
  const std::uint64_t before = Report().clouds;
  while (Report().clouds == before) {
    if (std::chrono::steady_clock::now() - start > limit) return milliseconds::max();
    std::this_thread::sleep_for(milliseconds(2));
  }
  return std::chrono::duration_cast<milliseconds>(std::chrono::steady_clock::now() - start);
}

std::string ChildEnd::Proc(const char* file) const {
  std::ifstream in(std::string("/proc/") + g_subprocess_get_identifier(process_) + "/" + file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

milliseconds ChildEnd::CpuTime() const {
  const std::string stat = Proc("stat");
  std::istringstream words(stat.substr(stat.rfind(')') + 2));
  std::string skipped;
  // The fields after these are utime and stime.
  for (int i = 0; i < 11; ++i) words >> skipped;
  long user = 0, system = 0;
  words >> user >> system;
  return milliseconds((user + system) * 1'000 / sysconf(_SC_CLK_TCK));
}

std::uint64_t ChildEnd::PeakMemory() const {
  const std::string status = Proc("status");
  const auto at = status.find("VmHWM:");
  // The value in the file is in kB.
  return at == std::string::npos ? UINT64_MAX : std::stoull(status.substr(at + 6)) * 1'024;
}

}  // namespace lidar::test
