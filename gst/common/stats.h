// SPDX-License-Identifier: LGPL-2.1-or-later
// Statistics from one table: each row names a field of a struct of counters.
//
//     const std::array<Stat<Counters>, 2> kStats = {{
//         {"packets-sent", &Counters::packets},
//         {"bytes-sent", &Counters::bytes},
//     }};
//     return ToStructure("application/x-thing-stats", kStats, counters);
#pragma once
#include <array>

#include "gst/common/fields.h"
#include "gst/common/refs.h"

namespace lidar::gst {

template <class Counters>
struct Stat {
  const char* name;
  Field<Counters> field;
};

/// Adds a field to `out` for each row of `table`.
template <class Counters, std::size_t N>
void AddStats(GstStructure* out, const std::array<Stat<Counters>, N>& table, const Counters& c) {
  for (const auto& row : table) {
    GValue value = G_VALUE_INIT;
    g_value_init(&value, row.field.type());
    row.field.Get(&c, nullptr, &value);
    gst_structure_take_value(out, row.name, &value);
  }
}

template <class Counters, std::size_t N>
StructurePtr ToStructure(const char* name, const std::array<Stat<Counters>, N>& table,
                         const Counters& c) {
  StructurePtr out(gst_structure_new_empty(name));
  AddStats(out.get(), table, c);
  return out;
}

/// Adds the counts in `part` to the counts in `sum`, for each row of `table`.
template <class Counters, std::size_t N>
void AddCounts(const std::array<Stat<Counters>, N>& table, const Counters& part, Counters* sum) {
  for (const auto& row : table) row.field.Add(part, sum);
}

}  // namespace lidar::gst
