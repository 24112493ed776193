// SPDX-License-Identifier: LGPL-2.1-or-later
// The constants and switches of Parameters by name, as users, programs and tests set them.
#pragma once
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "src/scream/parameters.h"

namespace lidar::scream {

/// A constant or a switch. As numbers, times are nanoseconds, sizes bytes, rates bit/s, and a
/// switch is 0 or 1.
struct Tunable {
  using Member =
      std::variant<bool Extensions::*, bool Parameters::*, double Parameters::*,
                   Duration Parameters::*, DataSize Parameters::*, DataRate Parameters::*>;
  const char* name;  ///< the draft's or the extension's, with hyphens
  Member member;
  double min = 0;
  double max = 1;

  bool is_switch() const { return member.index() <= 1; }
  /// An extension, not a part or a constant of the draft.
  bool is_extension() const { return member.index() == 0; }
  /// False, and no change, outside of min..max.
  bool Set(double value, Parameters* parameters) const;
  double Get(const Parameters& parameters) const;
};

/// All, in the order of the draft's sections.
const std::vector<Tunable>& Tunables();
/// NULL where nothing is called so. Underscores count as hyphens.
const Tunable* FindTunable(std::string_view name);
/// The names of all, with commas between, for messages.
std::string TunableNames();

}  // namespace lidar::scream
