// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of where a file of a recording ends and the next file begins, and of which files are kept.
#include "ext/mcap/recorder.h"
#include "tests/support/files.h"
#include "tests/support/small_disk.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>

namespace lidar::gst {
namespace {

namespace fs = std::filesystem;

/// Prevents the process from opening files during the lifetime of the object.
class NoDescriptors {
 public:
  NoDescriptors() {
    getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit limit{0, before_.rlim_max};
    setrlimit(RLIMIT_NOFILE, &limit);
  }
  ~NoDescriptors() { setrlimit(RLIMIT_NOFILE, &before_); }
  NoDescriptors(const NoDescriptors&) = delete;
  NoDescriptors& operator=(const NoDescriptors&) = delete;

 private:
  rlimit before_{};
};

class Pieces : public test::FolderTest {
 protected:
  std::unique_ptr<Recorder> Make(const RecorderSettings& settings,
                                 const std::string& name = "r%02d.mcap") {
    std::string why;
    auto recorder =
        std::make_unique<Recorder>(settings, *mcap::FileNames::Parse(folder_ + "/" + name, &why));
    mcap::Channel channel;
    channel.schema_id = recorder->catalogue().AddSchema({0, "s", "ros2msg", ""});
    channel.topic = "/t";
    channel.message_encoding = "cdr";
    channel_ = recorder->catalogue().AddChannel(std::move(channel));
    return recorder;
  }
  void Add(Recorder* recorder, std::uint64_t time, bool begins_scan) {
    const std::uint8_t data = 1;
    EXPECT_FALSE(recorder->Add({channel_, 0, time, time}, {&data, 1}, begins_scan));
  }
  std::vector<std::string> Files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }
  static std::vector<std::uint64_t> Messages(Recorder* recorder) {
    std::vector<std::uint64_t> counts;
    for (const RecordedFile& file : recorder->TakeFinished())
      counts.push_back(file.statistics.messages);
    return counts;
  }

  std::uint16_t channel_ = 0;
};

TEST_F(Pieces, EndAtTheirAgeWithTheNextScanOrAnEighthLaterWithAnyMessage) {
  RecorderSettings settings;
  settings.max_file_duration = Duration{800};
  const auto recorder = Make(settings);
  Add(recorder.get(), 1000, true);
  Add(recorder.get(), 1799, true);   // the file is not old enough yet
  Add(recorder.get(), 1899, false);  // old enough, but this is not the beginning of a scan
  EXPECT_TRUE(Messages(recorder.get()).empty());
  Add(recorder.get(), 1900, false);  // late by an eighth of the duration
  EXPECT_EQ(Messages(recorder.get()), (std::vector<std::uint64_t>{3}));
  Add(recorder.get(), 2699, true);
  EXPECT_TRUE(Messages(recorder.get()).empty());
  Add(recorder.get(), 2700, true);  // 800 after the beginning of the second file
  EXPECT_EQ(Messages(recorder.get()), (std::vector<std::uint64_t>{2}));
  EXPECT_FALSE(recorder->Finish());
  EXPECT_EQ(Messages(recorder.get()), (std::vector<std::uint64_t>{1}));
  EXPECT_EQ(recorder->chunks(), 3U);
  EXPECT_EQ(Files(), (std::vector<std::string>{"r00.mcap", "r01.mcap", "r02.mcap"}));
}

TEST_F(Pieces, AFileWhoseEndDoesNotFitOnTheDiskIsNotComplete) {
  const auto recorder = Make({});
  Add(recorder.get(), 0, true);
  Add(recorder.get(), 10'000'000'000, true);  // this comes after the first chunk
  const test::SmallDisk disk(1);
  EXPECT_TRUE(recorder->Finish());
  EXPECT_EQ(recorder->chunks(), 1U);
  EXPECT_TRUE(Messages(recorder.get()).empty());
}

TEST_F(Pieces, AMessageThatNoReaderTakesEndsTheRecording) {
  RecorderSettings settings;
  settings.max_files = 1;
  const auto recorder = Make(settings);
  Add(recorder.get(), 1000, true);
  const std::vector<std::uint8_t> data(std::size_t{128} << 20);
  const auto fault = recorder->Add({channel_, 0, 1001, 1001}, {data.data(), data.size()}, false);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->path, folder_ + "/r00.mcap");
  EXPECT_EQ(fault->error, EMSGSIZE);
  EXPECT_EQ(Messages(recorder.get()), (std::vector<std::uint64_t>{1})) << "the file is complete";
  EXPECT_TRUE(recorder->Add({channel_, 1, 1002, 1002}, {data.data(), data.size()}, true));
  EXPECT_TRUE(std::filesystem::exists(folder_ + "/r00.mcap")) << "it is not replaced";
}

TEST_F(Pieces, AMessageOfThePastMakesNoFileOld) {
  RecorderSettings settings;
  settings.max_file_duration = Duration{800};
  const auto recorder = Make(settings);
  Add(recorder.get(), 1000, true);
  Add(recorder.get(), 10, true);
  EXPECT_FALSE(recorder->Finish());
  EXPECT_EQ(Messages(recorder.get()), (std::vector<std::uint64_t>{2}));
}

TEST_F(Pieces, NoMoreStayThanMayThoseOfYesterdayAmongThem) {
  for (const unsigned day : {1U, 2U}) {
    RecorderSettings settings;
    settings.max_files = day == 1 ? 0 : 3;
    const auto recorder = Make(settings);
    for (std::uint64_t i = 0; i < 2; ++i) {
      Add(recorder.get(), i, true);
      EXPECT_FALSE(recorder->Finish());
    }
  }
  EXPECT_EQ(Files(), (std::vector<std::string>{"r01.mcap", "r02.mcap", "r03.mcap"}));
}

TEST_F(Pieces, AFileWithoutANumberIsOne) {
  const auto recorder = Make({}, "one.mcap");
  Add(recorder.get(), 1, true);
  EXPECT_FALSE(recorder->Finish());
  const std::uint8_t data = 1;
  const auto fault = recorder->Add({channel_, 0, 2, 2}, {&data, 1}, true);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->error, EEXIST);
}

