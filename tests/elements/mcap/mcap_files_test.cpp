// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of recordings in several files, of recordings that are incomplete, and of damaged
// recordings.
#include <ctime>
#include <fstream>
#include <future>
#include <random>

#include "ext/mcap/message_types.h"
#include "src/mcap/compression.h"
#include "src/mcap/record_input.h"
#include "tests/elements/mcap/recording.h"

namespace lidar::test {
namespace {

class McapFiles : public Recording {
 protected:
  std::string ReadFile(const std::string& name) const { return test::ReadFile(Path(name)); }
  void WriteFile(const std::string& name, const std::string& bytes) const {
    std::ofstream(Path(name), std::ios::binary) << bytes;
  }
  Outcome PlayFile(const std::string& name) const {
    return Play("mcapsrc name=m" + At(name) + " ! fakesink name=see");
  }
};

TEST_F(McapFiles, PiecesPlayAsOneRecording) {
  const auto written = Record(10, "max-file-duration=300000000", "rec-%03d.mcap");
  EXPECT_EQ(Files(), (std::vector<std::string>{"rec-000.mcap", "rec-001.mcap", "rec-002.mcap",
                                               "rec-003.mcap"}));
  EXPECT_EQ(files_.size(), 4U);
  EXPECT_EQ(files_[0].location, Path("rec-000.mcap"));
  const auto played = PlayFile("rec-%03d.mcap");
  ASSERT_EQ(played.buffers.at("see").size(), written.size());
  for (std::size_t i = 0; i < written.size(); ++i) {
    EXPECT_TRUE(played.buffers.at("see")[i].SameAs(written[i]));
    EXPECT_EQ(played.buffers.at("see")[i].pts, written[i].pts);
  }
  // Each file begins with the first slice of a scan.
  const auto second = PlayFile("rec-001.mcap");
  EXPECT_EQ(second.buffers.at("see")[0].slice.slice_index, 0U);
  EXPECT_EQ(second.buffers.at("see").size(), 24U);
}

TEST_F(McapFiles, SeeksOverPieces) {
  Record(10, "max-file-duration=300000000", "rec-%03d.mcap");
  Pipeline p("mcapsrc" + At("rec-%03d.mcap") + " ! fakesink name=see");
  gst_element_set_state(p.get(), GST_STATE_PAUSED);
  ASSERT_TRUE(p.Wait(GST_MESSAGE_ASYNC_DONE));
  p.Forget();
  ASSERT_TRUE(
      gst_element_seek_simple(p.get(), GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, 800 * GST_MSECOND));
  gst_element_set_state(p.get(), GST_STATE_PLAYING);
  ASSERT_TRUE(p.Wait(GST_MESSAGE_EOS));
  EXPECT_EQ(p.outcome().buffers.at("see").size(), 16U);
  // A seek to the last slice of a file finds this slice in that file.
  p.Forget();
  ASSERT_TRUE(gst_element_seek_simple(p.get(), GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH,
                                      300 * GST_MSECOND - 12'500 * GST_USECOND));
  ASSERT_TRUE(p.Wait(GST_MESSAGE_EOS));
  EXPECT_EQ(p.outcome().buffers.at("see").size(), 57U);
}

TEST_F(McapFiles, PiecesInAnotherOrderAreAsLong) {
  const auto written = Record(6, "max-file-duration=200000000", "rec-%d.mcap");
  std::filesystem::rename(Path("rec-0.mcap"), Path("rec-3.mcap"));
  Pipeline p("mcapsrc" + At("rec-%d.mcap") + " ! fakesink name=see");
  gst_element_set_state(p.get(), GST_STATE_PAUSED);
  ASSERT_TRUE(p.Wait(GST_MESSAGE_ASYNC_DONE));
  gint64 length = 0;
  ASSERT_TRUE(gst_element_query_duration(p.get(), GST_FORMAT_TIME, &length));
  EXPECT_EQ(length, static_cast<gint64>(written.back().pts - written.front().pts));
}

TEST_F(McapFiles, MayBeOnTheDiskBeforeTheNextChunk) {
  const auto written = Record(2, "sync-to-disk=true", "a.mcap");
  EXPECT_EQ(PlayFile("a.mcap").buffers.at("see").size(), written.size());
}

TEST_F(McapFiles, PiecesEndByTheirSize) {
  Record(10, "max-file-size=20000 chunk-size=4000", "rec-%d.mcap");
  const auto files = Files();
  ASSERT_GE(files.size(), 3U);
  for (const auto& name : files) EXPECT_LT(std::filesystem::file_size(Path(name)), 40'000U) << name;
}

TEST_F(McapFiles, OldPiecesStayAndOldestGo) {
  Record(4, "max-file-duration=200000000", "rec-%03d.mcap");
  Record(4, "max-file-duration=200000000", "rec-%03d.mcap");
  EXPECT_EQ(Files().size(), 4U);  // two files of each recording
  Record(4, "max-file-duration=200000000 max-files=3", "rec-%03d.mcap");
  EXPECT_EQ(Files(), (std::vector<std::string>{"rec-003.mcap", "rec-004.mcap", "rec-005.mcap"}));
}

TEST_F(McapFiles, AFileThatBrokeOffPlaysUpToItsLastChunk) {
  const auto written = Record(10, "chunk-duration=200000000 compression=none", "a.mcap");
  const std::string whole = ReadFile("a.mcap");
  std::size_t most = 0;
  for (std::size_t part = 1; part <= 10; ++part) {
    WriteFile("b.mcap", whole.substr(0, whole.size() * part / 11));
    const auto played = PlayFile("b.mcap");
    if (played.buffers.count("see") == 0) {
      EXPECT_NE(played.error, "");
      continue;
    }
    EXPECT_EQ(played.error, "");
    EXPECT_EQ(played.stats.at("files-unclosed"), 1U);
    EXPECT_NE(played.warning.find("were not closed"), std::string::npos) << played.warning;
    const auto& read = played.buffers.at("see");
    EXPECT_EQ(read.size() % 16, 0U);  // each chunk has two scans of 8 slices
    EXPECT_GE(read.size() + 32, written.size() * part / 11);
    for (std::size_t i = 0; i < read.size(); ++i) EXPECT_TRUE(read[i].SameAs(written[i]));
    most = std::max(most, read.size());
  }
  EXPECT_GE(most, 64U);
}

TEST_F(McapFiles, APieceThatIsMissingOrDamagedCostsItselfOnly) {
  Record(10, "max-file-duration=200000000", "rec-%03d.mcap");
  std::filesystem::remove(Path("rec-001.mcap"));
  WriteFile("rec-003.mcap", "no recording");
  const auto played = PlayFile("rec-%03d.mcap");
  EXPECT_EQ(played.error, "");
  EXPECT_NE(played.warning, "");
  EXPECT_EQ(played.buffers.at("see").size(), 48U);
  EXPECT_EQ(played.stats.at("files-unreadable"), 1U);
}

TEST_F(McapFiles, APieceThatIsGoneByItsTurnIsCountedOnce) {
  Record(10, "max-file-duration=200000000", "rec-%03d.mcap");
  Pipeline p("mcapsrc name=m" + At("rec-%03d.mcap") + " ! fakesink name=see");
  gst_element_set_state(p.get(), GST_STATE_PAUSED);
  ASSERT_TRUE(p.Wait(GST_MESSAGE_ASYNC_DONE));
  std::filesystem::remove(Path("rec-002.mcap"));
  gst_element_set_state(p.get(), GST_STATE_PLAYING);
  for (int rounds = 0; rounds < 2; ++rounds) {
    ASSERT_TRUE(p.Wait(GST_MESSAGE_EOS));
    EXPECT_EQ(p.outcome().buffers["see"].size(), 64U);
    EXPECT_EQ(p.outcome().warning, "1 files of the recording cannot be read.");
    p.Forget();
    ASSERT_TRUE(gst_element_seek_simple(p.get(), GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, 0));
  }
  EXPECT_EQ(p.Run().stats["files-unreadable"], 1U);
}

TEST_F(McapFiles, AChunkThatIsDamagedCostsItselfAndIsCounted) {
  Record(4, "chunk-duration=100000000 compression=none", "a.mcap");
  std::string damaged = ReadFile("a.mcap");
  damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 1);
  WriteFile("b.mcap", damaged);
  const auto played = PlayFile("b.mcap");
  EXPECT_EQ(played.error, "");
  EXPECT_EQ(played.stats.at("chunks-damaged"), 1U);
  EXPECT_EQ(played.warning, "The recording is damaged: 1 chunks and 0 messages are left out.");
  EXPECT_LT(played.buffers.at("see").size(), 32U);
  EXPECT_GE(played.buffers.at("see").size(), 16U);
  // The same must hold for a recording that consists of two files.
  WriteFile("b-0.mcap", damaged);
  WriteFile("b-1.mcap", damaged);
  EXPECT_EQ(PlayFile("b-%d.mcap").stats.at("chunks-damaged"), 2U);
}

TEST_F(McapFiles, WhereAllOrTheLastIsDamagedThePlayerSaysSo) {
  Record(4, "compression=none", "a.mcap");
  std::string damaged = ReadFile("a.mcap");
  damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 1);
  WriteFile("b.mcap", damaged);
  EXPECT_EQ(PlayFile("b.mcap").error, "No message of the recording can be read.");
  Record(4, "chunk-duration=100000000 compression=none", "c.mcap");
  damaged = ReadFile("c.mcap");
  const std::size_t last = damaged.size() * 4 / 5;
  damaged[last] = static_cast<char>(damaged[last] ^ 1);
  WriteFile("d.mcap", damaged);
  const auto played = PlayFile("d.mcap");
  EXPECT_EQ(played.stats.at("chunks-damaged"), 1U);
  EXPECT_NE(played.warning, "");
}

/// Writes a recording with `chunks` chunks of zeros. Each chunk takes a while to read, but contains
/// no message that can be played.
void WriteBombs(const std::string& path, int chunks) {
  mcap::Bytes file(mcap::kMagic.begin(), mcap::kMagic.end());
  mcap::Bytes records;
  mcap::Schema schema = gst::SchemaOf(gst::MessageType::kSlice);
  schema.id = 1;
  Append(schema, &records);
  const char* caps = "application/x-lidar-slice,alignment=(string)slice";
  Append(mcap::Channel{1, 1, "/slices", "cdr", {{mcap::kCapsKey, caps}}}, &records);
  const mcap::Bytes catalogue = records;
  records.resize(mcap::kMaxChunk);
  mcap::Bytes bomb;
  const ByteView view{records.data(), records.size()};
  ASSERT_TRUE(mcap::Compress(mcap::Compression::kZstd, view, &bomb));
  mcap::Bytes summary = catalogue;
  for (int i = 0; i < chunks; ++i) {
    mcap::ChunkIndex index;
    index.end_time = index.start_time = 1 + static_cast<std::uint64_t>(i);
    index.offset = file.size();
    Append(
        mcap::ChunkHeader{index.start_time, index.end_time, records.size(), 0, "zstd", bomb.size()},
        {bomb.data(), bomb.size()}, &file);
    index.size = file.size() - index.offset;
    Append(index, &summary);
  }
  mcap::AppendDataEnd(0, &file);
  const std::uint64_t start = file.size();
  file.insert(file.end(), summary.begin(), summary.end());
  Append(mcap::Footer{start, 0, 0}, &file);
  file.insert(file.end(), mcap::kMagic.begin(), mcap::kMagic.end());
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(file.data()), static_cast<std::streamsize>(file.size()));
}

/// Returns the processor time that this process has used [s].
double ProcessorTime() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

TEST_F(McapFiles, ThatTakeLongToReadDoNotDelayAStop) {
  WriteBombs(Path("one.mcap"), 1);
  double begin = ProcessorTime();
  PlayFile("one.mcap");
  const double one_chunk = ProcessorTime() - begin;
  WriteBombs(Path("bombs.mcap"), 100);
  Pipeline p("mcapsrc name=m" + At("bombs.mcap") + " ! fakesink");
  // mcapsrc begins to read chunks after it has announced its pads.
  std::promise<void> pads;
  g_signal_connect(p.Find("m").get(), "no-more-pads",
                   G_CALLBACK(+[](GstElement*, std::promise<void>* told) { told->set_value(); }),
                   &pads);
  gst_element_set_state(p.get(), GST_STATE_PLAYING);
  pads.get_future().wait();
  begin = ProcessorTime();
  gst_element_set_state(p.get(), GST_STATE_NULL);
  // A stop waits only until the current chunk is read. If all hundred chunks were read, this would
  // take ten times as long as allowed.
  EXPECT_LT(ProcessorTime() - begin, 10 * one_chunk);
}

TEST_F(McapFiles, DamageAnywhereIsSurvived) {
  Record(2, "chunk-duration=50000000 compression=none", "a.mcap");
  const std::string whole = ReadFile("a.mcap");
  std::mt19937 random(11);
  for (int round = 0; round < 60; ++round) {
    std::string damaged = whole;
    // Every second round damages only the beginning, because the caps are there, and caps are the
    // most complicated part.
    for (int i = 0; i < 4; ++i)
      damaged[random() % (round % 2 == 0 ? 4'000 : damaged.size())] = static_cast<char>(random());
    WriteFile("b.mcap", damaged);
    const auto played = PlayFile("b.mcap");
    EXPECT_TRUE(!played.error.empty() || played.stats.at("messages") <= 32U);
  }
}

}  // namespace
}  // namespace lidar::test
