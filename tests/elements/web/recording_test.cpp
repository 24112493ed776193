// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of viewers that replay recordings. mcapsink has written the recordings, or still writes
// them.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <mutex>

#include "ext/web/file_archive.h"
#include "ext/web/recording.h"
#include "ext/web/upstream_archive.h"
#include "gst/common/history_query.h"
#include "tests/elements/scream/pipeline.h"
#include "tests/elements/web/slice_viewer.h"
#include "tests/support/files.h"

namespace lidar::test {
namespace {

namespace fs = std::filesystem;

/// The time of the first slice. Each slice is 25 ms later than the slice before it.
constexpr std::uint64_t kFirst_ns = 1'700'000'000'000'000'000;
constexpr std::uint64_t kSlice_ns = 25'000'000;

double Seconds(std::uint64_t ns) { return static_cast<double>(ns) * 1e-9; }

/// A fixture with an edge that serves slices and records them.
class Recordings : public FolderTest {
 protected:
  std::string path() const { return folder_ + "/r%d.mcap"; }
  std::string file() const { return folder_ + "/r0.mcap"; }
  void OpenEdge() { edge_.emplace("sink_0::recording=" + path()); }
  /// Pushes the next `n` slices to the edge and to the recorder.
  void Push(guint n) {
    for (guint i = 0; i < n; ++i) {
      gst::BufferPtr buffer = edge_->robot.Next();
      const std::uint64_t captured = kFirst_ns + pushed_++ / of_a_time_ * kSlice_ns;
      gst_lidar_buffer_set_capture_time(buffer.get(), captured);
      GST_BUFFER_PTS(buffer.get()) = captured - kFirst_ns;
      if (!recorder_) {
        GstElement* sink = gst_element_factory_make("mcapsink", nullptr);
        g_object_set(sink, "location", path().c_str(), "max-file-duration", 100 * GST_SECOND,
                     nullptr);
        recorder_.reset(gst_harness_new_with_element(sink, "sink_0", nullptr));
        gst_harness_set_src_caps(recorder_.get(), edge_->robot.caps().release());
      }
      gst_harness_push(recorder_.get(), gst_buffer_ref(buffer.get()));
      edge_->Push(std::move(buffer));
    }
  }
  /// Ends the recording, which completes the file.
  void EndRecording() { recorder_.reset(); }

  std::optional<Edge> edge_;
  Harness recorder_;
  std::uint64_t pushed_ = 0;
  std::uint64_t of_a_time_ = 1;  // number of slices that have the same time
};

void Replay(Viewer* viewer, guint number, double time) {
  viewer->peer.SendText(nlohmann::json{
      {"op", "replay"},
      {"subscriptionId", 9},
      {"number", number},
      {"time", time}}.dump());
}

nlohmann::json AwaitStatus(Viewer* viewer, guint number) {
  EXPECT_TRUE(WaitUntil([&] {
    return viewer->peer.recording.is_object() && viewer->peer.recording["number"] == number;
  }));
  return viewer->peer.recording;
}

/// Waits until the replay has read its whole recording. Returns the number of damaged messages.
nlohmann::json DamagedAtEnd(Viewer* viewer, guint number) {
  EXPECT_TRUE(WaitUntil([&] { return AwaitStatus(viewer, number)["end"].is_number(); }));
  return viewer->peer.recording["damaged"];
}

/// A recording whose slices do not refer to other slices.
class LargeArchive final : public web::Archive {
 public:
  explicit LargeArchive(std::size_t size) : size_(size) {}
  std::optional<Times> Look(std::string*) override { return Times{kFirst_ns, TimeOf(kCount - 1)}; }
  void Seek(std::uint64_t time_ns) override {
    next_ = 0;
    while (TimeOf(next_) < time_ns) ++next_;
  }
  void GoOn(std::uint64_t position) override { next_ = position; }
  std::optional<Item> Next() override {
    if (next_ == kCount) return {};
    auto slice = std::make_shared<web::SliceMessage>();
    slice->id.scan = static_cast<std::uint32_t>(next_);
    slice->unix_ns = TimeOf(next_);
    slice->payload.resize(size_);
    ++next_;
    return Item{slice->unix_ns, next_, size_, slice, false};
  }
  void Rest() override {}
  std::uint64_t damaged() const override { return 0; }

