// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/demo/run_options.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "src/bonding/packet_id.h"
#include "src/link/trace_maker.h"
#include "src/tools/bench/demo/scan_folder.h"

namespace lidar::demo {
namespace {

/// The edge of the cube around the scan. --fixed-bits is the number of bits for each coordinate in
/// this cube, which a sensor with a range of 100 m fills.
constexpr double kFixedBitsExtentM = 200;

/// The mean capacities of --drive, for a synthetic source and for a capture. They are between the
/// least and the greatest bitrate of the source.
constexpr double kDriveMbps = 4;
constexpr double kDriveOfCaptureMbps = 8;
constexpr double kDriveTail_s = 60;  // added to the trace, for a stream that starts late

constexpr int kReceiverPage = 8765;
constexpr int kSenderPage = 8766;

std::string Number(double value) {
  std::ostringstream out;
  out.precision(12);
  out << value;
  return out.str();
}

std::string Quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

std::string Bps(double mbps) { return std::to_string(std::llround(mbps * 1e6)); }

double StepTime(const RunOptions& o) {
  return o.duration_s / static_cast<double>(o.steps_mbps.size());
}

std::string KeyOf(const RunOptions& o) {
  return o.secure ? std::string(" srtp-key=env:") + kKeyVariable : "";
}

std::string SourceOf(const RunOptions& o) {
  const std::string common =
      " name=source is-live=true slices-per-scan=" + std::to_string(o.slices);
  if (!o.pcap.empty())
    return "ouster_src location=" + Quoted(o.pcap) +
           (o.metadata.empty() ? "" : " metadata=" + Quoted(o.metadata)) + " loop=true" + common;
  if (!o.scans.empty())
    return "multifilesrc loop=true location=" + Quoted(ScansPattern(o.output)) +
           " ! pointcloudparse framerate=10/1 ! identity sync=true name=source";
  return "lidartestsrc model=" + o.model + " mode=" + o.mode + " scene=" + o.scene +
         " speed=" + Number(o.speed_mps) + " seed=" + std::to_string(o.seed) +
         (o.slam ? " trajectory-location=" + Quoted(o.output + "/truth.tum") : "") + common;
}

/// Returns true if the clouds have ranges. Only clouds of Ouster sensors have them.
bool HasRanges(const RunOptions& o) {
  if (o.geometry == "xyz" || !o.scans.empty()) return false;
  return !o.pcap.empty() || o.model.rfind("os", 0) == 0;
}

void AddSourceOptions(CLI::App* app, RunOptions* o) {
  app->add_option("--model", o->model,
                  "Synthetic sensor: os0-32 ... os2-128, vlp-16, xt32, at128, mid-360")
      ->check(CLI::IsMember({"os0-32", "os0-64", "os0-128", "os1-32", "os1-64", "os1-128", "os2-32",
                             "os2-64", "os2-128", "vlp-16", "xt32", "at128", "mid-360"}))
      ->capture_default_str();
  app->add_option("--mode", o->mode,
                  "Mode of an Ouster, columns x scans/s: 512x10, 1024x10, 1024x20, 2048x10")
      ->capture_default_str();
  app->add_option("--scene", o->scene, "Synthetic world: street, tunnel, field, town")
      ->capture_default_str();
  app->add_option("--speed", o->speed_mps, "Speed of the vehicle [m/s]")->capture_default_str();
  app->add_option("--seed", o->seed, "Seed of the synthetic world and the link")
      ->capture_default_str();
  app->add_option("--slices", o->slices, "Slices a scan; 0: automatic, 1: whole scans")
      ->capture_default_str();
  auto* pcap = app->add_option("--pcap", o->pcap, "Stream an Ouster capture, over and over")
                   ->check(CLI::ExistingFile);
  app->add_option("--scans", o->scans,
                  "Stream a folder of scans, over and over, 10 a second: PCD, PLY, LAS or KITTI")
      ->check(CLI::ExistingDirectory)
      ->excludes(pcap);
  app->add_option("--metadata", o->metadata,
                  "Sensor metadata of --pcap (JSON), if it is not beside the capture")
      ->check(CLI::ExistingFile)
      ->needs(pcap);
}

void AddCodecOptions(CLI::App* app, RunOptions* o) {
  app->add_option("--encoder", o->encoder,
                  "lidarenc or dracoenc; default: lidarenc, or dracoenc where --geometry is xyz")
      ->check(CLI::IsMember({"lidarenc", "dracoenc"}));
  app->add_option("--max-error", o->max_error_m, "Largest error of any point [m]")
      ->check(CLI::Range(0.001, 10.0))
      ->capture_default_str();
  app->add_option("--geometry", o->geometry, "auto, range or xyz")
      ->check(CLI::IsMember({"auto", "range", "xyz"}))
      ->capture_default_str();
  auto* step =
      app->add_option("--fixed-step", o->fixed_step_m, "No adaptation: this quantisation step [m]")
          ->check(CLI::Range(0.0001, 10.0));
  app->add_option("--fixed-bits", o->fixed_bits,
                  "No adaptation: the step of a cube of 200 m with this many bits")
      ->check(CLI::Range(1, 20))
      ->excludes(step);
  app->add_option("--max-bitrate", o->max_bitrate_mbps, "The sender's upper limit [Mbit/s]")
      ->check(CLI::Range(0.01, 4000.0))
      ->capture_default_str();
  app->add_option("--start-bitrate", o->start_bitrate_mbps, "The sender's first target [Mbit/s]")
      ->check(CLI::Range(0.01, 4000.0))
      ->capture_default_str();
}

void AddPathOptions(CLI::App* app, RunOptions* o) {
  app->add_option("--links", o->links, "Links that one stream goes over")
      ->check(CLI::Range(std::size_t{1}, bonding::kMaxLinks))
      ->capture_default_str();
  auto* steps =
      app->add_option("--steps", o->steps_mbps, "Capacities in equal parts of the run [Mbit/s]")
          ->delimiter(',')
          ->check(CLI::Range(0.0, link::Capacity::kMaxMbps))
          ->capture_default_str();
  auto* rate =
      app->add_option("--rate", o->rate_mbps, "Constant capacity [Mbit/s]; with --drive its mean")
          ->check(CLI::Range(0.01, link::Capacity::kMaxMbps))
          ->excludes(steps);
  auto* trace =
      app->add_option("--trace", o->traces,
                      "Capacity from a file of 'time_s rate_mbps' lines; once for each link")
          ->check(CLI::ExistingFile)
          ->allow_extra_args(false)
          ->excludes(steps)
          ->excludes(rate);
  app->add_flag("--drive", o->drive,
                "Capacity of a generated drive through a 5G network, with handover gaps (--seed); "
                "of another one for each link")
      ->excludes(steps)
      ->excludes(trace);
  app->add_option("--rtt", o->rtt_ms, "Propagation there and back [ms]")
      ->check(CLI::Range(0.0, 10000.0))
      ->capture_default_str();
  app->add_option("--loss", o->loss_percent, "Random loss [%]")->check(CLI::Range(0.0, 100.0));
  app->add_flag("--no-l4s", o->no_l4s, "A queue of 100 ms that marks nothing, and no ECN");
  app->add_flag("--secure", o->secure, "SRTP, with a key of this run");
}

link::Capacity ParsedTrace(const std::string& text, const std::string& name) {
  std::string error;
  const auto capacity = link::Capacity::ParseTrace(text, true, &error);
  if (!capacity) throw std::runtime_error(name + ": " + error);
  return *capacity;
}

link::Capacity CapacityOf(const RunOptions& o, std::size_t index) {
  const auto mbps = [](double m) { return DataRate::BitsPerSecond(m * 1e6); };
  if (o.drive) return ParsedTrace(DriveTraceOf(o, index), "--drive");
  if (index < o.traces.size()) {
    const std::string& file = o.traces[index];
    std::stringstream text;
    text << std::ifstream(file).rdbuf();
    return ParsedTrace(text.str(), "--trace " + file);
  }
  if (o.rate_mbps > 0) return link::Capacity::Constant(mbps(o.rate_mbps));
  std::vector<DataRate> rates;
  for (const double m : o.steps_mbps) rates.push_back(mbps(m));
  return link::Capacity::Steps(rates, FromSeconds(StepTime(o)));
}

/// Returns the sender's properties for the destination: a host and a port, or the addresses of
/// several links.
std::string TargetOf(const Ports& ports) {
  if (ports.links.size() == 1) return "host=127.0.0.1 port=" + std::to_string(ports.links.front());
  std::string links;
  for (std::size_t i = 0; i < ports.links.size(); ++i)
    links += (i == 0 ? "" : ",") + ("127.0.0.1:" + std::to_string(ports.links[i])) + "@127.0.0." +
             std::to_string(i + 1);
  return "bonding-addresses=" + links;
}

}  // namespace

void AddRunOptions(CLI::App* app, RunOptions* o) {
  app->add_option("--duration", o->duration_s, "Duration of the stream [s]")
      ->check(CLI::Range(1.0, 1e6))
      ->capture_default_str();
  app->add_option("--output", o->output, "Folder for the report")->capture_default_str();
  app->add_flag("--view", o->view,
                "Serve a page with the clouds that arrive and the figures of both ends, while the "
                "stream lasts");
  app->add_flag("--slam", o->slam,
                "The receiver follows the sensor by lidarodometry: trajectories, error and map");
  app->add_flag("!--no-plots", o->plots, "Do not draw plots");
  AddSourceOptions(app, o);
  AddCodecOptions(app, o);
  AddPathOptions(app, o);
}

void CheckRunOptions(const RunOptions& o) {
  try {
    CapacitiesOf(o);
  } catch (const std::runtime_error& e) {
    throw CLI::ValidationError(e.what());
  }
  if (!o.traces.empty() && o.traces.size() != o.links)
    throw CLI::ValidationError("--trace must be given once for each of the --links");
  if (o.steps_mbps.empty()) throw CLI::ValidationError("--steps needs at least one rate");
  if (o.start_bitrate_mbps > o.max_bitrate_mbps)
    throw CLI::ValidationError("--start-bitrate must not be above --max-bitrate");
  if (EncoderOf(o) == "lidarenc" && o.geometry == "xyz")
    throw CLI::ValidationError("--geometry xyz needs --encoder dracoenc: lidarenc codes ranges");
}

std::string EncoderOf(const RunOptions& o) {
  if (!o.encoder.empty()) return o.encoder;
  return o.geometry == "xyz" ? "dracoenc" : "lidarenc";
}

double FixedStepOf(const RunOptions& o) {
  if (o.fixed_bits > 0) return kFixedBitsExtentM / (std::exp2(o.fixed_bits) - 1);
  return o.fixed_step_m;
}

double ErrorBoundOf(const RunOptions& o) {
  const double step = FixedStepOf(o);
  // The bound for ranges is half a step along the beam. Otherwise it is half the diagonal of a cube
  // whose edge is one step.
  if (step > 0) return HasRanges(o) ? step / 2 : step * std::sqrt(3) / 2;
  return o.max_error_m;
}

std::vector<link::Capacity> CapacitiesOf(const RunOptions& o) {
  std::vector<link::Capacity> capacities;
  for (std::size_t i = 0; i < o.links; ++i) capacities.push_back(CapacityOf(o, i));
  return capacities;
}

std::string LinkFile(const RunOptions& o, const std::string& name, std::size_t index) {
  const auto dot = name.rfind('.');
  const std::string number = index == 0 ? "" : std::to_string(index + 1);
  return o.output + '/' + name.substr(0, dot) + number + name.substr(dot);
}

std::string DriveTraceOf(const RunOptions& o, std::size_t index) {
  link::DriveTraceConfig config;
  config.seed = o.seed + static_cast<std::uint32_t>(index);
  config.duration = FromSeconds(o.duration_s + kDriveTail_s);
  const bool recorded = !o.pcap.empty() || !o.scans.empty();
  const double mean = recorded ? kDriveOfCaptureMbps : kDriveMbps;
  config.mean = DataRate::BitsPerSecond((o.rate_mbps > 0 ? o.rate_mbps : mean) * 1e6);
  return MakeDriveTrace(config);
}

std::vector<Duration> ChangesOf(const RunOptions& o) {
  std::vector<Duration> changes;
  if (o.links > 1 || o.drive || !o.traces.empty() || o.rate_mbps > 0) return changes;
  for (std::size_t i = 1; i < o.steps_mbps.size(); ++i)
    changes.push_back(FromSeconds(StepTime(o)) * static_cast<std::int64_t>(i));
  return changes;
}

std::string SenderPipeline(const RunOptions& o, const Ports& ports) {
  const double step = FixedStepOf(o);
  // The queue lets the source keep its pace while a slice is encoded.
  std::string text = SourceOf(o) + " ! queue ! " + EncoderOf(o) + " name=encoder max-error=" +
                     Number(step > 0 ? std::max(step, 0.001) : o.max_error_m);
  if (EncoderOf(o) == "dracoenc") text += " geometry=" + o.geometry;
  if (step > 0) text += " quantization-step=" + Number(step);
  text += " ! rtplidarpay name=payloader ! screamsink name=sender " + TargetOf(ports) +
          " max-bitrate=" + Bps(o.max_bitrate_mbps) +
          " start-bitrate=" + Bps(o.start_bitrate_mbps) +
          " ecn-mode=" + (o.no_l4s ? "off" : "ect1") + KeyOf(o);
  // A foxglovesink whose pad is not linked serves only the statistics.
  if (o.view) text += " foxglovesink port=" + std::to_string(kSenderPage);
  return text;
}

/// Returns the elements that compute odometry, and those that draw a map every ten seconds. Queues
/// give them threads of their own.
std::string SlamOf(const RunOptions& o) {
  if (!o.slam) return "";
  const std::string odometry =
      "queue ! lidarodometry name=odometry post-messages=false trajectory=" +
      Quoted(o.output + "/edge.tum") + " ! ";
  if (!o.plots) return odometry;
  return odometry +
         "tee name=posed ! queue leaky=downstream max-size-buffers=1 "
         "! pointcloudview map=true view=top width=1280 height=720 ! videorate drop-only=true "
         "! video/x-raw,framerate=1/10 ! pngenc snapshot=false ! multifilesink async=false "
         "location=" +
         Quoted(o.output + "/map.png") + " posed. ! queue ! ";
}

/// Returns a branch that serves the page, which decodes the slices by itself. This branch may drop
/// slices, but does not delay other branches.
std::string ViewOf(const RunOptions& o) {
  if (!o.view) return "";
  return "tee name=viewed ! queue leaky=downstream max-size-buffers=64 ! foxglovesink name=page "
         "sync=false port=" +
         std::to_string(kReceiverPage) + " viewed. ! queue ! ";
}

std::string PageOf(const RunOptions& o) {
  if (!o.view) return "";
  return "http://127.0.0.1:" + std::to_string(kReceiverPage) +
         "/?also=127.0.0.1:" + std::to_string(kSenderPage);
}

std::string ReceiverPipeline(const RunOptions& o, const Ports& ports) {
  const std::string decoder = EncoderOf(o) == "dracoenc" ? "dracodec" : "lidardec";
  return "screamsrc name=receiver address=127.0.0.1 port=" + std::to_string(ports.receiver) +
         KeyOf(o) + " ! rtplidardepay name=depayloader ! " + ViewOf(o) + decoder +
         " name=decoder ! scanassembler name=assembler ! " + SlamOf(o) +
         "fakesink sync=false async=false" +
         (o.view && o.slam ? " odometry.odometry ! queue ! page." : "");
}

std::vector<std::string> LinkArguments(const RunOptions& o, const Ports& ports, std::size_t index) {
  std::vector<std::string> arguments{
      "--listen",    "127.0.0.1:" + std::to_string(ports.links[index]),
      "--forward",   "127.0.0.1:" + std::to_string(ports.receiver),
      "--rtt",       Number(o.rtt_ms),
      "--loss",      Number(o.loss_percent),
      "--seed",      std::to_string(o.seed + index),
      "--log",       LinkFile(o, "packets.csv", index),
      "--summary",   LinkFile(o, "link.json", index),
      "--json-lines"};
  const auto add = [&](std::initializer_list<std::string> more) {
    arguments.insert(arguments.end(), more);
  };
  if (o.drive) {
    add({"--trace", LinkFile(o, "trace.txt", index)});
  } else if (!o.traces.empty()) {
    add({"--trace", o.traces[index]});
  } else if (o.rate_mbps > 0) {
    add({"--rate", Number(o.rate_mbps)});
  } else {
    std::string list;
    for (const double m : o.steps_mbps) list += (list.empty() ? "" : ",") + Number(m);
    add({"--steps", list, "--step-time", Number(StepTime(o)), "--once"});
  }
  if (o.no_l4s) {
    add({"--aqm", "none", "--queue", "100"});
  } else {
    add({"--aqm", "ramp", "--aqm-low", "2", "--aqm-high", "10"});
  }
  return arguments;
}

}  // namespace lidar::demo
