// SPDX-License-Identifier: LGPL-2.1-or-later
// Compares what lidartestsrc outputs and posts in scripted runs with golden files. Coordinates are
// not compared, because their last bits differ between machines.
#include <gtest/gtest.h>

#include "tests/support/golden_course.h"

namespace lidar::test {
namespace {

void SourceCourse(Course& c) {
  c.trace()->TakeAddedPads();
  c.Ask();
  c.Play("play", "event eos", 2);
  c.Ask();
  c.Stop();
  c.Set("channels", "ring, t");
  c.Set("slices-per-scan", "3");
  c.Play("play otherwise", "event eos", 2);
}

const std::size_t kSourceCourses =
    AddGoldenCourses("GoldenCourses",
                     {
                         {"testsrc",
                          "lidartestsrc model=os0-32 mode=512x20 imu=true num-buffers=5",
                          SourceCourse,
                          {nullptr, "src"}},
                     },
                     GOLDEN_COURSES_FOLDER, false);

}  // namespace
}  // namespace lidar::test