  static std::uint64_t TimeOf(std::uint64_t i) { return kFirst_ns + i * kSlice_ns; }
  static constexpr std::uint64_t kCount = 1'000;

 private:
  const std::size_t size_;
  std::uint64_t next_ = 0;
};

/// A jump also reads the slices before its time, because later slices may refer to them. Here they
/// are more than the recording keeps.
TEST(Recording, ThatIsLargeGivesWhatIsWanted) {
  web::Recording recording(std::make_unique<LargeArchive>(100'000));
  const std::uint64_t time = LargeArchive::TimeOf(600);
  const auto piece = recording.Jump(time);
  ASSERT_FALSE(piece.slices.empty());
  EXPECT_EQ(piece.slices.front()->unix_ns, LargeArchive::TimeOf(590));
  EXPECT_EQ(piece.slices.size(), 6U) << "of more than half a megabyte";
  const auto more = recording.GoOn(piece.next);
  ASSERT_EQ(more.slices.size(), 6U);
  EXPECT_EQ(more.slices.front()->unix_ns, LargeArchive::TimeOf(596));
}

TEST(Recording, ShowsItsNearestEndForATimeOutsideOfIt) {
  web::Recording recording(std::make_unique<LargeArchive>(1'000));
  const auto begin = recording.Jump(0);
  ASSERT_FALSE(begin.slices.empty());
  EXPECT_EQ(begin.slices.front()->unix_ns, kFirst_ns);
  const auto end = recording.Jump(LargeArchive::TimeOf(2 * LargeArchive::kCount));
  ASSERT_EQ(end.slices.size(), 11U) << "of the last quarter of a second";
  EXPECT_EQ(end.slices.front()->unix_ns, LargeArchive::TimeOf(LargeArchive::kCount - 11));
}

TEST_F(Recordings, AreOfferedWithTheirTimes) {
  OpenEdge();
  Push(400);  // 10 s
  EndRecording();
  Viewer viewer(&edge_->sink);
  const auto stream =
      nlohmann::json::parse(viewer.peer.channels["/points/slices"]["schema"].get<std::string>());
  EXPECT_EQ(stream["recording"], true);
  const auto status = AwaitStatus(&viewer, 0);
  EXPECT_EQ(status["subscriptionId"], 9);
  EXPECT_NEAR(status["from"], Seconds(kFirst_ns), 1e-3);
  EXPECT_NEAR(status["to"], Seconds(kFirst_ns + 399 * kSlice_ns), 1e-3);
}

TEST_F(Recordings, ArePlayedFromATimeOnInPlaceOfWhatIsNew) {
  OpenEdge();
  Push(400);
  EndRecording();
  Viewer viewer(&edge_->sink);
  const std::uint64_t time = kFirst_ns + 200 * kSlice_ns;
  Replay(&viewer, 3, Seconds(time));
  AwaitStatus(&viewer, 3);
  // All slices can be decoded, because the slices that they refer to are sent before them.
  std::uint64_t last = 0;
  unsigned at_time = 0;
  while (last < time + 20 * kSlice_ns) {
    viewer.Draw();
    const SliceReader slice(viewer.last);
    EXPECT_EQ(slice.replay, 3U);
    EXPECT_GT(viewer.last.unix_ns, last);
    last = viewer.last.unix_ns;
    if (last > time - 12 * kSlice_ns && last <= time) ++at_time;
  }
  EXPECT_GE(at_time, 2 * kScanSlices);
  Push(kScanSlices);
  viewer.peer.SendText(R"({"op":"live","subscriptionId":9})");
  viewer.peer.Sync();
  while (!viewer.peer.received.empty()) viewer.Draw();
  Push(2 * kScanSlices);
  do viewer.Draw();
  while (SliceReader(viewer.last).replay != 0);
}

TEST_F(Recordings, GrowWhileTheyArePlayed) {
  OpenEdge();
  Push(160);  // 4 s
  Viewer viewer(&edge_->sink);
  Replay(&viewer, 1, Seconds(kFirst_ns));
  const double end = AwaitStatus(&viewer, 1)["to"];
  EXPECT_LT(end, Seconds(kFirst_ns + 160 * kSlice_ns));
  Push(160);
  Replay(&viewer, 2, end);
  EXPECT_TRUE(WaitUntil([&] { return AwaitStatus(&viewer, 2)["to"] > end + 2; }));
  do viewer.Draw();
  while (SliceReader(viewer.last).replay != 2);
}

TEST_F(Recordings, AreSentAsFastAsTheViewerDrawsThem) {
  OpenEdge();
  Push(600);
  EndRecording();
  Viewer viewer(&edge_->sink);
  Replay(&viewer, 1, Seconds(kFirst_ns + 10 * kSlice_ns));
  for (int i = 0; i < 8; ++i) viewer.Draw();
  // The viewer stops acknowledging. Therefore the rest of the recording must wait.
  for (int i = 0; i < 40; ++i) viewer.peer.Sync();
  EXPECT_LE(viewer.peer.received.size(), 512U);
}

TEST_F(Recordings, WhoseChunksAreDamagedPlayOnWithoutThem) {
  OpenEdge();
  Push(400);
  EndRecording();
  {
    std::fstream bytes(file(), std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(static_cast<std::streamoff>(fs::file_size(file()) / 2));
    bytes.write("damage", 6);
  }
  Viewer viewer(&edge_->sink);
  for (guint replay = 1; replay <= 2; ++replay) {
    Replay(&viewer, replay, Seconds(kFirst_ns + 399 * kSlice_ns));
    EXPECT_EQ(DamagedAtEnd(&viewer, replay), 1);
  }
  ASSERT_TRUE(WaitUntil([&] { return !viewer.peer.received.empty(); }));
}

TEST_F(Recordings, CountTheDamageOfAllTheirPieces) {
  OpenEdge();
  for (int i = 0; i < 600; ++i) {
    edge_->robot.AskForKey();  // the next slices are large
    Push(1);
  }
  EndRecording();
  {
    std::fstream bytes(file(), std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(static_cast<std::streamoff>(fs::file_size(file()) / 8));
    bytes.write("damage", 6);
  }
  ASSERT_GT(fs::file_size(file()), web::Recording::kPiece / 4 * 5);
  Viewer viewer(&edge_->sink);
  Replay(&viewer, 1, Seconds(kFirst_ns));
  while (!AwaitStatus(&viewer, 1)["end"].is_number()) {
    const SliceReader slice(viewer.peer.Next());
    viewer.Acknowledge(slice.scan, slice.index);
  }
  EXPECT_EQ(viewer.peer.recording["damaged"], 1);
}

TEST_F(Recordings, ThatAreMissingOrNoRecordingsSaySo) {
  OpenEdge();
  Push(kScanSlices);
  EndRecording();
  fs::remove(file());
  Viewer viewer(&edge_->sink);
  Replay(&viewer, 1, Seconds(kFirst_ns));
  EXPECT_EQ(AwaitStatus(&viewer, 1)["to"], 0);
  std::ofstream(file()) << "no recording";
  Replay(&viewer, 2, Seconds(kFirst_ns));
  EXPECT_EQ(AwaitStatus(&viewer, 2)["to"], 0);
  viewer.peer.SendText(R"({"op":"live","subscriptionId":9})");
  viewer.peer.Sync();
  Push(1);
  viewer.Draw();
}

TEST_F(Recordings, EndWhereTheyEnd) {
  OpenEdge();
  Push(200);
  EndRecording();
  Viewer viewer(&edge_->sink);
  Replay(&viewer, 1, Seconds(kFirst_ns + 180 * kSlice_ns));
  while (viewer.last.unix_ns < kFirst_ns + 199 * kSlice_ns) viewer.Draw();
  ASSERT_TRUE(WaitUntil([&] { return viewer.peer.recording["end"].is_number(); }));
  EXPECT_NEAR(viewer.peer.recording["end"], Seconds(kFirst_ns + 199 * kSlice_ns), 1e-3);
  EXPECT_EQ(viewer.peer.recording["damaged"], 0);
}

TEST_F(Recordings, CostOtherViewersNothing) {
  OpenEdge();
  Push(400);
  EndRecording();
  Viewer replaying(&edge_->sink);
  Viewer live(&edge_->sink);
  Replay(&replaying, 1, Seconds(kFirst_ns));
  AwaitStatus(&replaying, 1);
  for (guint i = 0; i < 2 * kScanSlices; ++i) {
    Push(1);
    live.Draw();
    EXPECT_EQ(SliceReader(live.last).replay, 0U);
    EXPECT_GE(live.last.unix_ns, kFirst_ns + 400 * kSlice_ns);
  }
}

/// Plays a pipeline until EOS.
void RunToTheEnd(const std::string& description) {
  Pipeline pipeline(description);
  pipeline.Play();
  EXPECT_TRUE(pipeline.Ends());
}

TEST_F(Recordings, HaveThePosesOfTheSensorBetweenTheSlices) {
  RunToTheEnd(
      "lidartestsrc model=os0-32 mode=512x10 slices-per-scan=1 speed=5 num-buffers=30 "
      "! lidarodometry name=o mcapsink name=m location=" +
      path() + " o.src ! queue ! lidarenc ! m. o.odometry ! queue ! m.");
  OpenEdge();
  Push(1);
  Viewer viewer(&edge_->sink);
  Replay(&viewer, 1, AwaitStatus(&viewer, 0)["from"].get<double>() + 1);
  for (int i = 0; i < 15; ++i) viewer.Draw();
  ASSERT_GE(viewer.poses.size(), 12U);
  for (const Received& pose : viewer.poses) {
    EXPECT_EQ(SliceReader(pose).replay, 1U);
    EXPECT_LE(pose.unix_ns, viewer.last.unix_ns);
  }
  EXPECT_NE(viewer.poses.front().payload.find("lidar"), std::string::npos);
}

TEST_F(Recordings, OfAnotherSensorAreNotShown) {
  RunToTheEnd(
      "lidartestsrc model=os1-64 mode=512x10 num-buffers=80 ! lidarenc ! mcapsink location=" +
      path());
  Edge edge("sink_0::recording=" + path());
  edge.Push();
  Viewer viewer(&edge.sink);
  Replay(&viewer, 1, 1e9);
  EXPECT_EQ(AwaitStatus(&viewer, 1)["to"], 0);
  for (int i = 0; i < 20; ++i) viewer.peer.Sync();
  EXPECT_TRUE(viewer.peer.received.empty());
}

TEST_F(Recordings, AreNotThereForAStreamWithoutOne) {
  edge_.emplace();
  Push(kScanSlices);
  Viewer viewer(&edge_->sink);
  Replay(&viewer, 1, Seconds(kFirst_ns));
  viewer.peer.Sync();
  EXPECT_TRUE(viewer.peer.recording.is_null());
  Push(1);
  viewer.Draw();
  EXPECT_EQ(SliceReader(viewer.last).replay, 0U);
}

/// A source of slices and poses. It stores what it sent and answers history queries, as a natssrc
/// with JetStream does.
class KeptStream {
 public:
  explicit KeptStream(GstPad* pad) : pad_(pad) {
    gst_pad_set_query_function_full(
        pad,
        [](GstPad* of, GstObject* parent, GstQuery* query) -> gboolean {
          const auto question = gst::ParseHistoryQuestion(query);
          if (!question) return gst_pad_query_default(of, parent, query);
          return static_cast<KeptStream*>(of->querydata)->Answer(*question, query);
        },
        this, nullptr);
  }
  ~KeptStream() { gst_pad_set_query_function(pad_, gst_pad_query_default); }

  void Keep(GstBuffer* buffer, const gst::CapsPtr& caps) {
    GstBuffer* kept = gst_buffer_copy(buffer);
    const std::lock_guard lock(mutex_);
    GST_BUFFER_OFFSET(kept) = buffers_.size() + 1;
    GstLidarPose pose{{1, 2, 3}, {0, 0, 0, 1}, GST_LIDAR_TRACKING_OK, {}};
    if (buffers_.size() % kScanSlices == 0) gst_lidar_buffer_set_pose(kept, &pose);
    buffers_.emplace_back(gst_sample_new(kept, caps.get(), nullptr, nullptr));
    gst_buffer_unref(kept);
  }
  /// Makes the next answer report `messages` damaged messages.
  void LeaveOut(guint64 messages) {
    const std::lock_guard lock(mutex_);
    left_out_ = messages;
  }
  /// Returns a lock. While the lock exists, history queries get no answer.
  std::unique_lock<std::mutex> Hang() { return std::unique_lock(mutex_); }
  /// Returns the number of answers without samples, which only tell the times of the recording.
  unsigned looks() {
    const std::lock_guard lock(mutex_);
    return looks_;
  }
  /// Returns the number of answers to questions that began at a time, not at a position.
  unsigned jumps() {
    const std::lock_guard lock(mutex_);
    return jumps_;
  }
  /// Makes all further queries fail, as if the server were unreachable.
  void End() {
    const std::lock_guard lock(mutex_);
    is_there_ = false;
  }

 private:
  static std::uint64_t TimeOf(const gst::SamplePtr& sample) {
    return gst_lidar_buffer_get_capture_time(gst_sample_get_buffer(sample.get()));
  }
  bool Answer(const gst::HistoryQuestion& question, GstQuery* query) {
    const std::lock_guard lock(mutex_);
    if (!is_there_) return false;
    gst::HistoryAnswer answer;
    if (!buffers_.empty()) answer.from = TimeOf(buffers_.front());
    if (!buffers_.empty()) answer.to = TimeOf(buffers_.back());
    // As with JetStream, the samples begin up to a second before the requested time.
    const bool by_time = GST_CLOCK_TIME_IS_VALID(question.time);
    jumps_ += by_time ? 1 : 0;
    looks_ += question.most_bytes == 0 ? 1 : 0;
    const auto first = std::find_if(buffers_.begin(), buffers_.end(), [&](const auto& sample) {
      return by_time ? TimeOf(sample) + GST_SECOND >= question.time
                     : GST_BUFFER_OFFSET(gst_sample_get_buffer(sample.get())) >= question.position;
    });
    if (question.most_bytes > 0) answer.damaged = std::exchange(left_out_, 0);
    guint64 size = 0;
    auto next = first;
    for (; next != buffers_.end() && size < std::min<guint64>(question.most_bytes, 20'000);
         ++next) {
      size += gst_buffer_get_size(gst_sample_get_buffer(next->get()));
      answer.samples.emplace_back(gst_sample_ref(next->get()));
    }
    answer.position = static_cast<guint64>(next - buffers_.begin()) + 1;
    answer.ended = next == buffers_.end();
    gst::SetHistoryAnswer(query, answer);
    return true;
  }

  GstPad* const pad_;
  std::mutex mutex_;
  std::vector<gst::SamplePtr> buffers_;
  guint64 left_out_ = 0;
  unsigned jumps_ = 0;
  unsigned looks_ = 0;
  bool is_there_ = true;
};

class Histories : public ::testing::Test {
 protected:
  void Push(guint n) {
    for (guint i = 0; i < n; ++i) {
      gst::BufferPtr buffer = edge_.robot.Next();
      gst_lidar_buffer_set_capture_time(buffer.get(), kFirst_ns + pushed_++ * kSlice_ns);
      kept_.Keep(buffer.get(), edge_.robot.caps());
      edge_.Push(std::move(buffer));
    }
  }

  Edge edge_;
  KeptStream kept_{edge_.sink.harness()->srcpad};
  std::uint64_t pushed_ = 0;
};

/// The position after an item of an archive, and the number of slices before that position.
struct PlaceInArchive {
  std::uint64_t position = 0;
  std::size_t slices = 0;
};

/// Reads the archive to its end. Returns the times of the slices.
std::vector<std::uint64_t> RestOf(web::Archive* archive,
                                  std::vector<PlaceInArchive>* places = nullptr) {
  std::vector<std::uint64_t> times;
  while (const auto item = archive->Next()) {
    EXPECT_FALSE(item->is_damaged);
    if (!item->slice) continue;
    if (!item->slice->is_pose) times.push_back(item->slice->unix_ns);
    if (places != nullptr) places->push_back({item->position, times.size()});
  }
  return times;
}

/// Expects that reading from each position of the archive returns every later slice exactly once.
void ExpectPiecesToFit(web::Archive* archive, guint slices) {
  std::string why;
  const auto times = archive->Look(&why);
  ASSERT_TRUE(times) << why;
  EXPECT_EQ(times->from_ns, kFirst_ns);
  EXPECT_EQ(times->to_ns, kFirst_ns + (slices - 1) * kSlice_ns);
  std::vector<PlaceInArchive> places;
  archive->Seek(kFirst_ns);
  const auto all = RestOf(archive, &places);
  ASSERT_EQ(all.size(), slices);
  for (guint i = 0; i < slices; ++i) {
    EXPECT_EQ(all[i], kFirst_ns + i * kSlice_ns);
    archive->Seek(all[i]);
    EXPECT_EQ(RestOf(archive).size(), slices - i) << i;
  }
  for (const PlaceInArchive& place : places) {
    archive->GoOn(place.position);
    const std::vector<std::uint64_t> behind(all.begin() + static_cast<std::ptrdiff_t>(place.slices),
                                            all.end());
    EXPECT_EQ(RestOf(archive), behind) << "behind " << place.slices << " slices";
    archive->Rest();
  }
  EXPECT_EQ(archive->damaged(), 0U);
}

web::SliceCaps CapsOf(Edge* edge) {
  std::string why;
  const gst::CapsPtr caps(edge->robot.caps());
  auto parsed = web::SliceCaps::Parse(caps.get(), &why);
  EXPECT_TRUE(parsed) << why;
  return *std::move(parsed);
}

TEST_F(Recordings, AreTheSameInPiecesOfAnySize) {
  OpenEdge();
  Push(24);
  EndRecording();
  web::FileArchive archive(path(), CapsOf(&*edge_));
  ExpectPiecesToFit(&archive, 24);
}

TEST_F(Recordings, OfTwoSensorsAlikeAreThoseOfTheFirst) {
  OpenEdge();
  Push(4);
  {
    const Harness rear(gst_harness_new_with_element(recorder_->element, "sink_1", nullptr));
    gst_harness_set_src_caps(rear.get(), edge_->robot.caps().release());
    for (std::uint64_t i = 4; i < 7; ++i) {
      gst::BufferPtr buffer = edge_->robot.Next();
      gst_lidar_buffer_set_capture_time(buffer.get(), kFirst_ns + i * kSlice_ns);
      GST_BUFFER_PTS(buffer.get()) = i * kSlice_ns;
      EXPECT_EQ(gst_harness_push(rear.get(), buffer.release()), GST_FLOW_OK);
    }
  }
  EndRecording();
  web::FileArchive archive(path(), CapsOf(&*edge_));
  std::string why;
  ASSERT_TRUE(archive.Look(&why)) << why;
  archive.Seek(kFirst_ns);
  EXPECT_EQ(RestOf(&archive).size(), 4U);
}

TEST_F(Recordings, MissNoSliceOfATimeBetweenTwoPieces) {
  OpenEdge();
  constexpr std::size_t kSlices = 600;
  of_a_time_ = 8;
  for (std::size_t i = 0; i < kSlices; ++i) {
    edge_->robot.AskForKey();  // the next slices are large
    Push(1);
  }
  EndRecording();
  web::Recording recording(std::make_unique<web::FileArchive>(path(), CapsOf(&*edge_)));
  web::Recording::Piece piece = recording.Jump(kFirst_ns);
  EXPECT_FALSE(piece.ended);
  std::size_t slices = piece.slices.size();
  while (!piece.ended) {
    piece = recording.GoOn(piece.next);
    slices += piece.slices.size();
  }
  EXPECT_EQ(slices, kSlices);
}

TEST_F(Histories, AreTheSameInPiecesOfAnySize) {
  Push(24);
  web::UpstreamArchive archive(
      [this](GstQuery* query) {
        return gst_pad_query(edge_.sink.harness()->srcpad, query) != FALSE;
      },
      CapsOf(&edge_), "lidar");
  ExpectPiecesToFit(&archive, 24);
}

TEST_F(Histories, OfASourceAreRecordings) {
  Push(400);
  Viewer viewer(&edge_.sink);
  EXPECT_NEAR(AwaitStatus(&viewer, 0)["from"], Seconds(kFirst_ns), 1e-3);
  const std::uint64_t time = kFirst_ns + 200 * kSlice_ns;
  Replay(&viewer, 3, Seconds(time));
  EXPECT_NEAR(AwaitStatus(&viewer, 3)["to"], Seconds(kFirst_ns + 399 * kSlice_ns), 1e-3);
  std::uint64_t last = 0;
  while (last < kFirst_ns + 399 * kSlice_ns) {
    viewer.Draw();
    EXPECT_EQ(SliceReader(viewer.last).replay, 3U);
    EXPECT_GT(viewer.last.unix_ns, last);
    last = viewer.last.unix_ns;
  }
  EXPECT_GE(viewer.poses.size(), 200 / kScanSlices);
  EXPECT_TRUE(WaitUntil([&] { return viewer.peer.recording["end"].is_number(); }));
}

TEST_F(Histories, CountWhatIsDamaged) {
  const gst::BufferPtr empty(gst_buffer_new());
  gst_lidar_buffer_set_capture_time(empty.get(), kFirst_ns);
  kept_.Keep(empty.get(), edge_.robot.caps());
  kept_.LeaveOut(2);
  Push(200);
  Viewer viewer(&edge_.sink);
  Replay(&viewer, 1, Seconds(kFirst_ns));
  while (viewer.last.unix_ns < kFirst_ns + 199 * kSlice_ns) viewer.Draw();
  EXPECT_EQ(DamagedAtEnd(&viewer, 1), 3);
}

TEST_F(Histories, WhoseServerIsGoneSaySo) {
  Push(kScanSlices);
  kept_.End();
  Viewer viewer(&edge_.sink);
  Replay(&viewer, 1, Seconds(kFirst_ns));
  EXPECT_EQ(AwaitStatus(&viewer, 1)["to"], 0);
  viewer.peer.SendText(R"({"op":"live","subscriptionId":9})");
  viewer.peer.Sync();
  Push(1);
  viewer.Draw();
}

TEST_F(Histories, WhoseServerStopsAnsweringSaySo) {
  Push(kScanSlices);
  bool is_slow = false;
  web::Recording recording(std::make_unique<web::UpstreamArchive>(
      [&](GstQuery* query) {
        if (!is_slow || gst::ParseHistoryQuestion(query)->most_bytes == 0)
          return gst_pad_query(edge_.sink.harness()->srcpad, query) != FALSE;
        gst::HistoryAnswer slow;
        slow.unanswered = true;
        gst::SetHistoryAnswer(query, slow);
        return true;
      },
      CapsOf(&edge_), "lidar"));
  const auto whole = recording.Jump(kFirst_ns);
  EXPECT_EQ(whole.why, "");
  EXPECT_NE(whole.to_ns, 0U);
  is_slow = true;
  const auto late = recording.GoOn(whole.next);
  EXPECT_EQ(late.why, "the server that keeps it does not answer");
  EXPECT_EQ(late.to_ns, 0U);
}

/// If histories were still read for a subscription that was replaced, a viewer could fill the
/// memory with requests, each for a new subscription.
TEST_F(Histories, AreNotReadForASubscriptionThatAnotherReplaced) {
  Push(40);
  Viewer viewer(&edge_.sink);
  AwaitStatus(&viewer, 0);
  const unsigned looks = kept_.looks();
  constexpr guint kJumps = 10;
  {
    const auto hanging = kept_.Hang();
    for (guint i = 1; i <= kJumps; ++i) {
      viewer.peer.Subscribe("/points/slices", 9);
      Replay(&viewer, i, Seconds(kFirst_ns));
    }
    viewer.peer.Sync();
  }
  EXPECT_EQ(DamagedAtEnd(&viewer, kJumps), 0);
  EXPECT_LE(kept_.jumps(), 2U) << "the one under way and the last";
  EXPECT_LT(kept_.looks() - looks, kJumps) << "some under way, and one for all that wait";
}

TEST_F(Recordings, SurviveAViewerThatJumpsWithoutEnd) {
  OpenEdge();
  Push(400);
  Viewer viewer(&edge_->sink);
  for (guint i = 1; i <= 2000; ++i)
    Replay(&viewer, i, i % 3 == 0 ? 1e10 : Seconds(kFirst_ns + (i % 400) * kSlice_ns));
  AwaitStatus(&viewer, 2000);
  Peer other(&edge_->sink);
  other.Sync();  // an answer shows that the server still serves other viewers
  EXPECT_FALSE(viewer.peer.closed());
}

}  // namespace
}  // namespace lidar::test
