// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests the programs that one of our programs starts, and the pipes to which it writes.
#include "src/tools/common/child_process.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "src/tools/common/async_writer.h"
#include "tests/support/files.h"
#include "tests/support/patience.h"

namespace lidar::tools {
namespace {

ChildProcess::Config Shell(const std::string& script) {
  return {{"/bin/sh", "-c", script}, "", false};
}

TEST(ChildProcess, EndsWithItsExitCodeOrItsSignal) {
  struct Case {
    ChildProcess::Config config;
    int result;
  };
  const Case cases[] = {{Shell("exit 0"), 0},
                        {Shell("exit 3"), 3},
                        {Shell("kill -9 $$"), 128 + SIGKILL},
                        {Shell("kill -15 $$"), 128 + SIGTERM},
                        {{{"/no/such/program"}, "", false}, 127}};
  for (const auto& [config, result] : cases) {
    ChildProcess child(config);
    EXPECT_EQ(child.Wait(), result) << config.command.back();
    EXPECT_TRUE(child.Ended());
    EXPECT_EQ(child.Wait(), result) << "again";
  }
  ChildProcess child(Shell("sleep 1000"));
  EXPECT_FALSE(child.Ended());
  child.Signal(SIGTERM);
  EXPECT_TRUE(test::Eventually([&] { return child.Ended(); }));
  EXPECT_EQ(child.Wait(), 128 + SIGTERM) << "known to have ended";
}

TEST(ChildProcess, MayHaveASecondPipeAndAFileForItsErrors) {
  const std::string log = ::testing::TempDir() + "child_process_errors";
  ChildProcess child({{"/bin/sh", "-c", "echo cloud >&3; echo trouble >&2"}, log, true});
  EXPECT_EQ(child.Wait(), 0);
  char cloud[16] = "";
  EXPECT_EQ(read(child.clouds_fd(), cloud, sizeof cloud), 6);
  EXPECT_STREQ(cloud, "cloud\n");
  EXPECT_EQ(test::ReadFile(log), "trouble\n");
  unlink(log.c_str());
  EXPECT_THROW(ChildProcess({{"/bin/true"}, "/no/such/folder/log", false}), std::runtime_error);
}

TEST(ChildProcess, GivesWholeLines) {
  ChildProcess child(Shell("printf 'one\n\nth'; printf 'ree\nrest'"));
  std::vector<std::string> lines;
  EXPECT_TRUE(test::Eventually(
      [&] { return !child.ReadLines([&](const std::string& line) { lines.push_back(line); }); }));
  EXPECT_EQ(lines, (std::vector<std::string>{"one", "", "three"}));
}

/// A pipe with the capacity of one page, which is the smallest that the kernel allows.
struct Pipe {
  Pipe() {
    int fds[2];
    EXPECT_EQ(pipe2(fds, O_CLOEXEC), 0);
    read = FileDescriptor(fds[0]);
    write = FileDescriptor(fds[1]);
    fcntl(write.get(), F_SETPIPE_SZ, 1);
  }
  std::size_t capacity() const {
    return static_cast<std::size_t>(fcntl(write.get(), F_GETPIPE_SZ));
  }
  std::string Read(std::size_t size) const {
    std::string text(size, ' ');
    std::size_t done = 0;
    while (done < size) {
      const ssize_t n = ::read(read.get(), text.data() + done, size - done);
      if (n <= 0) break;
      done += static_cast<std::size_t>(n);
    }
    return text.substr(0, done);
  }

  FileDescriptor read, write;
};

TEST(AsyncWriter, WritesAllInOrderAndHasRoomAgainForWhatWasRead) {
  const Pipe pipe;
  AsyncWriter writer(pipe.write.get(), 100);
  for (int i = 0; i < 50; ++i) {
    const std::string text(80, static_cast<char>('a' + i % 26));
    // The writer frees the room of a text shortly after it wrote the text to the pipe.
    std::uint64_t refused = 0;
    EXPECT_TRUE(test::Eventually([&] { return writer.Write(text) || ++refused > 10'000; }));
    ASSERT_LE(refused, 10'000U) << i;
    EXPECT_EQ(pipe.Read(80), text);
  }
}

TEST(AsyncWriter, DropsAndCountsWhatASlowReaderLeavesNoRoomFor) {
  Pipe pipe;
  const std::size_t more = 2 * pipe.capacity();  // more than the capacity of the pipe
  const std::size_t room = more + 1'000;
  std::string received;
  {
    AsyncWriter writer(pipe.write.get(), room);
    EXPECT_FALSE(writer.Write(std::string(room + 1, 'x'))) << "never fits";
    EXPECT_TRUE(writer.Write(std::string(more, 'a')));
    EXPECT_TRUE(writer.Write(std::string(1'000, 'b')));
    EXPECT_FALSE(writer.Write("c"));
    EXPECT_EQ(writer.dropped(), 2U);
    received = pipe.Read(room);
  }
  pipe.write = FileDescriptor();
  EXPECT_EQ(received + pipe.Read(1), std::string(more, 'a') + std::string(1'000, 'b'));
}

TEST(AsyncWriter, WritesTheRestAtItsEnd) {
  Pipe pipe;
  const std::size_t size = pipe.capacity();
  std::string text;
  auto writer = std::make_unique<AsyncWriter>(pipe.write.get(), 100 * size);
  for (int i = 0; i < 100; ++i) {
    const std::string part(size, static_cast<char>('a' + i % 26));
    EXPECT_TRUE(writer->Write(part));
    text += part;
  }
  std::thread end([&] {
    writer.reset();
    pipe.write = FileDescriptor();
  });
  EXPECT_EQ(pipe.Read(text.size() + 1), text);
  end.join();
}

}  // namespace
}  // namespace lidar::tools
