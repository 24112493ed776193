// SPDX-License-Identifier: LGPL-2.1-or-later
// lidar-demo: a LiDAR stream across a bottleneck link, measured at both ends.
#include <gst/gst.h>

#include <CLI/CLI.hpp>
#include <random>
#include <string>

#include "src/tools/bench/demo/coordinator.h"
#include "src/tools/bench/demo/ends.h"
#include "src/tools/common/program.h"

namespace {

/// Makes a random key and puts it into the environment, where the list of processes does not show
/// it.
void MakeKey() {
  constexpr int kBytes = 16 + 14;  // key and salt
  constexpr const char* kDigits = "0123456789abcdef";
  std::random_device random;
  std::string key;
  for (int i = 0; i < 2 * kBytes; ++i) key += kDigits[random() % 16];
  g_setenv(lidar::demo::kKeyVariable, key.c_str(), TRUE);
}

int Run(int argc, char** argv) {
  CLI::App app{"lidar-demo: streams LiDAR through a bottleneck link and measures both ends.",
               "lidar-demo"};
  lidar::tools::AddVersionFlag(&app, "lidar-demo");
  app.require_subcommand(1);
  lidar::demo::RunOptions options;
  auto* run = app.add_subcommand("run", "Start sender, link and receiver; write a report");
  lidar::demo::AddRunOptions(run, &options);
  std::string pipeline;
  auto* send = app.add_subcommand("send", "The sending end (started by run)");
  auto* receive = app.add_subcommand("receive", "The receiving end (started by run)");
  for (auto* end : {send, receive})
    end->add_option("pipeline", pipeline, "As for gst-launch-1.0")->required();
  lidar::tools::Parse(&app, argc, argv, [&] {
    if (run->parsed()) lidar::demo::CheckRunOptions(options);
  });
  if (run->parsed()) {
    if (options.secure) MakeKey();
    return lidar::demo::RunDemo(options);
  }
  gst_init(nullptr, nullptr);
  const int code = send->parsed() ? lidar::demo::Send(pipeline) : lidar::demo::Receive(pipeline);
  gst_deinit();
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  return lidar::tools::Guard("lidar-demo", [&] { return Run(argc, argv); });
}
