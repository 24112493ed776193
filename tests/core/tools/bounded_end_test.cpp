// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/common/bounded_end.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "tests/support/patience.h"

namespace lidar::tools {
namespace {

using std::chrono::steady_clock;

constexpr std::chrono::milliseconds kMost{400};
constexpr int kEndedItself = 7;

TEST(BoundedEnd, EndsAProcessThatHangs) {
  const pid_t child = fork();
  if (child == 0) {
    const BoundedEnd bounded(kMost);
    while (true) pause();
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(BoundedEnd, LeavesAProcessThatDidNotRunItsTime) {
  const pid_t child = fork();
  if (child == 0) {
    const BoundedEnd bounded(kMost);
    raise(SIGSTOP);
    _exit(kEndedItself);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, WUNTRACED), child);
  ASSERT_TRUE(WIFSTOPPED(status));
  const auto late = steady_clock::now() + 2 * kMost;
  EXPECT_TRUE(test::Eventually([&] { return steady_clock::now() > late; }));
  kill(child, SIGCONT);
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), kEndedItself);
}

}  // namespace
}  // namespace lidar::tools
