// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/scream_bench/options.h"

#include <CLI/CLI.hpp>
#include <map>

#include "src/tools/common/program.h"

namespace lidar::tools {
namespace {

constexpr double kMaxBps = 4e9;

/// Adds an option for a bitrate in bit/s. The suffixes k, M and G are powers of 1000.
CLI::Option* AddBitrate(CLI::App* app, const char* name, DataRate* rate, const char* help) {
  const auto set = [rate](const double& bps) { *rate = DataRate::BitsPerSecond(bps); };
  return app->add_option_function<double>(name, set, help)
      ->transform(
          CLI::AsNumberWithUnit(std::map<std::string, double>{{"k", 1e3}, {"M", 1e6}, {"G", 1e9}},
                                CLI::AsNumberWithUnit::CASE_SENSITIVE, "BIT/S"))
      ->check(CLI::Range(1.0, kMaxBps));
}

void AddTxOptions(CLI::App* app, BenchTxOptions* o) {
  app->add_option("--host", o->host, "Receiver's host")->required();
  app->add_option("--port", o->port, "Receiver's UDP port")->required();
  app->add_option("--bind-address", o->bind_address, "Local address to send from");
  app->add_option("--bind-port", o->bind_port, "Local UDP port to send from");
  app->add_option("--fps", o->fps, "Frames a second")
      ->check(CLI::Range(0.5, 1000.0))
      ->capture_default_str();
  AddBitrate(app, "--init-bitrate", &o->init_bitrate, "Bitrate to start with");
  AddBitrate(app, "--min-bitrate", &o->min_bitrate, "Never ask the source for less");
  AddBitrate(app, "--max-bitrate", &o->max_bitrate, "Never ask the source for more");
  app->add_option("--ecn", o->ecn, "ECN of the packets")
      ->check(CLI::IsMember({"ect1", "ect0", "off"}))
      ->capture_default_str();
  app->add_option("--frame-jitter", o->frame_jitter_percent, "Frames vary by +- this much [%]")
      ->check(CLI::Range(0.0, 100.0));
  app->add_option("--mtu", o->mtu, "Largest RTP packet [bytes]")
      ->check(CLI::Range(100, 65000))
      ->capture_default_str();
  app->add_option("--log", o->log, "CSV file: the sender's state, ten lines a second");
}

void AddRxOptions(CLI::App* app, BenchRxOptions* o) {
  app->add_option("--port", o->port, "UDP port to receive on")->required();
  app->add_option("--address", o->address, "Local address to receive on");
  app->add_option("--feedback", o->feedback,
                  "Send feedback to HOST:PORT, not to the media's source");
  app->add_option("--num-reports", o->num_reports,
                  "num_reports of RFC 8888: count, or ericsson for a sender with Ericsson's code")
      ->check(CLI::IsMember({"count", "ericsson"}))
      ->capture_default_str();
  app->add_option("--log", o->log, "CSV file, one line a frame");
}

}  // namespace

BenchOptions ParseBenchOptions(int argc, char** argv) {
  BenchOptions options;
  double duration_s = 0;
  CLI::App app(
      "scream-bench: measures a network path with SCReAM v2.\n"
      "A sender whose frames obey the target bitrate exactly, and its receiver. RTP timestamps "
      "are\n"
      "Unix time at the frame's creation, so the receiver can print the frames' age if both "
      "clocks\nagree (else: their age relative to the youngest).",
      "scream-bench");
  AddVersionFlag(&app, "scream-bench");
  AddHelpAllFlag(&app);
  app.footer(
      "Example, in two terminals:\n"
      "  scream-bench rx --port 5004\n"
      "  scream-bench tx --host 127.0.0.1 --port 5004 --max-bitrate 20M --duration 10");
  app.require_subcommand(1);
  CLI::App* tx = app.add_subcommand("tx", "Send frames");
  CLI::App* rx = app.add_subcommand("rx", "Receive frames and answer with feedback");
  AddTxOptions(tx, &options.tx);
  AddRxOptions(rx, &options.rx);
  for (CLI::App* sub : {tx, rx}) {
    sub->add_option("--duration", duration_s, "Stop after this long [s]; never by default")
        ->check(CLI::Range(0.1, 1e7));
    sub->add_option("--summary", options.summary, "JSON file with the totals");
  }
  Parse(&app, argc, argv, [&] {
    if (options.tx.min_bitrate > options.tx.max_bitrate)
      throw CLI::ValidationError("--min-bitrate", "must not be above --max-bitrate");
  });
  options.is_sender = tx->parsed();
  if (duration_s > 0) options.duration = FromSeconds(duration_s);
  return options;
}

}  // namespace lidar::tools
