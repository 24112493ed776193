// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/base/backoff.h"

#include <gtest/gtest.h>

namespace lidar {
namespace {

using std::chrono::seconds;

TEST(Backoff, DoublesUpToItsMostAndBeginsAnewAfterASuccess) {
  Backoff backoff(seconds(1), seconds(6));
  for (int attempts = 0; attempts < 2; ++attempts) {
    for (const int pause : {1, 2, 4, 6, 6}) EXPECT_EQ(backoff.Next(), seconds(pause));
    backoff.Reset();
  }
}

}  // namespace
}  // namespace lidar
