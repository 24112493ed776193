// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/base/load_budget.h"

#include <gtest/gtest.h>

namespace lidar {
namespace {

using std::chrono::milliseconds;

/// Offers work of `cost` to a budget once per `period` for 100 s. Returns the share of a processor
/// that the allowed work takes.
double Allowed(double load, milliseconds cost, milliseconds period) {
  LoadBudget budget;
  Duration spent{};
  for (Time now{}; now < Time{milliseconds(100'000)}; now += period) {
    if (!budget.Allows(load, now)) continue;
    budget.Spend(cost);
    spent += cost;
  }
  return Seconds(spent) / 100;
}

TEST(LoadBudget, AllowsWhatIsWithinItAndNoMoreInTheLongRun) {
  EXPECT_NEAR(Allowed(0.5, milliseconds(4), milliseconds(10)), 0.4, 1e-9);
  EXPECT_NEAR(Allowed(0.5, milliseconds(9), milliseconds(10)), 0.5, 0.01);
  EXPECT_NEAR(Allowed(0.1, milliseconds(900), milliseconds(10)), 0.1, 0.01);
}

TEST(LoadBudget, KeepsASecondOfWhatWasNotUsed) {
  LoadBudget budget;
  EXPECT_TRUE(budget.Allows(0.5, Time{}));
  const Time later{milliseconds(3'600'000)};
  Duration spent{};
  while (budget.Allows(0.5, later)) {
    budget.Spend(milliseconds(10));
    spent += milliseconds(10);
  }
  EXPECT_NEAR(Seconds(spent), 0.5, 0.011);
}

}  // namespace
}  // namespace lidar
