// SPDX-License-Identifier: LGPL-2.1-or-later
// lidar-eval: measures how much bitrate an error bound needs, and how closely a bitrate is met.

#include "src/tools/common/output_file.h"
#include "src/tools/common/program.h"
#include "src/tools/lab/lidar_eval/commands.h"

int main(int argc, char** argv) {
  CLI::App app("Measures the codec and the rate control on captures, clouds and synthetic drives.",
               "lidar-eval");
  lidar::tools::AddVersionFlag(&app, "lidar-eval");
  lidar::tools::AddHelpAllFlag(&app);
  app.require_subcommand(1);
  lidar::tools::AddBoundsCommand(&app);
  lidar::tools::AddRateDistortionCommand(&app);
  lidar::tools::AddCloudsCommand(&app);
  lidar::tools::AddStaticCommand(&app);
  lidar::tools::AddPredictCommand(&app);
  lidar::tools::AddTrackCommand(&app);
  lidar::tools::AddToPcapCommand(&app);
#ifdef HAVE_ODOMETRY
  lidar::tools::AddSlamCommand(&app);
  lidar::tools::AddAteCommand(&app);
  lidar::tools::AddToKittiCommand(&app);
#endif
  return lidar::tools::Guard("lidar-eval", [&] {
    lidar::tools::Parse(&app, argc, argv);  // runs the command
    lidar::tools::FinishStandardOutput();
    return 0;
  });
}
