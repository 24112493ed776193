// SPDX-License-Identifier: LGPL-2.1-or-later
// Options of the matrix programs that turn the sender's parameters.
#pragma once
#include <string>
#include <vector>

#include "src/scream/parameters.h"

namespace lidar::scream::test {

/// What PrintUsage() of a program says about them.
constexpr const char* kParameterUsage =
    "  --draft        no extension: the constants and rules of the draft alone\n"
    "  --set NAME=V   turns a constant (after --draft)\n"
    "  --with PART, --without PART\n"
    "                 switches an optional part of the draft or an extension";

/// The extensions and the optional parts of the draft.
std::vector<std::string> SwitchNames();
/// Returns false for an unknown name.
bool Switch(const std::string& name, bool on, Parameters* parameters);

/// How many arguments from argv[i] on it took: 0 if they are no such option, -1 if they are wrong.
int TakeParameterOption(int argc, char** argv, int i, Parameters* parameters);

}  // namespace lidar::scream::test
