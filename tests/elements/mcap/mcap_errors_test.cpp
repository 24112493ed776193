// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of what mcapsink and mcapsrc report if they cannot do their work.
#include <sys/stat.h>

#include <fstream>

#include "ext/mcap/message_reader.h"
#include "ext/mcap/message_types.h"
#include "ext/mcap/output_file.h"
#include "src/base/imu_sample.h"
#include "src/cdr/messages.h"
#include "src/cdr/point_cloud2.h"
#include "tests/core/mcap/memory_file.h"
#include "tests/elements/mcap/recording.h"
#include "tests/support/small_disk.h"

namespace lidar::test {
namespace {

class McapErrors : public Recording {
 protected:
  std::string RecordError(const std::string& options) const {
    return Play(kSensor + " num-buffers=80 ! lidarenc ! mcapsink " + options).error;
  }
  std::string PlayError(const std::string& options) const {
    return Play("mcapsrc " + options + " ! fakesink").error;
  }
  void Save(mcap::test::FileMaker* maker) const {
    ASSERT_TRUE(maker->writer().Finish());
    std::ofstream(Path("a.mcap"), std::ios::binary)
        .write(reinterpret_cast<const char*>(maker->file().data()),
               static_cast<std::streamsize>(maker->file().size()));
  }
};

TEST_F(McapErrors, AFullDiskIsAnErrorAndWhatWasCompleteStays) {
  const std::string options = "chunk-duration=100000000 compression=none" + At("a.mcap");
  std::string error;
  {
    const SmallDisk disk(60'000);
    error = RecordError(options);
  }
  EXPECT_EQ(error, "Writing \"" + Path("a.mcap") + "\" failed: File too large.");
  const auto played = Play("mcapsrc name=m" + At("a.mcap") + " ! fakesink name=see");
  EXPECT_EQ(played.error, "");
  EXPECT_GE(played.buffers.at("see").size(), 8U);
}

TEST_F(McapErrors, ADiskWithoutAnySpaceGetsNoEmptyFile) {
  {
    const SmallDisk disk(100);
    EXPECT_NE(RecordError(At("a.mcap")), "");
  }
  EXPECT_TRUE(Files().empty());
}

TEST_F(McapErrors, WhatDoesNotFitIsTakenBackAndTheFileGoesOn) {
  const auto view = [](const std::string& text) {
    return ByteView{reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
  };
  gst::OutputFile file(Path("a"), true, gst::OutputFile::Existing::kKeep);
  {
    const SmallDisk disk(100);
    EXPECT_TRUE(file.Append(view(std::string(40, 'a'))));
    EXPECT_TRUE(file.Append(view(std::string(40, 'b'))));
    EXPECT_FALSE(file.Append(view(std::string(40, 'c'))));
    EXPECT_EQ(file.error(), EFBIG);
    EXPECT_TRUE(file.Append(view(std::string(10, 'd'))));
  }
  EXPECT_TRUE(file.Close());
  EXPECT_EQ(ReadFile(Path("a")),
            std::string(40, 'a') + std::string(40, 'b') + std::string(10, 'd'));
}

TEST_F(McapErrors, AFileLeavesNoDescriptorOpen) {
  const std::string data(50, 'a');
  const ByteView view{reinterpret_cast<const std::uint8_t*>(data.data()), data.size()};
  const auto before = OpenFiles();
  {
    gst::OutputFile file(Path("a"), false, gst::OutputFile::Existing::kKeep);
    EXPECT_TRUE(file.Append(view));
    EXPECT_EQ(OpenFiles(), before + 1);
  }
  EXPECT_EQ(OpenFiles(), before) << "it was not closed before it went";
  gst::OutputFile full(Path("b"), false, gst::OutputFile::Existing::kKeep);
  {
    const SmallDisk disk(20);
    EXPECT_FALSE(full.Append(view));
  }
  EXPECT_EQ(OpenFiles(), before) << "the disk is full";
}

TEST_F(McapErrors, ADeviceWithoutSpaceStays) {
  EXPECT_EQ(RecordError("location=/dev/full"), "No space is left for \"/dev/full\".");
  EXPECT_TRUE(std::filesystem::exists("/dev/full"));
}

TEST_F(McapErrors, TheLocationIsCheckedBeforeTheFirstBuffer) {
  EXPECT_EQ(RecordError(""), "The property location is wrong: it is not set.");
  EXPECT_EQ(RecordError("location=/nowhere/a.mcap"),
            "Cannot write \"/nowhere/a.mcap\": No such file or directory.");
  EXPECT_EQ(RecordError("location=" + folder_),
            "Cannot write \"" + folder_ + "\": Is a directory.");
  EXPECT_EQ(RecordError(At("a-%s.mcap")),
            "The property location is wrong: the file name may have one number, as in "
            "rec-%05d.mcap, and no other "
            "% than %%.");
  EXPECT_EQ(RecordError(At("a-%d-%d.mcap")),
            "The property location is wrong: the file name may have one number, as in "
            "rec-%05d.mcap, and no other "
            "% than %%.");
  EXPECT_EQ(
      RecordError("max-files=3" + At("a.mcap")),
      "The property location is wrong: several files need a number in it, as in rec-%05d.mcap.");
  EXPECT_TRUE(Files().empty());
}

/// A wrong location must cause an error at the start, not with the first slice.
TEST_F(McapErrors, AWrongLocationFailsTheStart) {
  for (const std::string& location :
       {std::string(), std::string("/nowhere/a.mcap"), folder_, Path("a-%s.mcap"),
        Path("b-%d-%d.mcap"), Path("a-%d/b.mcap")}) {
    const gst::ElementPtr sink(gst_element_factory_make("mcapsink", nullptr));
    g_object_set(sink.get(), "location", location.c_str(), nullptr);
    EXPECT_EQ(gst_element_set_state(sink.get(), GST_STATE_PAUSED), GST_STATE_CHANGE_FAILURE)
        << location;
    gst_element_set_state(sink.get(), GST_STATE_NULL);
  }
  EXPECT_TRUE(Files().empty());
}

TEST_F(McapErrors, OtherStreamsAreRefusedByName) {
  EXPECT_EQ(Play("videotestsrc num-buffers=1 ! mcapsink" + At("a.mcap")).error,
            "This stream cannot be recorded: mcapsink records clouds, coded slices, IMU samples "
            "and odometry, but not video/x-raw.");
  EXPECT_TRUE(Files().empty());
  // The error is posted at each attempt to start.
  Pipeline p("videotestsrc num-buffers=1 ! mcapsink" + At("a.mcap"));
  for (int round = 0; round < 2; ++round) {
    p.Forget();
    EXPECT_EQ(p.Run().error.rfind("This stream cannot be recorded", 0), 0U) << round;
  }
}

TEST_F(McapErrors, SamplesOfOtherFieldsAreRefusedByName) {
  const Harness h = RecordingTo(Path("a.mcap"));
  const ElementBus bus(h->element);
  gst_harness_set_src_caps_str(h.get(), "application/x-imu,sample-size=8,fields=(string)t:U64:0");
  EXPECT_EQ(bus.Text(GST_MESSAGE_ERROR),
            "This stream cannot be recorded: the fields of IMU samples must be "
            "t:U64:0,ax:F32:8,ay:F32:12,az:F32:16,gx:F32:20,gy:F32:24,gz:F32:28.");
}

TEST_F(McapErrors, CapsThatChangeTooOftenAreRefusedAndWhatWasRecordedStays) {
  guint64 recorded = 0;
  {
    const Harness h = RecordingTo(Path("a.mcap"));
    const ElementBus bus(h->element);
    SetPlaying(h.get());
    const auto push = [&](guint64 number) {
      const std::string caps = "application/x-lidar-slice,alignment=slice,codec-data=(buffer)" +
                               std::to_string(10'000 + number * 2) + std::string(100'001, '0');
      gst_harness_set_src_caps_str(h.get(), caps.c_str());
      GstBuffer* slice = gst_buffer_new_memdup("x", 1);
      gst_lidar_buffer_set_capture_time(slice, kCapture);
      return gst_harness_push(h.get(), slice);
    };
    while (recorded < 200 && push(recorded) == GST_FLOW_OK) ++recorded;
    const std::string why = "The caps of \"/slices\" change too often for one recording.";
    EXPECT_EQ(bus.Text(GST_MESSAGE_ERROR), why);
    EXPECT_NE(push(recorded), GST_FLOW_OK) << "again";
    EXPECT_EQ(bus.Text(GST_MESSAGE_ERROR), why);
    gst_harness_push_event(h.get(), gst_event_new_eos());
  }
  EXPECT_GE(recorded, 50U);
  const auto played = Play("mcapsrc name=m" + At("a.mcap") + " ! fakesink name=see");
  EXPECT_EQ(played.error + played.warning, "");
  EXPECT_EQ(played.buffers.at("see").size(), recorded);
}

TEST_F(McapErrors, APlayerSaysWhyItCannotPlay) {
  EXPECT_EQ(PlayError(""), "Cannot play \"\": location is not set.");
  EXPECT_EQ(PlayError("location=/nowhere.mcap"),
            "Cannot play \"/nowhere.mcap\": there is no such file.");
  EXPECT_EQ(PlayError("location=/dev/zero"),
            "Cannot play \"/dev/zero\": it is not a regular file.");
  ASSERT_EQ(mkfifo(Path("pipe.mcap").c_str(), 0600), 0);
  EXPECT_EQ(PlayError(At("pipe.mcap")),
            "Cannot play \"" + Path("pipe.mcap") + "\": it is not a regular file.");
  std::ofstream(Path("empty.mcap")).flush();
  EXPECT_EQ(PlayError(At("empty.mcap")),
            "Cannot play \"" + Path("empty.mcap") + "\": it is empty.");
  std::ofstream(Path("text.mcap")) << "This is no recording.";
  EXPECT_EQ(PlayError(At("text.mcap")),
            "Cannot play \"" + Path("text.mcap") + "\": it is not an MCAP file.");
  Record(1, "", "a.mcap");
  EXPECT_EQ(PlayError("topic=/other" + At("a.mcap")),
            "\"" + Path("a.mcap") + "\" has no topic that can be played.");
}

TEST_F(McapErrors, NestedCapsOfAStrangersChannelAreRefusedAtOnce) {
  std::string caps = "application/x-lidar-slice, alignment=(string)slice, a=";
  // Each level doubles the time that GStreamer's parser needs.
  while (caps.size() < 569) caps += "[[ a, b={";
  mcap::test::FileMaker maker(mcap::WriterSettings{});
  mcap::Channel channel;
  channel.topic = "/slices";
  channel.message_encoding = "cdr";
  channel.metadata = {{mcap::kCapsKey, caps}};
  ASSERT_TRUE(maker.Add(
      maker.AddChannel(gst::SchemaOf(gst::MessageType::kSlice), std::move(channel)), 1, "x"));
  Save(&maker);
  EXPECT_EQ(PlayError(At("a.mcap")), "\"" + Path("a.mcap") + "\" has no topic that can be played.");
}

TEST_F(McapErrors, ARecordingWhoseMessagesAreAllDamagedIsAnError) {
  mcap::test::FileMaker maker(mcap::WriterSettings{});
  mcap::Channel channel;
  channel.topic = "/slices";
  channel.message_encoding = "cdr";
  channel.metadata = {{mcap::kCapsKey, "application/x-lidar-slice, alignment=(string)slice"}};
  const auto id = maker.AddChannel(gst::SchemaOf(gst::MessageType::kSlice), std::move(channel));
  for (std::uint64_t time = 1; time <= 3; ++time) ASSERT_TRUE(maker.Add(id, time, "x"));
  Save(&maker);
  EXPECT_EQ(PlayError(At("a.mcap")), "No message of the recording can be read.");
}

TEST_F(McapErrors, ATopicInAnotherEncodingIsNoDamage) {
  mcap::test::FileMaker maker(mcap::WriterSettings{});
  const auto bytes = cdr::WriteImu({});
  for (const char* encoding : {"json", "cdr"}) {
    mcap::Channel channel;
    channel.topic = std::string("/imu_") + encoding;
    channel.message_encoding = encoding;
    const auto id = maker.AddChannel(gst::SchemaOf(gst::MessageType::kImu), std::move(channel));
    ASSERT_TRUE(maker.Add(id, 1, std::string(bytes.begin(), bytes.end())));
  }
  Save(&maker);
  const auto played = Play("mcapsrc name=m" + At("a.mcap") + " ! fakesink name=see");
  EXPECT_EQ(played.buffers.at("see").size(), 1U);
  EXPECT_EQ(played.stats.at("messages"), 1U);
  EXPECT_EQ(played.stats.at("messages-dropped"), 0U);
}

TEST_F(McapErrors, TopicsBeyondTwoHundredAndFiftySixHaveNoPad) {
  mcap::test::FileMaker maker(mcap::WriterSettings{});
  const auto bytes = cdr::WriteImu({});
  for (int i = 0; i < 258; ++i) {
    mcap::Channel channel;
    channel.topic = "/imu_" + std::to_string(i);
    channel.message_encoding = "cdr";
    const auto id = maker.AddChannel(gst::SchemaOf(gst::MessageType::kImu), std::move(channel));
    ASSERT_TRUE(maker.Add(id, 1, std::string(bytes.begin(), bytes.end())));
  }
  Save(&maker);
  Pipeline p("mcapsrc name=m" + At("a.mcap") + " ! fakesink name=see");
  gst_element_set_state(p.get(), GST_STATE_PLAYING);
  ASSERT_TRUE(p.Wait(GST_MESSAGE_EOS));
  EXPECT_EQ(p.Find("m")->numsrcpads, 256U);
  EXPECT_EQ(StatOf(p.Find("m").get(), "messages"), 258U);
  EXPECT_EQ(StatOf(p.Find("m").get(), "messages-dropped"), 2U);
  EXPECT_EQ(p.outcome().warning, "The recording is damaged: 0 chunks and 2 messages are left out.");
}

TEST_F(McapErrors, CloudsThatWouldBecomeHugeAreRefused) {
  mcap::Channel channel;
  channel.message_encoding = "cdr";
  const auto reader = gst::MessageReader::Make(gst::SchemaOf(gst::MessageType::kCloud), channel);
  ASSERT_TRUE(reader);
  // A point has only 1 byte in the message, but 12 bytes in the buffer.
  const auto reads = [&](std::uint32_t width) {
    const std::vector<std::uint8_t> points(width);
    cdr::PointCloud2 cloud;
    cloud.layout = {1, width, {{"x", 0, 2, 1}, {"y", 0, 2, 1}, {"z", 0, 2, 1}}, false, 1, width};
    cloud.data = {points.data(), points.size()};
    const auto message = cdr::WritePointCloud2(cloud);
    return reader->Read({message.data(), message.size()}) != nullptr;
  };
  EXPECT_TRUE(reads(1'000));
  EXPECT_FALSE(reads((256U << 20) / 12 + 1));
}

TEST_F(McapErrors, MessagesThatAreCutCostThemselvesOnly) {
  const auto imu = cdr::WriteImu({});
  const auto odometry = cdr::WriteOdometry({});
  for (const bool is_imu : {false, true}) {
    mcap::test::FileMaker maker(mcap::WriterSettings{});
    mcap::Channel channel;
    channel.topic = "/motion";
    channel.message_encoding = "cdr";
    const auto id = maker.AddChannel(
        gst::SchemaOf(is_imu ? gst::MessageType::kImu : gst::MessageType::kOdometry), channel);
    const auto& bytes = is_imu ? imu : odometry;
    ASSERT_TRUE(maker.Add(id, 1, std::string(bytes.begin(), bytes.end() - 8)));
    ASSERT_TRUE(maker.Add(id, 2, std::string(bytes.begin(), bytes.end())));
    Save(&maker);
    const auto played = Play("mcapsrc name=m" + At("a.mcap") + " ! fakesink name=see");
    EXPECT_EQ(played.buffers.at("see").size(), 1U) << is_imu;
    EXPECT_EQ(played.stats.at("messages-dropped"), 1U) << is_imu;
    EXPECT_EQ(played.warning, "The recording is damaged: 0 chunks and 1 messages are left out.");
  }
}

/// Slices without caps are not played. If the recorded caps of an IMU do not match its samples,
/// mcapsrc uses its own caps.
TEST_F(McapErrors, AStrangersChannelsDoNotKeepOthersFromBeingPlayed) {
  const auto imu = cdr::WriteImu({});
  const std::string ours = "fields=(string)\"" + std::string(kImuFields) + '"';
  for (const std::string& caps :
       {"sample-size=32,fields=(string)t:U64:0" + std::string(), "sample-size=8," + ours, ours}) {
    mcap::test::FileMaker maker(mcap::WriterSettings{});
    const auto add = [&](const std::string& topic, gst::MessageType type, const std::string& text,
                         const std::string& data) {
      mcap::Channel channel;
      channel.topic = topic;
      channel.message_encoding = "cdr";
      if (!text.empty()) channel.metadata = {{mcap::kCapsKey, text}};
      ASSERT_TRUE(maker.Add(maker.AddChannel(gst::SchemaOf(type), std::move(channel)), 1, data));
    };
    add("/slices", gst::MessageType::kSlice, "", "x");
    add("/imu", gst::MessageType::kImu, "application/x-imu," + caps,
        std::string(imu.begin(), imu.end()));
    Save(&maker);
    const auto played = Play("mcapsrc name=m" + At("a.mcap") + " ! fakesink name=see");
    EXPECT_EQ(played.error, "");
    ASSERT_EQ(played.buffers.at("see").size(), 1U);
    EXPECT_EQ(played.buffers.at("see")[0].bytes.size(), 32U);
    const std::string& seen = played.caps.at("see");
    EXPECT_NE(seen.find("sample-size=(int)32"), std::string::npos) << seen;
    EXPECT_NE(seen.find("ax:F32:8"), std::string::npos) << seen;
  }
}

TEST_F(McapErrors, MessagesOfTwoTypesInOneTopicAreNoDamage) {
  mcap::test::FileMaker maker(mcap::WriterSettings{});
  const auto add = [&](gst::MessageType type, const std::vector<std::uint8_t>& bytes) {
    mcap::Channel channel;
    channel.topic = "/motion";
    channel.message_encoding = "cdr";
    ASSERT_TRUE(maker.Add(maker.AddChannel(gst::SchemaOf(type), std::move(channel)), 1,
                          std::string(bytes.begin(), bytes.end())));
  };
  add(gst::MessageType::kOdometry, cdr::WriteOdometry({}));
  add(gst::MessageType::kImu, cdr::WriteImu({}));
  Save(&maker);
  const auto played = Play("mcapsrc name=m" + At("a.mcap") + " ! fakesink name=see");
  EXPECT_EQ(played.buffers.at("see").size(), 2U);
  EXPECT_EQ(played.stats.at("messages-dropped"), 0U);
}

TEST_F(McapErrors, APlayerSaysWhatTheNextElementDoesNotTake) {
  Record(1, "", "a.mcap");
  EXPECT_EQ(
      Play("mcapsrc" + At("a.mcap") + " ! pointcloudview ! fakesink").error,
      "The next element does not accept any stream of the recording: application/x-lidar-slice.");
}

TEST_F(McapErrors, CapsThatCouldNotBePlayedAreNotRecorded) {
  const Harness h = RecordingTo(Path("a.mcap"));
  const ElementBus bus(h->element);
  const std::string good = "application/x-voxels,alignment=slice";
  for (const std::string& caps : {good + ",levels=(int)<1,2>", good, good + ",levels=(int)<1,2>"})
    gst_harness_set_src_caps_str(h.get(), caps.c_str());
  const std::string why =
      "This stream cannot be recorded: the field levels is not a string, number, fraction, flag, "
      "buffer or array of doubles.";
  EXPECT_EQ(bus.Texts(GST_MESSAGE_ERROR), (std::vector<std::string>{why, why}));
}

TEST_F(McapErrors, APipelineThatIsStoppedLeavesACompleteFile) {
  Pipeline p(kSensor + " is-live=true ! lidarenc ! mcapsink name=m" + At("a.mcap"));
  gst_element_set_state(p.get(), GST_STATE_PLAYING);
  EXPECT_TRUE(p.AwaitStat("messages", 5));
  gst_element_set_state(p.get(), GST_STATE_NULL);  // without EOS
  const auto played = Play("mcapsrc name=m" + At("a.mcap") + " ! fakesink name=see");
  EXPECT_EQ(played.error, "");
  EXPECT_EQ(played.stats.at("files-unclosed"), 0U);
}

TEST_F(McapErrors, NothingRecordedLeavesNoFile) {
  Pipeline p("appsrc ! mcapsink" + At("a.mcap"));
  gst_element_set_state(p.get(), GST_STATE_PLAYING);
  gst_element_set_state(p.get(), GST_STATE_NULL);
  EXPECT_TRUE(Files().empty());
}

}  // namespace
}  // namespace lidar::test
