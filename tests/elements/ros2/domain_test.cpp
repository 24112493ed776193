// SPDX-License-Identifier: LGPL-2.1-or-later
// Which code makes and ends the DDS domains of a process.
#include "ext/ros2/domain.h"

#include <dds/dds.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

namespace lidar::dds {
namespace {

// No element uses this domain.
constexpr std::uint32_t kDomain = 231;

std::unique_ptr<Domain> Join() {
  std::string why;
  auto domain = Domain::Join(kDomain, &why);
  EXPECT_TRUE(domain) << why;
  return domain;
}

/// Returns true if the domain can be made, so that it did not exist. It is deleted again.
bool IsFree() {
  const dds_entity_t made = dds_create_domain(kDomain, "");
  if (made > 0) dds_delete(made);
  return made > 0;
}

TEST(RosDomain, EndsWithTheLastOfItsUsers) {
  for (int round = 0; round < 2; ++round) {
    EXPECT_TRUE(IsFree());
    auto one = Join();
    auto another = Join();
    EXPECT_EQ(another->id(), kDomain);
    one.reset();
    EXPECT_FALSE(IsFree());
    another.reset();
  }
  EXPECT_TRUE(IsFree());
}

TEST(RosDomain, OfSomebodyElseIsUsedAndStays) {
  const dds_entity_t made = dds_create_domain(kDomain, "");
  ASSERT_GT(made, 0);
  Join().reset();
  EXPECT_FALSE(IsFree());
  dds_delete(made);
  EXPECT_TRUE(IsFree());
}

TEST(RosDomain, TellsTheReceiveBufferWithoutWhatTheKernelAddsForItself) {
  std::ifstream file("/proc/sys/net/core/rmem_max");
  std::uint32_t most = 0;
  if (!(file >> most)) GTEST_SKIP() << "nobody tells the limit";
  EXPECT_EQ(Domain::GrantedReceiveBuffer(), std::min(most, Domain::kReceiveBuffer));
}

}  // namespace
}  // namespace lidar::dds