TEST_F(Pieces, AreNotWrittenOverWhereTheFolderCannotBeListed) {
  const auto yesterday = Make({});
  Add(yesterday.get(), 1, true);
  EXPECT_FALSE(yesterday->Finish());
  std::unique_ptr<Recorder> recorder;
  {
    const NoDescriptors none;
    recorder = Make({});
  }
  const auto fault = recorder->Check();
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->error, EMFILE);
}

TEST_F(Pieces, AreNotWrittenOverWhereAnotherProgramIsFaster) {
  const auto ours = Make({});
  const auto other = Make({});
  for (Recorder* recorder : {ours.get(), other.get()}) Add(recorder, 1, true);
  EXPECT_FALSE(ours->Finish());
  const auto before = fs::file_size(folder_ + "/r00.mcap");
  const auto fault = other->Finish();
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->error, EEXIST);
  EXPECT_EQ(fs::file_size(folder_ + "/r00.mcap"), before);
}

TEST_F(Pieces, NamesHaveOneNumber) {
  std::string why;
  const auto name = [&](const char* location, std::uint32_t number) {
    const auto names = mcap::FileNames::Parse(location, &why);
    return names ? names->Name(number) : "none";
  };
  EXPECT_EQ(name("a-%03d.mcap", 7), "a-007.mcap");
  EXPECT_EQ(name("a-%03d.mcap", 1234), "a-1234.mcap");
  EXPECT_EQ(name("%d", 7), "7");
  EXPECT_EQ(name("100%%-%d", 7), "100%-7");
  EXPECT_EQ(name("a.mcap", 7), "a.mcap");
  for (const char* bad : {"%d-%d", "%s", "%5d", "%021d", "a%", "%d/a.mcap", "%03"})
    EXPECT_EQ(name(bad, 7), "none") << bad;
  EXPECT_EQ(name("%020d", 7), "00000000000000000007");
}

TEST_F(Pieces, OnlyNamesThatItWouldGiveAreItsFiles) {
  for (const char* name :
       {"r00.mcap", "r7.mcap", "r012.mcap", "r12.mcap", "x13.mcap", "r14.mcap~"}) {
    const auto other = Make({}, name);
    Add(other.get(), 1, true);
    EXPECT_FALSE(other->Finish());
  }
  std::string why;
  std::error_code failed;
  const auto existing = mcap::FileNames::Parse(folder_ + "/r%02d.mcap", &why)->Existing(&failed);
  EXPECT_FALSE(failed);
  ASSERT_EQ(existing.size(), 2U);
  EXPECT_EQ(existing[0].first, 0U);
  EXPECT_EQ(existing[1].first, 12U);
  const auto recorder = Make({});
  Add(recorder.get(), 1, true);
  EXPECT_FALSE(recorder->Finish());
  EXPECT_TRUE(fs::exists(folder_ + "/r13.mcap"));
}

}  // namespace
}  // namespace lidar::gst
