// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/mcap/file_names.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/files.h"

namespace lidar::mcap {
namespace {

namespace fs = std::filesystem;

std::string NameOf(const std::string& location, std::uint32_t number) {
  std::string why;
  const auto names = FileNames::Parse(location, &why);
  return names ? names->Name(number) : why;
}

TEST(FileNames, HaveTheirNumberWhereTheLocationSays) {
  EXPECT_EQ(NameOf("rec.mcap", 7), "rec.mcap");
  EXPECT_EQ(NameOf("rec-%d.mcap", 7), "rec-7.mcap");
  EXPECT_EQ(NameOf("rec-%05d.mcap", 7), "rec-00007.mcap");
  EXPECT_EQ(NameOf("rec-%05d.mcap", 1'234'567), "rec-1234567.mcap");
  EXPECT_EQ(NameOf("a%%b/100%%-%020d", 7), "a%b/100%-00000000000000000007");
}

TEST(FileNames, SayWhatIsWrongWithALocation) {
  for (const char* wrong : {"%s", "%", "%5d", "%-5d", "%x", "a%d%d", "%021d", "%0", "%99999999999d",
                            "%+d", "% d", "a%05d-%s"})
    EXPECT_EQ(NameOf(wrong, 1),
              "the file name may have one number, as in rec-%05d.mcap, and no other % than %%")
        << wrong;
  EXPECT_EQ(NameOf("run%d/rec.mcap", 1),
            "the number must be in the name of the file, not of a folder");
}

class ExistingFiles : public lidar::test::FolderTest {
 protected:
  std::vector<std::uint32_t> Numbers(const std::string& name) const {
    std::string why;
    std::error_code failed;
    std::vector<std::uint32_t> numbers;
    for (const auto& [number, path] :
         FileNames::Parse(folder_ + "/" + name, &why)->Existing(&failed)) {
      EXPECT_TRUE(fs::exists(path)) << path;
      numbers.push_back(number);
    }
    EXPECT_FALSE(failed);
    return numbers;
  }
  void Touch(const std::string& name) const { std::ofstream(folder_ + "/" + name) << "x"; }
};

TEST_F(ExistingFiles, AreThoseWhoseWholeNameHasTheForm) {
  for (const char* name :
       {"rec-00002.mcap", "rec-00010.mcap", "rec-00001.mcap", "rec-123456.mcap", "rec-3.mcap",
        "rec-00004.mcap.old", "rec-.mcap", "other-00005.mcap", "rec-+0006.mcap", "rec-00007x.mcap",
        "rec-000008.mcap", "rec-99999999999.mcap", "xrec-00009.mcap"})
    Touch(name);
  EXPECT_EQ(Numbers("rec-%05d.mcap"), (std::vector<std::uint32_t>{1, 2, 10, 123'456}));
  EXPECT_EQ(Numbers("rec-%d.mcap"), (std::vector<std::uint32_t>{3, 123'456}));
  EXPECT_EQ(Numbers("other-00005.mcap"), (std::vector<std::uint32_t>{0}));
  EXPECT_TRUE(Numbers("none.mcap").empty());
}

}  // namespace
}  // namespace lidar::mcap
