// SPDX-License-Identifier: LGPL-2.1-or-later
// controller-goals: runs every simulated case of the controller, and prints which goals it meets
// and misses. With --ablation, prints how the results change without each part of the controller.
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "src/sim/figures.h"
#include "src/sim/loop_figures.h"
#include "src/tools/common/program.h"
#include "tests/benchmarks/parameter_options.h"

namespace {

using lidar::scream::Parameters;
using lidar::scream::Tunable;
using lidar::scream::Tunables;
using namespace lidar::scream::test;

struct Options {
  std::vector<std::string> cases;
  // The names of the cases begin with this text.
  std::string group;
  Parameters parameters;
  int starts = 12;
  bool all_figures = false;
  bool ablation = false;
};

struct Case {
  std::string name;
  std::function<std::vector<Figure>(const Parameters&)> run;
};
using Results = std::vector<std::vector<Figure>>;  // the figures of each case

void Parse(int argc, char** argv, Options* options) {
  CLI::App app{
      "controller-goals: simulates all cases, or some, and prints each goal: the figure, the goal, "
      "met or missed.",
      "controller-goals"};
  app.add_option("CASE", options->cases, "These only");
  app.add_option("--group", options->group,
                 "Only cases whose names begin so: rfc, gap_, drive_, event_, ...");
  app.add_flag("--figures", options->all_figures, "Prints every figure, with a goal or without");
  app.add_flag("--ablation", options->ablation,
               "Switches off each part of the controller, and the whole (draft), and prints where "
               "that is worse or better");
  app.add_option("--starts", options->starts, "Runs over each trace with gaps, from other starts")
      ->check(CLI::PositiveNumber);
  AddParameterOptions(&app, &options->parameters);
  lidar::tools::Parse(&app, argc, argv);
}

void AddMatrix(std::vector<Case>* cases) {
  for (const Scenario& s : Scenarios(Parameters())) {
    cases->push_back({s.name, [name = s.name](const Parameters& p) {
                        const Scenario scenario = *FindScenario(name, p);
                        return Figures(scenario, Measure(scenario, Simulate(scenario.config)));
                      }});
  }
}

void AddRmcat(std::vector<RmcatCase> (*make)(const Parameters&), std::vector<Case>* cases) {
  const std::size_t count = make(Parameters()).size();
  for (std::size_t i = 0; i < count; ++i) {
    cases->push_back({make(Parameters())[i].name, [make, i](const Parameters& p) {
                        const RmcatCase c = make(p)[i];
                        return Figures(c, Measure(c, Simulate(c.config)));
                      }});
  }
}

void AddLoop(int starts, std::vector<Case>* cases) {
  for (const lidar::loop::NamedTrace& trace : lidar::loop::BuiltInTraces()) {
    for (const bool slices : {true, false}) {
      lidar::loop::LoopCase c;
      c.name = trace.name + (slices ? "/slices" : "/scans");
      c.capacity = trace.capacity;
      if (!slices) c.source.slices = 1;
      cases->push_back({c.name, [c, starts](const Parameters& p) {
                          lidar::loop::LoopCase with = c;
                          with.parameters = p;
                          return lidar::loop::LoopFigures(with, starts);
                        }});
    }
  }
}

std::vector<Case> Cases(const Options& options) {
  std::vector<Case> all;
  // The longest cases come first. A long case that starts last would run alone at the end.
  AddLoop(options.starts, &all);
  AddMatrix(&all);
  AddRmcat(WiredCases, &all);
  AddRmcat(WirelessCases, &all);
  all.erase(std::remove_if(all.begin(), all.end(),
                           [&](const Case& c) { return c.name.rfind(options.group, 0) != 0; }),
            all.end());
  if (options.cases.empty()) return all;
  std::vector<Case> wanted;
  for (const std::string& name : options.cases) {
    const auto it =
        std::find_if(all.begin(), all.end(), [&](const Case& c) { return c.name == name; });
    if (it == all.end()) {
      std::fprintf(stderr, "controller-goals: no case is called %s\n", name.c_str());
      return {};
    }
    wanted.push_back(*it);
  }
  return wanted;
}

/// Runs the cases in parallel, with one thread per processor. A thread that has finished a case
/// continues with the next case that is not yet running.
Results Run(const std::vector<Case>& cases, const Parameters& parameters) {
  Results results(cases.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < cases.size(); i = next++)
      results[i] = cases[i].run(parameters);
  };
  std::vector<std::thread> threads;
  for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  return results;
}

