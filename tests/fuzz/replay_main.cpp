// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs a fuzz target over every file of its corpus. This is an ordinary test, which needs no fuzzer
// and works with any compiler.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "tests/fuzz/fuzz.h"

namespace {

std::filesystem::path corpus;

std::vector<std::uint8_t> Read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

TEST(Corpus, IsHandledFileByFile) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(corpus))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  ASSERT_FALSE(files.empty()) << corpus;
  for (const auto& path : files) {
    SCOPED_TRACE(path);
    const auto bytes = Read(path);
    EXPECT_EQ(LLVMFuzzerTestOneInput(bytes.data(), bytes.size()), 0);
  }
}

// Runs the target on the beginnings of each file. A beginning has each length below kHeaders, and
// about 40 greater lengths. A corpus could not contain so many files.
TEST(Corpus, IsHandledWhenCutShort) {
  for (const auto& entry : std::filesystem::directory_iterator(corpus)) {
    const auto bytes = Read(entry.path());
    constexpr std::size_t kHeaders = 64;
    const std::size_t step = 1 + bytes.size() / 40;
    for (std::size_t n = 0; n < bytes.size(); n += n < kHeaders ? 1 : step) {
      // The buffer has exactly the size of the input, so that AddressSanitizer detects a read past
      // its end.
      const std::vector<std::uint8_t> cut(bytes.begin(),
                                          bytes.begin() + static_cast<std::ptrdiff_t>(n));
      EXPECT_EQ(LLVMFuzzerTestOneInput(cut.data(), cut.size()), 0) << entry.path() << " " << n;
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s CORPUS-FOLDER\n", argv[0]);
    return 2;
  }
  corpus = argv[1];
  return RUN_ALL_TESTS();
}
