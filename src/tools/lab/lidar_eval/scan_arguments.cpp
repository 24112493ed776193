// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/lab/lidar_eval/scan_arguments.h"

namespace lidar::tools {

void AddScanOptions(CLI::App* command, ScanArguments* a) {
  a->read.max_scans = 0;
  command->add_option("SOURCE", a->source, kSourceHelp)->required();
  command->add_option("--scans", a->read.max_scans, "Scans to read; 0: all");
  command->add_option("--speed", a->read.speed_mps, "Speed of synthetic drives [m/s]");
  command
      ->add_option(
          "--roughness", a->read.roughness,
          "Amplitude of synthetic cars' sway, heave and tilt, relative to the scene's usual road")
      ->check(CLI::Range(0.0, 20.0));
  command->add_option("--seed", a->read.seed, "Seed of synthetic drives");
  command->add_option("--noise", a->read.noise_m, "Standard deviation of synthetic ranges [m]")
      ->check(CLI::Range(0.0, 10.0));
  command->add_flag("--mixed-pixels", a->read.mixed_pixels,
                    "Synthetic ranges at edges lie between the two surfaces");
  command
      ->add_option("--step", a->loss.range_step_m,
                   "Put ranges on a grid of this step first, as lidarenc does [m]")
      ->check(CLI::Range(0.0, 10.0));
  command
      ->add_option("--xyz-bits", a->loss.xyz_bits,
                   "Put points on a grid of so many bits over their cube first, as the paper "
                   "does; 0: no")
      ->check(CLI::Range(0U, 30U));
  command
      ->add_option("--lost-scans", a->faults.lost_share,
                   "Leave out this share of the scans, three at a time")
      ->check(CLI::Range(0.0, 0.9));
  command
      ->add_option("--gap", a->faults.gap_s,
                   "Leave out the scans of this time, ten seconds after the first scan [s]")
      ->check(CLI::Range(0.0, 3600.0));
  command->add_option("--every-beam", a->faults.every_beam, "Keep each n-th beam; 2: half of them")
      ->check(CLI::Range(1U, 64U));
  command->add_option("--every-scan", a->faults.every_scan, "Keep each n-th scan; 5: two a second")
      ->check(CLI::Range(1U, 64U));
}

std::unique_ptr<ScanStream> OpenScans(const ScanArguments& a) {
  return WithFaults(OpenScans(a.source, a.read), a.faults);
}

}  // namespace lidar::tools
