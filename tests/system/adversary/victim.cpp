// SPDX-License-Identifier: LGPL-2.1-or-later
// Plays a pipeline that is the victim of a test. Reads commands from standard input, one per line.
// Answers each of them with a line of JSON that describes the state of the pipeline.
#include <gst/gst.h>
#include <gst/net/net.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <fstream>
#include <iostream>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>

#include "gst/common/buffer_map.h"
#include "gst/common/refs.h"
#include "src/base/crc.h"
#include "tests/support/metronome.h"
#include "tests/support/patience.h"

namespace {

using namespace lidar::gst;

// The largest number of slices whose checksums are kept between two reports.
constexpr std::size_t kMaxRemembered = 100'000;

/// Counts the buffers that pass a pad. Keeps the CRC-32 of each buffer until the next report.
class Tap {
 public:
  void Watch(GstElement* pipeline, const char* element, const char* pad_name) {
    const ElementPtr owner(gst_bin_get_by_name(GST_BIN(pipeline), element));
    if (!owner) return;
    const PadPtr pad(gst_element_get_static_pad(owner.get(), pad_name));
    gst_pad_add_probe(
        pad.get(),
        static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_BUFFER_LIST),
        [](GstPad*, GstPadProbeInfo* info, gpointer self) {
          static_cast<Tap*>(self)->OnProbe(*info);
          return GST_PAD_PROBE_OK;
        },
        this, nullptr);
  }

  std::string Take() {
    std::lock_guard lock(mutex_);
    std::string list;
    for (const std::uint32_t hash : hashes_)
      list += (list.empty() ? "" : ",") + std::to_string(hash);
    hashes_.clear();
    return "[" + list + "]";
  }
  std::uint64_t count() const {
    std::lock_guard lock(mutex_);
    return count_;
  }

 private:
  void OnProbe(const GstPadProbeInfo& info) {
    if ((info.type & GST_PAD_PROBE_TYPE_BUFFER) != 0) return Add(GST_BUFFER(info.data));
    auto* list = static_cast<GstBufferList*>(info.data);
    for (guint i = 0; i < gst_buffer_list_length(list); ++i) Add(gst_buffer_list_get(list, i));
  }
  void Add(GstBuffer* buffer) {
    const BufferMap map(buffer, GST_MAP_READ);
    std::lock_guard lock(mutex_);
    ++count_;
    if (hashes_.size() < kMaxRemembered) hashes_.push_back(lidar::Crc32(map.view()));
  }

  mutable std::mutex mutex_;
  std::deque<std::uint32_t> hashes_;
  std::uint64_t count_ = 0;
};

std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return quoted + "\"";
}

/// Returns the numbers in the property `stats` of an element, as the members of a JSON object.
std::string Stats(GstElement* pipeline, const char* name) {
  const ElementPtr element(gst_bin_get_by_name(GST_BIN(pipeline), name));
  if (!element ||
      g_object_class_find_property(G_OBJECT_GET_CLASS(element.get()), "stats") == nullptr)
    return "{}";
  GstStructure* stats = nullptr;
  g_object_get(element.get(), "stats", &stats, nullptr);
  if (stats == nullptr) return "{}";
  const StructurePtr owner(stats);
  std::string members;
  for (int i = 0; i < gst_structure_n_fields(stats); ++i) {
    const gchar* field = gst_structure_nth_field_name(stats, static_cast<guint>(i));
    GValue number = G_VALUE_INIT;
    g_value_init(&number, G_TYPE_DOUBLE);
    const GValue* value = gst_structure_get_value(stats, field);
    if (!G_VALUE_HOLDS_STRING(value) && g_value_transform(value, &number))
      members += (members.empty() ? "" : ",") + Quoted(field) + ":" +
                 std::to_string(g_value_get_double(&number));
    g_value_unset(&number);
  }
  return "{" + members + "}";
}

/// Returns the value of a line of /proc/self/status. It is a size [kB] or a count.
long Status(const std::string& name) {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);)
    if (line.rfind(name + ":", 0) == 0) return std::stol(line.substr(name.size() + 1));
  return -1;
}

double CpuSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec) / 1e6;
}

/// Forks, as an application does that uses Python's subprocess. Returns the exit code of the child,
/// or -1 if the child did not exit normally within kPatience. If `becomes_another` is true, the
/// child executes another program, whose exit code is the number of network sockets that it
/// inherited.
int ForkAndWait(bool becomes_another) {
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    if (!becomes_another) _exit(0);
    // Counts only the sockets of UDP and TCP, because GStreamer's bus has a pair of local sockets,
    // too.
    execl("/bin/sh", "sh", "-c",
          "exit $(ls -l /proc/self/fd | sed -n 's/.*socket:.\\([0-9]*\\).*/\\1/p' | while read -r "
          "i; do "
          "grep -h \" $i \" /proc/net/udp /proc/net/udp6 /proc/net/tcp; done | wc -l)",
          nullptr);
    _exit(127);
  }
  int status = 0;
  if (lidar::test::Eventually([&] { return waitpid(child, &status, WNOHANG) == child; }))
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  return -1;
}

/// A second stream that is added to the sink `net` and removed again while the first stream plays.
class Branch {
 public:
  explicit Branch(GstElement* pipeline)
      : pipeline_(GST_BIN(pipeline)), net_(gst_bin_get_by_name(pipeline_, "net")) {
    bin_ = gst_parse_bin_from_description(
        "lidartestsrc is-live=true model=os0-32 mode=512x10 seed=9 ! lidarenc effort=0 ! "
        "rtplidarpay",
        TRUE, nullptr);
    gst_bin_add(pipeline_, bin_);
    pad_.reset(gst_element_request_pad_simple(net_.get(), "sink_%u"));
    const PadPtr from(gst_element_get_static_pad(bin_, "src"));
    gst_pad_link(from.get(), pad_.get());
    gst_element_sync_state_with_parent(bin_);
  }
  /// Releases the pad while packets may still be on their way to it.
  ~Branch() {
    gst_element_set_locked_state(bin_, TRUE);
    const PadPtr from(gst_element_get_static_pad(bin_, "src"));
    gst_element_release_request_pad(net_.get(), pad_.get());
    gst_element_set_state(bin_, GST_STATE_NULL);
    gst_bin_remove(pipeline_, bin_);
  }
  Branch(const Branch&) = delete;
  Branch& operator=(const Branch&) = delete;

 private:
  GstBin* pipeline_;
  ElementPtr net_;
  GstElement* bin_ = nullptr;
  PadPtr pad_;
};

class Victim {
 public:
  explicit Victim(const char* description) {
    GError* error = nullptr;
    pipeline_.reset(gst_parse_launch(description, &error));
    if (error != nullptr) {
      const ErrorPtr owner(error);
      std::fprintf(stderr, "%s: %s\n", description, error->message);
      pipeline_.reset();
    }
    if (!pipeline_) return;
    slices_.Watch(pipeline_.get(), "depay", "src");
    clouds_.Watch(pipeline_.get(), "out", "sink");
    SetState(GST_STATE_PLAYING);
  }
  ~Victim() {
    if (pipeline_) SetState(GST_STATE_NULL);
  }
  Victim(const Victim&) = delete;
  Victim& operator=(const Victim&) = delete;

  bool exists() const { return pipeline_ != nullptr; }

  /// Sets the state, and returns how long the change took [ms]. Waits at most 10 s for the new
  /// state.
  long SetState(GstState state) {
    const auto start = metronome_.elapsed();
    if (gst_element_set_state(pipeline_.get(), state) == GST_STATE_CHANGE_ASYNC)
      gst_element_get_state(pipeline_.get(), nullptr, nullptr, 10 * GST_SECOND);
    return (metronome_.elapsed() - start).count();
  }

