// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of the DDS domains of a process: which code makes and deletes them, and their
// configuration.
#include "ext/ros2/domain.h"

#include <dds/dds.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <optional>
#include <string>

#include "tests/support/files.h"

namespace lidar::dds {
namespace {

/// Sets environment variables, and restores their old values at the end of the lifetime.
class Variables {
 public:
  using Values = std::map<std::string, std::string>;
  explicit Variables(const Values& values) {
    for (const auto& [name, value] : values) {
      const char* before = std::getenv(name.c_str());
      before_[name] = before != nullptr ? std::optional<std::string>(before) : std::nullopt;
      setenv(name.c_str(), value.c_str(), 1);
    }
  }
  ~Variables() {
    for (const auto& [name, value] : before_)
      value ? setenv(name.c_str(), value->c_str(), 1) : unsetenv(name.c_str());
  }
  Variables(const Variables&) = delete;
  Variables& operator=(const Variables&) = delete;

 private:
  std::map<std::string, std::optional<std::string>> before_;
};

// A domain that no element uses.
constexpr std::uint32_t kDomain = 231;

std::unique_ptr<Domain> Join() {
  std::string why;
  auto domain = Domain::Join(kDomain, &why);
  EXPECT_TRUE(domain) << why;
  return domain;
}

/// Returns true if the domain does not exist. To find this out, makes the domain and deletes it
/// again.
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

class RosDomainFiles : public test::FolderTest {};

TEST_F(RosDomainFiles, UseOnlyThisMachineIfRosSaysSo) {
  for (const std::string local : {"1", "0"}) {
    const std::string trace = folder_ + "/trace" + local;
    const Variables variables({{"ROS_LOCALHOST_ONLY", local},
                               {"CYCLONEDDS_URI",
                                "<Tracing><Category>config</Category>"
                                "<OutputFile>" +
                                    trace + "</OutputFile></Tracing>"}});
    Join().reset();
    const std::string config = test::ReadFile(trace);
    EXPECT_NE(config.find("Domain/General/MaxMessageSize/#text: 65500 B"), std::string::npos)
        << config;
    for (const char* line : {"NetworkInterface[@address]: 127.0.0.1", "Peer[@Address]: 127.0.0.1",
                             "AllowMulticast/#text: false"})
      EXPECT_EQ(config.find(line) != std::string::npos, local == "1") << line << "\n" << config;
  }
}

TEST(RosDomain, NamesTheVariableWhereItsConfigurationIsWrong) {
  {
    const Variables wrong(
        Variables::Values{{"CYCLONEDDS_URI", "<General><NoSuchThing>1</NoSuchThing></General>"}});
    std::string why;
    EXPECT_FALSE(Domain::Join(kDomain, &why));
    EXPECT_NE(why.find("; check the variable CYCLONEDDS_URI"), std::string::npos) << why;
  }
  EXPECT_TRUE(Join());
}

TEST(RosDomain, TellsTheReceiveBufferWithoutWhatTheKernelAddsForItself) {
  std::ifstream file("/proc/sys/net/core/rmem_max");
  std::uint32_t most = 0;
  if (!(file >> most)) GTEST_SKIP() << "nobody tells the limit";
  EXPECT_EQ(Domain::GrantedReceiveBuffer(), std::min(most, Domain::kReceiveBuffer));
}

TEST(RosDomain, LeavesNoFileOpen) {
  Join().reset();
  Domain::GrantedReceiveBuffer();
  const std::ptrdiff_t before = test::OpenFiles();
  for (int i = 0; i < 5; ++i) {
    Join().reset();
    Domain::GrantedReceiveBuffer();
  }
  EXPECT_EQ(test::OpenFiles(), before);
}

}  // namespace
}  // namespace lidar::dds
