// SPDX-License-Identifier: LGPL-2.1-or-later
// The property `stats` of an element.
#pragma once
#include <gst/gst.h>
#include <gtest/gtest.h>

#include "gst/common/refs.h"

namespace lidar::test {

inline gst::StructurePtr StatsOf(GstElement* element) {
  GstStructure* stats = nullptr;
  g_object_get(element, "stats", &stats, nullptr);
  return gst::StructurePtr(stats);
}

/// Returns the field `name` of the statistics. A flag is returned as 0 or 1.
inline guint64 StatOf(GstElement* element, const char* name) {
  const gst::StructurePtr stats = StatsOf(element);
  guint64 value = 0;
  guint small = 0;
  gboolean flag = FALSE;
  if (gst_structure_get_uint64(stats.get(), name, &value)) return value;
  if (gst_structure_get_uint(stats.get(), name, &small)) return small;
  EXPECT_TRUE(gst_structure_get_boolean(stats.get(), name, &flag)) << name;
  return flag ? 1 : 0;
}

}  // namespace lidar::test
