// SPDX-License-Identifier: LGPL-2.1-or-later
// A locale whose format of numbers must not appear in files.
#pragma once
#include <locale>
#include <string>

namespace lidar::test {

/// German numbers: a comma instead of the point, and points between thousands.
struct GermanNumbers : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

}  // namespace lidar::test
