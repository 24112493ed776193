// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs one end of a stream as a process. Reads commands from standard input.
#include <glib.h>

#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>

#include "tests/system/faults/ends.h"
#include "tests/system/faults/stepped_clock.h"

namespace {

using namespace lidar::test;  // NOLINT

struct End {
  End(bool sends, std::uint16_t port, const std::string& options) {
    if (sends) {
      sender.emplace(&sent, port, options);
    } else {
      receiver.emplace(nullptr, port, options);
    }
    pipeline().SetState(GST_STATE_PLAYING);
  }
  Pipeline& pipeline() { return sender ? sender->pipeline() : receiver->pipeline(); }

  /// Prints a line of numbers: slices sent, slices received, slices lost, slices damaged or
  /// mismatching, clouds, accepted feedback reports, datagrams that the kernel dropped, and the
  /// wall clock [us].
  void Report() {
    const Accounts a = receiver ? receiver->accounts() : Accounts();
    std::printf("%" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu64
                " %" PRIi64 "\n",
                sender ? sender->slices_sent() : 0, a.received, a.lost, a.damaged + a.mismatch,
                receiver ? receiver->clouds() : 0,
                sender ? pipeline().Stat("net", "feedback-accepted") : 0,
                receiver ? pipeline().Stat("net", "dropped-by-kernel") : 0, g_get_real_time());
  }

  SentSlices sent;
  std::optional<SendingEnd> sender;
  std::optional<ReceivingEnd> receiver;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: %s send|receive PORT OPTIONS\n", argv[0]);
    return 2;
  }
  gst_init(nullptr, nullptr);
  End end(std::string(argv[1]) == "send", static_cast<std::uint16_t>(std::atoi(argv[2])), argv[3]);
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    std::string command;
    int seconds = 0;
    words >> command >> seconds;
    if (command == "step") StepWallClock(seconds);
    if (command == "finish") end.pipeline().Finish(std::chrono::seconds(10));
    end.Report();
    std::fflush(stdout);
  }
  const std::string error = end.pipeline().Error();
  if (!error.empty()) std::fprintf(stderr, "%s\n", error.c_str());
  return error.empty() ? 0 : 1;
}
