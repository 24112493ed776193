// SPDX-License-Identifier: LGPL-2.1-or-later
// What all programs have in common: the option --version, exit code 2 for wrong options, and exit
// code 1 after an exception.
#pragma once
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

namespace lidar::tools {

inline void AddVersionFlag(CLI::App* app, const std::string& program) {
  app->set_version_flag("--version", program + " (gst-lidar) " LIDAR_VERSION);
}

/// Adds an option that prints the options of all commands. The man page is made from this output.
inline void AddHelpAllFlag(CLI::App* app) {
  app->set_help_all_flag("--help-all", "Print the help of all subcommands and exit");
}

/// Throws if a number is NaN, because CLI::Range accepts NaN. Also throws if an unsigned number is
/// negative, because CLI11 before 2.3 takes it modulo 2^64.
inline void RefuseWrongNumbers(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    const std::string type = option->get_type_name();
    const bool is_float = type.find("FLOAT") != std::string::npos;
    const bool is_unsigned = type.find("UINT") != std::string::npos;
    for (const std::string& text : option->results()) {
      double value = 0;
      if (is_float && CLI::detail::lexical_cast(text, value) && std::isnan(value))
        throw CLI::ValidationError(option->get_name(), text + " is not a number");
      if (is_unsigned && text.find('-') != std::string::npos)
        throw CLI::ValidationError(option->get_name(), text + " is negative");
    }
  }
  for (const CLI::App* command : app.get_subcommands()) RefuseWrongNumbers(*command);
}

/// Parses the command line, and then calls `check`, which throws CLI::ParseError for options that
/// contradict each other. Ends the program after --help, and if options are wrong.
template <class Check>
void Parse(CLI::App* app, int argc, char** argv, Check check) {
  try {
    app->parse_complete_callback([app] { RefuseWrongNumbers(*app); });  // before any command runs
    app->parse(argc, argv);
    check();
  } catch (const CLI::ParseError& e) {
    std::exit(app->exit(e) == 0 ? 0 : 2);
  }
}
inline void Parse(CLI::App* app, int argc, char** argv) {
  Parse(app, argc, argv, [] {});
}

/// Calls `run` and returns its exit code. If `run` throws, prints the exception's text and returns
/// 1.
template <class Run>
int Guard(const char* program, Run run) {
  try {
    return run();
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s: %s\n", program, e.what());
    return 1;
  }
}

}  // namespace lidar::tools
