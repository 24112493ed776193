// SPDX-License-Identifier: LGPL-2.1-or-later
// GstHarness with an owner.
#pragma once
#include <gst/check/gstharness.h>

#include <memory>

#include "gst/common/refs.h"

namespace lidar::test {

struct HarnessFree {
  void operator()(GstHarness* h) const { gst_harness_teardown(h); }
};
using Harness = std::unique_ptr<GstHarness, HarnessFree>;

}  // namespace lidar::test
