// SPDX-License-Identifier: LGPL-2.1-or-later
// Checks that a table of a test names every writable property of an element.
#pragma once
#include <gst/gst.h>
#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <string>

#include "gst/common/refs.h"

namespace lidar::test {

/// Returns the names of the writable properties that the classes of this project add to an element.
inline std::set<std::string> OwnWritableProperties(const std::string& element_name) {
  const gst::ElementPtr element(gst_element_factory_make(element_name.c_str(), nullptr));
  gst_object_ref_sink(element.get());
  guint count = 0;
  const std::unique_ptr<GParamSpec*, void (*)(gpointer)> specs(
      g_object_class_list_properties(G_OBJECT_GET_CLASS(element.get()), &count), g_free);
  std::set<std::string> names;
  for (guint i = 0; i < count; ++i) {
    const GParamSpec& spec = *specs.get()[i];
    if (g_str_has_prefix(g_type_name(spec.owner_type), "GstLidar") &&
        (spec.flags & G_PARAM_WRITABLE) != 0)
      names.insert(spec.name);
  }
  return names;
}

/// Expects that each writable property of the element is the `property` of at least one entry of
/// `effects`.
template <class Effects>
void ExpectEachPropertyIn(const Effects& effects, const std::string& element_name) {
  std::set<std::string> tried;
  for (const auto& effect : effects) tried.insert(effect.property);
  for (const std::string& name : OwnWritableProperties(element_name))
    EXPECT_EQ(tried.count(name), 1U) << name;
}

}  // namespace lidar::test
