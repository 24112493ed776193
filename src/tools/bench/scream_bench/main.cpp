// SPDX-License-Identifier: LGPL-2.1-or-later
// scream-bench: measures a network path with SCReAM v2.
#include <gst/gst.h>

#include "src/tools/bench/scream_bench/options.h"
#include "src/tools/bench/scream_bench/receiver.h"
#include "src/tools/bench/scream_bench/sender.h"
#include "src/tools/common/program.h"

int main(int argc, char** argv) {
  const auto options = lidar::tools::ParseBenchOptions(argc, argv);
  gst_init(nullptr, nullptr);
  return lidar::tools::Guard("scream-bench", [&] {
    return options.is_sender ? lidar::tools::RunSender(options)
                             : lidar::tools::RunReceiver(options);
  });
}
