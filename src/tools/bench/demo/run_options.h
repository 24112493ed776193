// SPDX-License-Identifier: LGPL-2.1-or-later
// The command line of `lidar-demo run`, and its meaning.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "src/base/time.h"
#include "src/link/capacity.h"

namespace CLI {
class App;
}

namespace lidar::demo {

struct RunOptions {
  double duration_s = 40;
  std::string output = "demo-output";
  bool plots = true;
  // Source
  std::string model = "os1-64";
  std::string mode = "1024x10";
  std::string scene = "street";
  double speed_mps = 12;
  std::uint32_t seed = 1;
  std::uint32_t slices = 0;
  bool slam = false;  // the receiver computes the poses of the sensor
  bool view = false;  // both ends serve a page to browsers
  std::string pcap;
  std::string scans;  // folder of scans
  std::string metadata;
  // Encoder
  std::string encoder;  // empty: chosen according to `geometry`
  double max_error_m = 0.05;
  std::string geometry = "auto";
  double fixed_step_m = 0;
  int fixed_bits = 0;
  double max_bitrate_mbps = 100;
  double start_bitrate_mbps = 4;
  // Links
  std::size_t links = 1;
  std::vector<double> steps_mbps{4, 2.2, 3, 1.8, 4.4, 2.6};
  double rate_mbps = 0;
  std::vector<std::string> traces;  // none, or one for each link
  bool drive = false;
  double rtt_ms = 40;
  double loss_percent = 0;
  bool no_l4s = false;
  bool secure = false;  // SRTP with a key that is made for this run
};

/// The environment variable that contains the key of --secure, in hexadecimal digits.
inline constexpr const char* kKeyVariable = "LIDAR_DEMO_SRTP_KEY";

void AddRunOptions(CLI::App* app, RunOptions* options);
/// Checks that the options do not contradict each other. If they do, throws CLI::ValidationError
/// with a text for the user.
void CheckRunOptions(const RunOptions& options);

/// Returns "lidarenc" or "dracoenc".
std::string EncoderOf(const RunOptions& options);
/// Returns the fixed quantisation step [m], or 0 if the encoder adapts its step.
double FixedStepOf(const RunOptions& options);
/// Returns the largest distance that is allowed between a sent point and the received point [m].
double ErrorBoundOf(const RunOptions& options);
/// Returns the capacity of each link.
std::vector<link::Capacity> CapacitiesOf(const RunOptions& options);
/// Returns the times at which the capacity changes from one of --steps to the next. Returns none if
/// there are several links, or if the capacity does not come from --steps.
std::vector<Duration> ChangesOf(const RunOptions& options);

/// Returns the capacity trace that --drive generates for a link.
std::string DriveTraceOf(const RunOptions& options, std::size_t index);
/// Returns the path of a link's file in the folder of the report. The path of the first link ends
/// in `name`. For the second link, a 2 is inserted before the extension, and so on.
std::string LinkFile(const RunOptions& options, const std::string& name, std::size_t index);

struct Ports {
  std::vector<int> links;
  int receiver = 0;
};
/// Returns the address of the page of --view, or an empty text without --view.
std::string PageOf(const RunOptions& options);
std::string SenderPipeline(const RunOptions& options, const Ports& ports);
std::string ReceiverPipeline(const RunOptions& options, const Ports& ports);
std::vector<std::string> LinkArguments(const RunOptions& options, const Ports& ports,
                                       std::size_t index);

}  // namespace lidar::demo