  long Obey(const std::string& command, int argument) {
    if (command == "null") return SetState(GST_STATE_NULL);
    if (command == "play") return SetState(GST_STATE_PLAYING);
    if (command == "fork") return ForkAndWait(false);
    if (command == "spawn") return ForkAndWait(true);
    if (command == "provide") return ProvideClock();
    if (command == "follow") return FollowClock(argument);
    if (command == "pads") {
      for (int i = 0; i < argument; ++i) {
        const Branch branch(pipeline_.get());
        g_usleep(static_cast<gulong>(i % 5) * 20'000);
      }
    }
    return 0;
  }

  void Report(long took) {
    ReadBus();
    std::string stats;
    for (const char* name : {"net", "depay", "dec", "pay", "src"})
      stats += "," + Quoted(name) + ":" + Stats(pipeline_.get(), name);
    std::printf(
        "{\"took\":%ld,\"clouds\":%llu,\"slices\":%s,\"error\":%s,\"warnings\":%u,"
        "\"eos\":%s,\"threads\":%ld,\"rss_kb\":%ld,\"cpu\":%.3f%s}\n",
        took, static_cast<unsigned long long>(clouds_.count()), slices_.Take().c_str(),
        Quoted(error_).c_str(), warnings_, eos_ ? "true" : "false", Status("Threads"),
        Status("VmRSS"), CpuSeconds(), stats.c_str());
    std::fflush(stdout);
  }

 private:
  /// Starts to serve the clock of this pipeline to other hosts. Returns the port.
  long ProvideClock() {
    const std::unique_ptr<GstClock, Unref> clock(
        gst_pipeline_get_clock(GST_PIPELINE(pipeline_.get())));
    provider_.reset(GST_OBJECT(gst_net_time_provider_new(clock.get(), "127.0.0.1", 0)));
    gint port = 0;
    g_object_get(provider_.get(), "port", &port, nullptr);
    return port;
  }

  /// Makes the pipeline use the clock that is served at `port` of this host. Returns 1 if the
  /// pipeline uses that clock afterwards.
  long FollowClock(int port) {
    const std::unique_ptr<GstClock, Unref> clock(
        gst_net_client_clock_new("net", "127.0.0.1", port, 0));
    if (!gst_clock_wait_for_sync(clock.get(), lidar::test::kPatience_ns)) return 0;
    SetState(GST_STATE_NULL);
    gst_pipeline_use_clock(GST_PIPELINE(pipeline_.get()), clock.get());
    SetState(GST_STATE_PLAYING);
    const std::unique_ptr<GstClock, Unref> used(gst_element_get_clock(pipeline_.get()));
    return used == clock ? 1 : 0;
  }

  void ReadBus() {
    GstBus* bus = gst_element_get_bus(pipeline_.get());
    while (const MessagePtr message{gst_bus_pop(bus)}) {
      if (GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_WARNING) ++warnings_;
      if (GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_EOS) eos_ = true;
      if (GST_MESSAGE_TYPE(message.get()) != GST_MESSAGE_ERROR) continue;
      // Ignores the messages of elements that were removed from the pipeline. A source whose pad
      // was removed during a stream may post an error that the pad is not linked.
      if (!gst_object_has_as_ancestor(GST_MESSAGE_SRC(message.get()), GST_OBJECT(pipeline_.get())))
        continue;
      GError* error = nullptr;
      gst_message_parse_error(message.get(), &error, nullptr);
      const ErrorPtr owner(error);
      if (error_.empty()) error_ = error->message;
    }
    gst_object_unref(bus);
  }

  Tap slices_;
  Tap clouds_;
  ElementPtr pipeline_;
  std::unique_ptr<GstObject, Unref> provider_;
  std::string error_;
  unsigned warnings_ = 0;
  bool eos_ = false;
  const lidar::test::Metronome metronome_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s PIPELINE\n", argv[0]);
    return 2;
  }
  gst_init(nullptr, nullptr);
  {
    Victim victim(argv[1]);
    if (!victim.exists()) return 2;
    victim.Report(0);
    for (std::string line; std::getline(std::cin, line);) {
      std::istringstream words(line);
      std::string command;
      int argument = 0;
      words >> command >> argument;
      victim.Report(victim.Obey(command, argument));
    }
  }
  gst_deinit();
  return 0;
}
