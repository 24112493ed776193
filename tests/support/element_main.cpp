// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gst/gst.h>
#include <gtest/gtest.h>

#include "tests/support/files.h"

int main(int argc, char** argv) {
  const lidar::test::TempFolder folder;
  setenv("TMPDIR", folder.path().c_str(), 1);
  ::testing::InitGoogleTest(&argc, argv);
  gst_init(&argc, &argv);
  const int result = RUN_ALL_TESTS();
  gst_deinit();
  return result;
}
