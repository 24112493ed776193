// SPDX-License-Identifier: LGPL-2.1-or-later
// mixing-train: makes the table of the mixing coder's start states, and measures what they save.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>

#include "src/base/base64.h"
#include "src/tools/common/output_file.h"
#include "src/tools/common/program.h"
#include "src/tools/lab/codec_lab/scan_source.h"
#include "src/tools/lab/mixing_train/training.h"

namespace lidar::tools {
namespace {

struct Options {
  std::vector<std::string> sources;
  std::vector<std::string> held_out;
  SourceOptions source;
  std::string output;
  std::string check;
  bool leave_one_out = false;
};

Options ParseOptions(int argc, char** argv) {
  Options o;
  o.source.max_scans = 3;
  CLI::App app(
      "Trains the start states of the mixing coder, which are part of its format, on scans that "
      "may\n"
      "be redistributed.");
  app.option_defaults()->always_capture_default();
  app.add_option("SOURCE", o.sources, kSourceHelp)->required();
  app.add_option("-o,--output", o.output, "File to write");
  app.add_option("--check", o.check, "Compare the result with this file; a difference is an error");
  app.add_flag("--leave-one-out", o.leave_one_out,
               "Print bits a return of each source with states trained on the others");
  app.add_option("--held-out", o.held_out,
                 "Print bits a return of these too, and never train on them");
  app.add_option("--scans", o.source.max_scans, "Scans to read of each source")
      ->check(CLI::Range(1, 1000));
  Parse(&app, argc, argv);
  return o;
}

/// Returns the table in base 64, divided into lines.
std::string ToText(const std::vector<std::uint8_t>& table) {
  constexpr std::size_t kLine = 92;
  const std::string digits = Base64(table);
  std::string text;
  for (std::size_t at = 0; at < digits.size(); at += kLine) text += digits.substr(at, kLine) + '\n';
  return text;
}

// Each case is an effort, an error bound [m], the bits of a level and the number of slices per
// scan.
constexpr MixingCase kCases[] = {{1, 0.02, 0, 8}, {2, 0.02, 0, 8}, {3, 0.02, 0, 8}, {1, 0.05, 0, 8},
                                 {2, 0.05, 0, 8}, {3, 0.05, 0, 8}, {3, 0.02, 5, 8}, {3, 0.02, 8, 8},
                                 {3, 0.01, 0, 8}, {3, 0.1, 0, 8},  {3, 0.02, 0, 1}};

void PrintRow(const std::string& name, const ScanSet& set,
              const codec::mixing::StartStates& states) {
  std::printf("%-36s", name.c_str());
  for (const MixingCase& setting : kCases) {
    std::printf(" %9.3f", BitsPerReturn(set, setting, states));
    std::fflush(stdout);
  }
  std::printf("\n");
}

void PrintHeader() {
  std::printf("%-36s", "bits a return: cm/effort/intensity");
  for (const MixingCase& c : kCases) {
    char text[24];
    std::snprintf(text, sizeof text, "%s%.0f/%u/%u", c.slices == 1 ? "whole " : "", 100 * c.error_m,
                  c.effort, c.level_bits);
    std::printf(" %9s", text);
  }
  std::printf("\n");
}

int Run(const Options& o) {
  const std::vector<ScanSet> sets = LoadAllScans(o.sources, o.source);
  std::vector<const ScanSet*> all;
  for (const ScanSet& set : sets) all.push_back(&set);
  const bool prints = o.leave_one_out || !o.held_out.empty();
  if (prints) PrintHeader();
  for (const ScanSet* left_out : all) {
    if (!o.leave_one_out) break;
    std::vector<const ScanSet*> others;
    for (const ScanSet* set : all)
      if (set != left_out) others.push_back(set);
    PrintRow(left_out->name, *left_out, *TrainMixing(others));
  }
  const auto states = TrainMixing(all);
  for (const ScanSet& set : LoadAllScans(o.held_out, o.source))
    PrintRow(set.name + " (held out)", set, *states);
  std::vector<std::uint8_t> table;
  states->Write(&table);
  const std::string text = ToText(table);
  if (!o.output.empty()) tools::WriteFile(o.output, text);
  if (!o.check.empty()) {
    if (ReadFile(o.check) != text) {
      std::cerr << o.check << ": differs from the result of this training\n";
      return 1;
    }
  }
  std::printf("table: %zu bytes\n", table.size());
  return 0;
}

}  // namespace
}  // namespace lidar::tools

int main(int argc, char** argv) {
  using namespace lidar::tools;
  return Guard("mixing-train", [&] { return Run(ParseOptions(argc, argv)); });
}
