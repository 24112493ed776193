// SPDX-License-Identifier: LGPL-2.1-or-later
// What the files of programs include that read options and JSON, compiled once.
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
