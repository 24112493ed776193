// SPDX-License-Identifier: LGPL-2.1-or-later
// A locale for tests which check that files do not depend on the locale's format of numbers.
#pragma once
#include <locale>
#include <string>

namespace lidar::test {

/// The German format of numbers: a comma before the decimals, and a point between groups of three
/// digits.
struct GermanNumbers : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

}  // namespace lidar::test
