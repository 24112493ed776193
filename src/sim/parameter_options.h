// SPDX-License-Identifier: LGPL-2.1-or-later
// Options of the matrix programs that change the sender's parameters.
#pragma once
#include <string>
#include <vector>

#include "src/scream/parameters.h"

namespace lidar::scream::test {

/// Text for PrintUsage() of a program.
constexpr const char* kParameterUsage =
    "  --draft        no extension: the constants and rules of the draft alone\n"
    "  --set NAME=V   turns a constant (after --draft)\n"
    "  --with PART, --without PART\n"
    "                 switches an optional part of the draft or an extension";

/// Names of the extensions and of the draft's optional parts.
std::vector<std::string> SwitchNames();
/// Returns false for an unknown name.
bool Switch(const std::string& name, bool on, Parameters* parameters);

/// Returns how many arguments from argv[i] on it took: 0 for another option, -1 after an error.
int TakeParameterOption(int argc, char** argv, int i, Parameters* parameters);

}  // namespace lidar::scream::test
