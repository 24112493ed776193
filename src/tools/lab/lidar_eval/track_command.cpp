// SPDX-License-Identifier: LGPL-2.1-or-later
// lidar-eval track: measures how closely the rate controller follows a target.
#include <cstdio>
#include <map>
#include <memory>

#include "src/tools/lab/codec_lab/measure.h"
#include "src/tools/lab/codec_lab/model_option.h"
#include "src/tools/lab/codec_lab/plot.h"
#include "src/tools/lab/codec_lab/scan_source.h"
#include "src/tools/lab/codec_lab/tracking.h"
#include "src/tools/lab/lidar_eval/commands.h"

namespace lidar::tools {
namespace {

struct TrackArguments {
  std::string source;
  SourceOptions read;
  TrackOptions track;
  std::string mode;
  std::vector<std::string> profiles = {"steady", "walk", "jump"};
  std::string targets;
  std::size_t length = 200;
  ProfileOptions profile;
  rate::RateModel rate_model = rate::RateModel::kAdaptive;
  std::string model;
  std::size_t settle = 2;
  std::string csv;
  std::string plot;
};

void Draw(const std::string& png, const ScanSet& set, const std::vector<TrackedScan>& scans) {
  std::string data = "$d << EOD\n";
  for (std::size_t i = 0; i < scans.size(); ++i)
    data += Format("%g,%g,%g\n", static_cast<double>(i) / set.scans_per_second,
                   1e-6 * scans[i].target_bps, 1e-6 * scans[i].sent_bps);
  Plot(png, data +
                "EOD\nset xlabel 'time [s]'\nset ylabel 'Mbit/s'\nset yrange [0:*]\n"
                "set title '" +
                set.name +
                "' noenhanced\n"
                "plot $d using 1:2 with steps lw 2 lc rgb '#888888' title 'target', "
                "$d using 1:3 with points pt 7 ps 0.5 lc rgb '#c03020' title 'sent, each scan'");
}

std::vector<double> Targets(const std::string& name, const TrackArguments& o,
                            double scans_per_second) {
  if (name == "recorded") return ReadTargets(o.targets, scans_per_second);
  const std::map<std::string, TargetProfile> profiles = {{"steady", TargetProfile::kSteady},
                                                         {"walk", TargetProfile::kWalk},
                                                         {"jump", TargetProfile::kJump}};
  return MakeTargets(profiles.at(name), o.length, o.profile);
}

/// Returns `path` with `name` before its extension if `several` is true: "x-walk.png" for "x.png"
/// and "walk". Otherwise returns `path`.
std::string PathFor(const std::string& path, const std::string& name, bool several) {
  if (path.empty() || !several) return path;
  const std::size_t dot = path.find_last_of("./");
  const bool has_extension = dot != std::string::npos && path[dot] == '.';
  return has_extension ? path.substr(0, dot) + "-" + name + path.substr(dot) : path + "-" + name;
}

void RunTrack(TrackArguments o) {
  const ScanSet set = LoadScans(o.source, o.read);
  o.track.mode = o.mode.empty() ? &DefaultMode(set) : &ModeNamed(o.mode);
  const rate::RateBounds bounds = MeasureBounds(set, o.track);
  // The limits are narrower than the bounds by this factor, because the bounds move with the scene.
  constexpr double kBoundsMargin = 1.15;
  if (o.profile.min_bps <= 0) o.profile.min_bps = kBoundsMargin * bounds.nominal.bits_per_second();
  if (o.profile.max_bps <= 0) o.profile.max_bps = bounds.max.bits_per_second() / kBoundsMargin;
  if (o.profile.steady_bps <= 0)
    o.profile.steady_bps = std::sqrt(o.profile.min_bps * o.profile.max_bps);
  std::printf(
      "%s, %s, %u slice(s) a scan, %u intensity bits, error bound %g m:\n"
      "r_min %.3f, nominal %.3f, largest useful %.3f Mbit/s\n",
      set.name.c_str(), o.track.mode->name.c_str(), o.track.slices, o.track.intensity_bits,
      o.track.max_error_m, 1e-6 * bounds.min.bits_per_second(),
      1e-6 * bounds.nominal.bits_per_second(), 1e-6 * bounds.max.bits_per_second());
  std::printf("%-9s %6s %9s %9s %12s %11s %8s %12s %10s\n", "target", "scans", "mean |e|",
              "p95 |e|", "furthest over", "re-encoded", "skipped", "error bound", "r_min off");
  if (!o.targets.empty()) o.profiles = {"recorded"};
  const bool several = o.profiles.size() > 1;
  for (const std::string& name : o.profiles) {
    const auto scans = Track(set, Targets(name, o, set.scans_per_second), o.track,
                             MakeModelOrThrow(LoadModelFile(o.model), o.rate_model));
    const TrackSummary s = Summarise(scans, o.settle, o.track.slices);
    std::printf("%-9s %6zu %7.2f %% %7.2f %% %10.2f %% %9.1f %% %8zu %9.1f mm %8.1f %%\n",
                name.c_str(), scans.size(), 100 * s.mean, 100 * s.percentile_95,
                100 * s.largest_over, 100 * s.reencoded, s.skipped, 1e3 * s.largest_bound_m,
                100 * MinimumError(set, o.track, scans, o.settle));
    CsvFile csv(PathFor(o.csv, name, several),
                "scan,target_bps,sent_bps,coarsest_step_m,error_bound_m,intensity_bits,"
                "keep_fraction,skipped,slices_reencoded");
    for (std::size_t i = 0; i < scans.size(); ++i)
      csv.Row(Format("%zu,%.0f,%.0f,%g,%g,%u,%g,%d,%u", i, scans[i].target_bps, scans[i].sent_bps,
                     scans[i].coarsest_step_m, scans[i].largest_bound_m, scans[i].intensity_bits,
                     scans[i].keep_fraction, scans[i].skipped ? 1 : 0, scans[i].reencoded));
    csv.Close();
    if (!o.plot.empty()) Draw(PathFor(o.plot, name, several), set, scans);
  }
}

}  // namespace

void AddTrackCommand(CLI::App* app) {
  auto o = std::make_shared<TrackArguments>();
  CLI::App* command = app->add_subcommand(
      "track", "Rate controller and codec on a steady, walking, jumping or recorded target");
  command->option_defaults()->always_capture_default();
  command->add_option("SOURCE", o->source, kSourceHelp)->required();
  command->add_option("--profiles", o->profiles, "steady, walk, jump; comma-separated")
      ->delimiter(',')
      ->check(CLI::IsMember({"steady", "walk", "jump"}));
  command->add_option("--targets", o->targets, "Targets from lines of 'time_s rate_mbps' instead")
      ->check(CLI::ExistingFile);
  command->add_option("--length", o->length, "Scans of each profile")->check(CLI::Range(3, 100000));
  command->add_option("--rate", o->profile.steady_bps, "Rate of steady [bit/s]; 0: the middle");
  command->add_option(
      "--min-rate", o->profile.min_bps,
      "Least rate of walk and jump [bit/s]; 0: a little above what the bound needs");
  command->add_option(
      "--max-rate", o->profile.max_bps,
      "Greatest rate of walk and jump [bit/s]; 0: a little below the largest useful");
  command->add_option("--seed", o->profile.seed, "Seed of walk and jump");
  command->add_option("--mode", o->mode, "Coding mode; empty: by the source");
  command->add_option("--max-error", o->track.max_error_m, "Error bound [m]")
      ->check(CLI::Range(0.0005, 10.0));
  command->add_option("--intensity-bits", o->track.intensity_bits, "0: geometry only")
      ->check(CLI::Range(0U, codec::IntensityScale::kMaxBits));
  command->add_option("--slices", o->track.slices, "Slices per scan")->check(CLI::Range(1U, 64U));
  const std::map<std::string, rate::RateModel> models = {{"adaptive", rate::RateModel::kAdaptive},
                                                         {"paper", rate::RateModel::kPaper}};
  command->add_option("--rate-model", o->rate_model, "adaptive or paper")
      ->transform(CLI::CheckedTransformer(models).description("adaptive|paper"));
  command->add_option("--model", o->model, "Model file of lidar-train; empty: the built-in one");
  command->add_flag("--open-loop", o->track.open_loop,
                    "As in the paper: no carry-over, no second try");
  const std::map<std::string, rate::DegradationPreference> preferences = {
      {"maintain-accuracy", rate::DegradationPreference::kMaintainAccuracy},
      {"maintain-framerate", rate::DegradationPreference::kMaintainFramerate},
      {"balanced", rate::DegradationPreference::kBalanced}};
  command
      ->add_option("--degradation-preference", o->track.degradation, "What to reduce below r_min")
      ->transform(CLI::CheckedTransformer(preferences)
                      .description("maintain-accuracy|maintain-framerate|balanced"));
  command->add_option("--settle", o->settle, "First scans that do not count");
  command->add_option("--scans", o->read.max_scans, "Scans to read, played there and back");
  command->add_option("--speed", o->read.speed_mps, "Speed of synthetic drives [m/s]");
  command->add_option("--csv", o->csv, "Write every scan to this file, one a profile");
  command->add_option("--plot", o->plot, "Draw it as this PNG, one a profile");
  command->callback([o] { RunTrack(*o); });
}

}  // namespace lidar::tools
