// SPDX-License-Identifier: LGPL-2.1-or-later
// Command-line options of the simulation programs that change the parameters of the sender.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "src/scream/tuning.h"

namespace lidar::scream::test {

/// Switches an extension or an optional part of the draft on or off. Returns false if `name` is
/// neither.
inline bool Switch(const std::string& name, bool on, Parameters* parameters) {
  const Tunable* tunable = FindTunable(name);
  return tunable != nullptr && tunable->is_switch() && tunable->Set(on ? 1 : 0, parameters);
}

/// Adds an option that may be repeated. Calls `set` with each of its values. `set` returns false if
/// the value is wrong.
template <class Set>
void AddRepeated(CLI::App* app, const std::string& name, const std::string& help, Set set) {
  using Values = std::vector<std::string>;
  const auto take = [name, set](const Values& values) {
    for (const std::string& value : values)
      if (!set(value)) throw CLI::ValidationError(name, value + " is unknown");
  };
  app->add_option_function<Values>(name, take, help)->allow_extra_args(false);
}

/// Adds the options that change the parameters. They are applied in the order in which they are
/// added here, whatever their order on the command line is.
inline void AddParameterOptions(CLI::App* app, Parameters* parameters) {
  app->add_flag_callback(
      "--draft", [parameters] { *parameters = Parameters::Draft(); },
      "No extension: the constants and rules of the draft alone");
  AddRepeated(app, "--set", "Turns a constant: NAME=VALUE", [parameters](const std::string& text) {
    const std::size_t equals = text.find('=');
    const Tunable* tunable = FindTunable(text.substr(0, equals));
    double value = 0;
    return tunable != nullptr && equals != std::string::npos &&
           CLI::detail::lexical_cast(text.substr(equals + 1), value) &&
           tunable->Set(value, parameters);
  });
  AddRepeated(app, "--with", "Switches on an extension or an optional part of the draft",
              [parameters](const std::string& name) { return Switch(name, true, parameters); });
  AddRepeated(app, "--without", "Switches it off",
              [parameters](const std::string& name) { return Switch(name, false, parameters); });
}

}  // namespace lidar::scream::test