std::size_t PrintGoals(const std::vector<Case>& cases, const Results& results, bool all_figures) {
  std::size_t met = 0, missed = 0;
  std::printf("%-34s %-32s %9s %9s\n", "case", "figure", "now", "goal");
  for (std::size_t i = 0; i < cases.size(); ++i) {
    for (const Figure& f : results[i]) {
      if (f.goal) ++(f.reached() ? met : missed);
      if (!f.goal && !all_figures) continue;
      std::printf("%-34s %-32s %9.3f", cases[i].name.c_str(), f.kind->name, f.value);
      if (f.goal)
        std::printf(" %s%8.3f %s", f.kind->more_is_better ? ">" : "<", *f.goal,
                    f.reached() ? "met" : "MISSED");
      std::printf("\n");
    }
  }
  std::printf("%zu goals met, %zu missed\n", met, missed);
  return missed;
}

struct Change {
  std::string text;
  double size = 0;
};

/// Returns the figures that differ between two runs of all cases. The largest difference is the
/// first.
std::vector<Change> Changes(const std::vector<Case>& cases, const Results& base,
                            const Results& other) {
  std::vector<Change> changes;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    for (std::size_t k = 0; k < base[i].size(); ++k) {
      const Figure& b = base[i][k];
      const Figure& o = other[i][k];
      const double better = o.BetterThan(b);
      if (std::abs(better) < 1) continue;
      char text[160];
      std::snprintf(text, sizeof text, "%s: %s %.4g, now %.4g%s", cases[i].name.c_str(),
                    b.kind->name, b.value, o.value,
                    b.reached() && !o.reached() ? ", a goal missed" : "");
      changes.push_back({text, better});
    }
  }
  std::stable_sort(changes.begin(), changes.end(), [](const Change& a, const Change& b) {
    return std::abs(a.size) > std::abs(b.size);
  });
  return changes;
}

void PrintChanges(const std::string& name, const std::vector<Change>& changes) {
  constexpr int kShown = 5;
  const auto worse =
      std::count_if(changes.begin(), changes.end(), [](const Change& c) { return c.size < 0; });
  std::printf("%s: %d figures worse, %d better\n", name.c_str(), static_cast<int>(worse),
              static_cast<int>(changes.size()) - static_cast<int>(worse));
  for (const bool shown_worse : {true, false}) {
    int shown = 0;
    for (const Change& c : changes) {
      if ((c.size < 0) != shown_worse || shown == kShown) continue;
      std::printf("    %c %s\n", shown_worse ? '-' : '+', c.text.c_str());
      ++shown;
    }
  }
  std::fflush(stdout);
}

void PrintAblation(const std::vector<Case>& cases, const Options& options) {
  const Results base = Run(cases, options.parameters);
  for (const Tunable& part : Tunables()) {
    Parameters p = options.parameters;
    if (!Switch(part.name, false, &p)) continue;
    PrintChanges(std::string("without ") + part.name, Changes(cases, base, Run(cases, p)));
  }
  PrintChanges("the draft alone", Changes(cases, base, Run(cases, Parameters::Draft())));
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  Parse(argc, argv, &options);
  const std::vector<Case> cases = Cases(options);
  if (cases.empty()) return 2;
  if (options.ablation) {
    PrintAblation(cases, options);
    return 0;
  }
  PrintGoals(cases, Run(cases, options.parameters), options.all_figures);
  return 0;
}
