// SPDX-License-Identifier: LGPL-2.1-or-later
// The constants and switches of Parameters by name, for users, programs and tests.
#pragma once
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "src/scream/parameters.h"

namespace lidar::scream {

/// A constant or a switch. Its value is a number: times in nanoseconds, sizes in bytes, rates in
/// bit/s, and 0 or 1 for a switch.
struct Tunable {
  using Member =
      std::variant<bool Extensions::*, bool Parameters::*, double Parameters::*,
                   Duration Parameters::*, DataSize Parameters::*, DataRate Parameters::*>;
  const char* name;  ///< name in the draft, or of the extension, with hyphens
  Member member;
  double min = 0;
  double max = 1;

  bool is_switch() const { return member.index() <= 1; }
  /// Sets the value in `parameters`. Returns false, without a change, if `value` is outside of
  /// `min` to `max`.
  bool Set(double value, Parameters* parameters) const;
};

/// Returns all tunables, in the order of the draft's sections.
const std::vector<Tunable>& Tunables();
/// Returns the tunable of that name, or NULL if there is none. Underscores count as hyphens.
const Tunable* FindTunable(std::string_view name);
/// Returns all names, separated by commas, for messages.
std::string TunableNames();

}  // namespace lidar::scream
