// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/sim/parameter_options.h"

#include <cstdlib>
#include <string>

#include "src/scream/tuning.h"

namespace lidar::scream::test {
namespace {

/// Takes NAME=VALUE.
bool Set(const std::string& text, Parameters* parameters) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) return false;
  const Tunable* tunable = FindTunable(text.substr(0, equals));
  return tunable != nullptr && tunable->Set(std::atof(text.c_str() + equals + 1), parameters);
}

}  // namespace

std::vector<std::string> SwitchNames() {
  std::vector<std::string> names;
  for (const Tunable& t : Tunables())
    if (t.is_switch()) names.emplace_back(t.name);
  return names;
}

bool Switch(const std::string& name, bool on, Parameters* parameters) {
  const Tunable* tunable = FindTunable(name);
  return tunable != nullptr && tunable->is_switch() && tunable->Set(on ? 1 : 0, parameters);
}

int TakeParameterOption(int argc, char** argv, int i, Parameters* parameters) {
  const std::string arg = argv[i];
  if (arg == "--draft") {
    *parameters = Parameters::Draft();
    return 1;
  }
  if (arg != "--with" && arg != "--without" && arg != "--set") return 0;
  if (i + 1 >= argc) return -1;
  const std::string value = argv[i + 1];
  const bool known =
      arg == "--set" ? Set(value, parameters) : Switch(value, arg == "--with", parameters);
  return known ? 2 : -1;
}

}  // namespace lidar::scream::test
