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
  bool slam = false;  // the edge finds the sensor's poses
  bool view = false;  // both ends serve a page to browsers
  std::string pcap;
  std::string scans;  // a folder
  std::string metadata;
  // Encoder
  std::string encoder;  // empty: the one for the geometry
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
  std::vector<std::string> traces;  // none, or one a link
  bool drive = false;
  double rtt_ms = 40;
  double loss_percent = 0;
  bool no_l4s = false;
  bool secure = false;  // SRTP, by a key of this run in the environment
};

/// Environment variable with the key of --secure in hexadecimal digits.
inline constexpr const char* kKeyVariable = "LIDAR_DEMO_SRTP_KEY";

void AddRunOptions(CLI::App* app, RunOptions* options);
/// Throws std::runtime_error with a text for the user if options contradict each other.
void CheckRunOptions(const RunOptions& options);

/// lidarenc, or dracoenc.
std::string EncoderOf(const RunOptions& options);
/// Zero if the encoder adapts.
double FixedStepOf(const RunOptions& options);
/// The largest distance allowed between a sent point and the received one.
double ErrorBoundOf(const RunOptions& options);
/// The capacity of each link.
std::vector<link::Capacity> CapacitiesOf(const RunOptions& options);
/// Times at which the capacity of a single link steps during the run; empty for a trace.
std::vector<Duration> ChangesOf(const RunOptions& options);

/// The text of the capacity trace of --drive.
std::string DriveTraceOf(const RunOptions& options, std::size_t index);
/// Path of a link's file `name` in the report's folder. For the second link, the name gets a 2
/// before the extension.
std::string LinkFile(const RunOptions& options, const std::string& name, std::size_t index);

struct Ports {
  std::vector<int> links;
  int receiver = 0;
};
/// Address of the page of --view; empty without it.
std::string PageOf(const RunOptions& options);
std::string SenderPipeline(const RunOptions& options, const Ports& ports);
std::string ReceiverPipeline(const RunOptions& options, const Ports& ports);
std::vector<std::string> LinkArguments(const RunOptions& options, const Ports& ports,
                                       std::size_t index);

}  // namespace lidar::demo
