// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include "tests/support/files.h"

int main(int argc, char** argv) {
  const lidar::test::TempFolder folder;
  setenv("TMPDIR", folder.path().c_str(), 1);
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
