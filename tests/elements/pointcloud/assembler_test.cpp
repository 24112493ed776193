// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "gst/common/buffer_map.h"
#include "gst/lidar/cloud_info.h"
#include "tests/support/clock_wait.h"
#include "tests/support/element_bus.h"
#include "tests/support/element_stats.h"
#include "tests/support/harness.h"
#include "tests/support/patience.h"

namespace lidar::gst {
namespace {

using test::Harness;

constexpr guint kBeams = 2;
constexpr guint kColumns = 32;  // columns of a full turn
constexpr guint kSlices = 4;
constexpr guint kWidth = kColumns / kSlices;
constexpr GstClockTime kSweep = 25 * GST_MSECOND;

/// Returns the info of slices from a sensor with 2 beams, 32 columns and 10 scans per second. The
/// points have one byte of intensity.
CloudInfo SliceInfo(guint width = kWidth) {
  CloudInfo info;
  info.width = width;
  info.height = kBeams;
  info.point_step = 13;
  info.fields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,intensity:U8:12");
  info.framerate_n = 10;
  info.sensor_model.emplace();
  info.sensor_model->columns_per_scan = kColumns;
  info.sensor_model->beams = {{0, 1, 0}, {0, -1, 0}};
  return info;
}

struct SliceSpec {
  guint scan = 0;
  guint index = 0;
  guint count = kSlices;
  guint first_column = 0;
};

/// Returns a slice. All its bytes have the value 1 + its index, so a 0 in a scan belongs to a
/// missing column.
BufferPtr MakeSlice(const SliceSpec& spec, gsize size = SliceInfo().FrameSize()) {
  BufferPtr buffer(gst_buffer_new_allocate(nullptr, size, nullptr));
  gst_buffer_memset(buffer.get(), 0, static_cast<guint8>(1 + spec.index), size);
  const GstLidarSlice meta{spec.scan, spec.index, spec.count, spec.first_column};
  gst_lidar_buffer_set_slice(buffer.get(), &meta);
  GST_BUFFER_PTS(buffer.get()) = (spec.scan * kSlices + spec.index) * kSweep;
  GST_BUFFER_DURATION(buffer.get()) = kSweep;
  gst_lidar_buffer_set_capture_time(buffer.get(), GST_SECOND + GST_BUFFER_PTS(buffer.get()));
  return buffer;
}

BufferPtr Slice(guint scan, guint index) {
  return MakeSlice({scan, index, kSlices, index * kWidth});
}

class Assembler : public ::testing::Test {
 protected:
  Assembler() : h_(gst_harness_new("scanassembler")) {
    gst_harness_set_live(h_.get(), FALSE);
    SetCaps(SliceInfo());
  }

  void SetCaps(const CloudInfo& info) { gst_harness_set_src_caps(h_.get(), info.ToCaps()); }
  void Push(BufferPtr buffer) {
    EXPECT_EQ(gst_harness_push(h_.get(), buffer.release()), GST_FLOW_OK);
  }
  guint Waiting() { return gst_harness_buffers_in_queue(h_.get()); }
  BufferPtr Pull() { return BufferPtr(gst_harness_pull(h_.get())); }
  guint64 Stat(const char* name) {
    const ElementPtr element(gst_harness_find_element(h_.get(), "scanassembler"));
    return test::StatOf(element.get(), name);
  }
  CloudInfo OutInfo() {
    const CapsPtr caps(gst_pad_get_current_caps(h_->sinkpad));
    return *CloudInfo::FromCaps(caps.get());
  }

  Harness h_;
};

/// Returns the first byte of each column, beam by beam. It is 1 + the index of the slice that has
/// the column.
std::vector<int> ColumnsOf(const BufferPtr& scan, gsize step = 13) {
  const BufferMap map(scan.get(), GST_MAP_READ);
  std::vector<int> columns;
  for (gsize at = 0; at < map.size(); at += step) columns.push_back(map.data()[at]);
  return columns;
}
std::vector<int> Columns(std::initializer_list<int> slices) {
  std::vector<int> columns;
  for (guint beam = 0; beam < kBeams; ++beam)
    for (const int slice : slices) columns.insert(columns.end(), kWidth, slice);
  return columns;
}
GstLidarSlice MetaOf(const BufferPtr& buffer) {
  GstLidarSlice meta{};
  EXPECT_TRUE(gst_lidar_buffer_get_slice(buffer.get(), &meta));
  return meta;
}
bool IsCorrupted(const BufferPtr& buffer) {
  return GST_BUFFER_FLAG_IS_SET(buffer.get(), GST_BUFFER_FLAG_CORRUPTED);
}

TEST_F(Assembler, PutsSlicesSideBySide) {
  for (guint i = 0; i < kSlices; ++i) {
    EXPECT_EQ(Waiting(), 0U);
    Push(Slice(5, i));
  }
  const BufferPtr scan = Pull();
  EXPECT_EQ(ColumnsOf(scan), Columns({1, 2, 3, 4}));
  EXPECT_FALSE(IsCorrupted(scan));
  EXPECT_EQ(OutInfo().width, kColumns);
  EXPECT_EQ(MetaOf(scan).scan_id, 5U);
  EXPECT_EQ(MetaOf(scan).slice_count, 1U);
  EXPECT_EQ(GST_BUFFER_PTS(scan.get()), 500 * GST_MSECOND);
  EXPECT_EQ(GST_BUFFER_DURATION(scan.get()), 100 * GST_MSECOND);
  EXPECT_EQ(gst_lidar_buffer_get_capture_time(scan.get()), 1'500 * GST_MSECOND);
}

TEST_F(Assembler, TakesSlicesInAnyOrder) {
  for (const guint i : {3U, 1U, 0U, 2U}) Push(Slice(0, i));
  const BufferPtr scan = Pull();
  EXPECT_EQ(ColumnsOf(scan), Columns({1, 2, 3, 4}));
  EXPECT_EQ(GST_BUFFER_PTS(scan.get()), 0U);
}

TEST_F(Assembler, HasTheTimesOfTheFirstSliceThoughItCameSecond) {
  Push(Slice(0, 1));
  BufferPtr first = Slice(0, 0);
  GST_BUFFER_PTS(first.get()) += GST_MSECOND;
  gst_lidar_buffer_set_capture_time(first.get(), 7 * GST_SECOND);
  Push(std::move(first));
  Push(Slice(0, 2));
  Push(Slice(0, 3));
  const BufferPtr scan = Pull();
  EXPECT_EQ(GST_BUFFER_PTS(scan.get()), GST_MSECOND);
  EXPECT_EQ(gst_lidar_buffer_get_capture_time(scan.get()), 7 * GST_SECOND);
}

TEST_F(Assembler, FlagsALostSliceAndLeavesItsColumnsZero) {
  for (const guint i : {0U, 1U, 3U}) Push(Slice(0, i));
  EXPECT_EQ(Waiting(), 0U);
  Push(Slice(1, 0));  // the stream is not live, so the next scan ends this one
  const BufferPtr scan = Pull();
  EXPECT_EQ(ColumnsOf(scan), Columns({1, 2, 0, 4}));
  EXPECT_TRUE(IsCorrupted(scan));
  for (guint i = 1; i < kSlices; ++i) Push(Slice(1, i));
  EXPECT_FALSE(IsCorrupted(Pull()));
  EXPECT_EQ(Stat("scans"), 2U);
  EXPECT_EQ(Stat("incomplete"), 1U);
}

TEST_F(Assembler, KnowsWhenAScanBeganWhoseFirstSliceWasLost) {
  for (guint i = 1; i < kSlices; ++i) Push(Slice(2, i));
  Push(Slice(3, 0));
  const BufferPtr scan = Pull();
  EXPECT_EQ(ColumnsOf(scan), Columns({0, 2, 3, 4}));
  EXPECT_EQ(GST_BUFFER_PTS(scan.get()), 200 * GST_MSECOND);
  EXPECT_EQ(gst_lidar_buffer_get_capture_time(scan.get()), 1'200 * GST_MSECOND);
  EXPECT_EQ(MetaOf(scan).first_column, 0U);
}

TEST_F(Assembler, KnowsTheTimesOfAScanWhoseSlicesHaveNoDuration) {
  for (guint i = 1; i < kSlices; ++i) {
    BufferPtr slice = Slice(2, i);
    GST_BUFFER_DURATION(slice.get()) = GST_CLOCK_TIME_NONE;
    Push(std::move(slice));
  }
  Push(Slice(3, 0));
  const BufferPtr scan = Pull();
  EXPECT_EQ(GST_BUFFER_PTS(scan.get()), 200 * GST_MSECOND);
  EXPECT_EQ(GST_BUFFER_DURATION(scan.get()), 100 * GST_MSECOND);
  EXPECT_EQ(gst_lidar_buffer_get_capture_time(scan.get()), 1'200 * GST_MSECOND);
}

TEST_F(Assembler, KeepsTheTimesOfOthersWhereTheFirstSliceComesLateAndHasNone) {
  for (guint i = 1; i < kSlices; ++i) Push(Slice(2, i));
  BufferPtr first(gst_buffer_copy_region(Slice(2, 0).get(), GST_BUFFER_COPY_MEMORY, 0, G_MAXSIZE));
  const GstLidarSlice meta{2, 0, kSlices, 0};
  gst_lidar_buffer_set_slice(first.get(), &meta);
  Push(std::move(first));
  const BufferPtr scan = Pull();
  EXPECT_EQ(GST_BUFFER_PTS(scan.get()), 200 * GST_MSECOND);
  EXPECT_EQ(gst_lidar_buffer_get_capture_time(scan.get()), 1'200 * GST_MSECOND);
}

TEST_F(Assembler, AWindowMayPassTheEndOfTheTurn) {
  // The sensor's window has 16 columns and begins at column 24. Its slices are at columns 24 and 0.
  // Scan 0 lacks the slice at column 24.
  Push(MakeSlice({0, 1, 2, 0}));
  Push(MakeSlice({1, 0, 2, 24}));
  Push(MakeSlice({1, 1, 2, 0}));
  const BufferPtr partial = Pull();
  EXPECT_EQ(MetaOf(partial).first_column, 24U);
  EXPECT_EQ(ColumnsOf(partial), Columns({0, 2}));
  const BufferPtr whole = Pull();
  EXPECT_EQ(MetaOf(whole).first_column, 24U);
  EXPECT_EQ(ColumnsOf(whole), Columns({1, 2}));
}

TEST_F(Assembler, CountsDuplicatesAndLateSlices) {
  Push(Slice(0, 0));
  Push(Slice(0, 0));
  Push(Slice(1, 0));
  Push(Slice(0, 2));
  EXPECT_EQ(ColumnsOf(Pull()), Columns({1, 0, 0, 0}));
  EXPECT_EQ(Stat("duplicate-slices"), 1U);
  EXPECT_EQ(Stat("late-slices"), 1U);
}

TEST_F(Assembler, FollowsASenderThatStartsAgain) {
  for (guint i = 0; i < kSlices; ++i) Push(Slice(1000, i));
  Pull();
  for (guint i = 0; i < kSlices; ++i) Push(Slice(0, i));
  EXPECT_EQ(MetaOf(Pull()).scan_id, 0U);
  EXPECT_EQ(Stat("late-slices"), 0U);
}

TEST_F(Assembler, TakesASliceOfSixteenScansBeforeForThatOfANewSender) {
  for (guint i = 0; i < kSlices; ++i) Push(Slice(100, i));
  Pull();
  Push(Slice(85, 0));
  EXPECT_EQ(Stat("late-slices"), 1U);
  for (guint i = 0; i < kSlices; ++i) Push(Slice(84, i));
  EXPECT_EQ(Stat("late-slices"), 1U);
  ASSERT_EQ(Waiting(), 1U);
  EXPECT_EQ(MetaOf(Pull()).scan_id, 84U);
}

TEST_F(Assembler, DropsSlicesThatNoScanIsMadeOf) {
  Push(MakeSlice({0, 4, 4, 0}));               // the index is larger than the count
  Push(MakeSlice({0, 0, 4'000'000'000U, 0}));  // more slices than a turn has columns
  Push(MakeSlice({0, 0, 0, 0}));               // the scan has no slices
  Push(MakeSlice({0, 0, 6, 0}));               // more columns than the sensor has
  Push(MakeSlice({0, 0, 4, 0}, 5));            // less than a slice
  Push(MakeSlice({0, 0, 4, 4'294'967'295U}));  // no turn has such a column
  EXPECT_EQ(Stat("invalid-slices"), 5U);
  for (guint i = 1; i < kSlices; ++i) Push(MakeSlice({0, i, kSlices, i * kWidth}));
  EXPECT_EQ(ColumnsOf(Pull()), Columns({1, 2, 3, 4}));
}

TEST_F(Assembler, RefusesAnotherCutOfAScanThatIsOpen) {
  Push(Slice(0, 0));
  Push(MakeSlice({0, 1, 2, 8}));
  EXPECT_EQ(Stat("invalid-slices"), 1U);
  for (guint i = 1; i < kSlices; ++i) Push(Slice(0, i));
  EXPECT_FALSE(IsCorrupted(Pull()));
}

TEST_F(Assembler, LetsThePartialScanGoAtTheEnd) {
  Push(Slice(0, 0));
  EXPECT_TRUE(gst_harness_push_event(h_.get(), gst_event_new_eos()));
  EXPECT_EQ(ColumnsOf(Pull()), Columns({1, 0, 0, 0}));
  GstEventType last = GST_EVENT_UNKNOWN;
  while (gst_harness_events_in_queue(h_.get()) > 0) {
    const EventPtr event(gst_harness_pull_event(h_.get()));
    last = GST_EVENT_TYPE(event.get());
  }
  EXPECT_EQ(last, GST_EVENT_EOS);
}

TEST_F(Assembler, AnEndWithoutAnyScanComesAfterCapsAndSegment) {
  EXPECT_TRUE(gst_harness_push_event(h_.get(), gst_event_new_eos()));
  std::vector<GstEventType> types;
  while (const EventPtr event{gst_harness_try_pull_event(h_.get())})
    types.push_back(GST_EVENT_TYPE(event.get()));
  EXPECT_EQ(types, (std::vector<GstEventType>{GST_EVENT_STREAM_START, GST_EVENT_CAPS,
                                              GST_EVENT_SEGMENT, GST_EVENT_EOS}));
  EXPECT_EQ(OutInfo().width, kColumns);
}

TEST_F(Assembler, AnEndWithoutAnyScanComesAfterTheCapsOfACloudWithoutAModel) {
  CloudInfo info = SliceInfo();
  info.sensor_model.reset();
  SetCaps(info);
  EXPECT_TRUE(gst_harness_push_event(h_.get(), gst_event_new_eos()));
  EXPECT_EQ(OutInfo().width, kWidth);
}

TEST_F(Assembler, KeepsNoBufferThatDownstreamRefuses) {
  Push(Slice(0, 0));
  gst_pad_set_active(h_->sinkpad, FALSE);
  const BufferPtr whole = MakeSlice({1, 0, 1, 0});
  EXPECT_EQ(gst_harness_push(h_.get(), gst_buffer_ref(whole.get())), GST_FLOW_FLUSHING);
  EXPECT_EQ(GST_MINI_OBJECT_REFCOUNT_VALUE(whole.get()), 1);
}

TEST(AssemblerWithoutCaps, RefusesBuffersWithAnError) {
  const Harness h(gst_harness_new("scanassembler"));
  const test::ElementBus bus(h->element);
  gst_harness_play(h.get());
  gst_pad_push_event(h->srcpad, gst_event_new_stream_start("test"));
  gst_pad_push_event(h->srcpad, test::NewSegment());
  const BufferPtr slice = Slice(0, 0);
  EXPECT_EQ(gst_pad_push(h->srcpad, gst_buffer_ref(slice.get())), GST_FLOW_NOT_NEGOTIATED);
  EXPECT_EQ(GST_MINI_OBJECT_REFCOUNT_VALUE(slice.get()), 1);
  EXPECT_EQ(bus.Text(GST_MESSAGE_ERROR), "A buffer arrived before the caps of a point cloud.");
}

TEST_F(Assembler, OtherCapsOfTheSameLayoutLeaveAScanOpen) {
  CloudInfo faster = SliceInfo();
  faster.framerate_n = 20;
  Push(Slice(0, 0));
  SetCaps(faster);
  EXPECT_EQ(Waiting(), 0U);
  for (guint i = 1; i < kSlices; ++i) Push(Slice(0, i));
  EXPECT_FALSE(IsCorrupted(Pull()));
}

TEST_F(Assembler, ForgetsOnFlush) {
  Push(Slice(7, 0));
  test::Flush(h_.get());
  for (guint i = 0; i < kSlices; ++i) Push(Slice(0, i));
  EXPECT_EQ(MetaOf(Pull()).scan_id, 0U);
  EXPECT_EQ(Waiting(), 0U);
}

TEST_F(Assembler, TakesEarlierScansBehindAFlush) {
  for (guint i = 0; i < kSlices; ++i) Push(Slice(7, i));
  EXPECT_EQ(MetaOf(Pull()).scan_id, 7U);
  test::Flush(h_.get());
  for (guint i = 0; i < kSlices; ++i) Push(Slice(5, i));
  ASSERT_EQ(Waiting(), 1U);
  EXPECT_EQ(MetaOf(Pull()).scan_id, 5U);
  EXPECT_EQ(Stat("late-slices"), 0U);
}

TEST_F(Assembler, PassesWholeScansAsTheyAre) {
  BufferPtr plain(gst_buffer_new_allocate(nullptr, SliceInfo().FrameSize(), nullptr));
  GstBuffer* const address = plain.get();
  Push(std::move(plain));
  EXPECT_EQ(Pull().get(), address);
  EXPECT_EQ(OutInfo().width, kWidth);
}

TEST_F(Assembler, WarnsOnceOfSlicesThatLostTheirMeta) {
  const test::ElementBus bus(h_->element);
  for (int i = 0; i < 3; ++i) {
    Push(BufferPtr(gst_buffer_new_allocate(nullptr, SliceInfo().FrameSize(), nullptr)));
    EXPECT_TRUE(Pull());
  }
  EXPECT_NE(bus.Text(GST_MESSAGE_WARNING).find("8 of the sensor's 32 columns"), std::string::npos);
  EXPECT_FALSE(bus.Pop(GST_MESSAGE_WARNING));
}

TEST_F(Assembler, WarnsOfNoScanWithoutAMeta) {
  const test::ElementBus bus(h_->element);
  for (const bool model : {true, false}) {
    CloudInfo info = SliceInfo(kColumns);
    if (!model) info.sensor_model.reset();
    SetCaps(info);
    Push(BufferPtr(gst_buffer_new_allocate(nullptr, info.FrameSize(), nullptr)));
    EXPECT_TRUE(Pull());
  }
  EXPECT_FALSE(bus.Pop(GST_MESSAGE_WARNING));
}

TEST_F(Assembler, StringsUnorganisedPointsTogether) {
  CloudInfo info = SliceInfo();
  info.height = 1;
  info.sensor_model.reset();
  for (guint i = 0; i < kSlices; ++i) {
    info.width = 10 + i;  // the slice's number of points
    SetCaps(info);
    Push(MakeSlice({0, i, kSlices, 0}, info.FrameSize()));
  }
  const BufferPtr scan = Pull();
  EXPECT_EQ(OutInfo().width, 10U + 11 + 12 + 13);
  const auto columns = ColumnsOf(scan);
  EXPECT_EQ(std::count(columns.begin(), columns.end(), 3), 12);
  EXPECT_FALSE(IsCorrupted(scan));
}

TEST_F(Assembler, OpenScansLeaveWithTheirCapsBeforeNewOnes) {
  Push(Slice(0, 0));
  SetCaps(SliceInfo(16));
  EXPECT_EQ(ColumnsOf(Pull()), Columns({1, 0, 0, 0}));
  EXPECT_EQ(OutInfo().width, kColumns);
  for (guint i = 0; i < 2; ++i) Push(MakeSlice({1, i, 2, i * 16}, SliceInfo(16).FrameSize()));
  EXPECT_FALSE(IsCorrupted(Pull()));
}

/// The parameter changes the caps in such a way that later slices cannot belong to the same scan.
class AssemblerOfTwoLayouts : public Assembler,
                              public ::testing::WithParamInterface<void (*)(CloudInfo*)> {};
TEST_P(AssemblerOfTwoLayouts, NeverMixesThemInAScan) {
  const CloudInfo before = SliceInfo();
  CloudInfo after = before;
  GetParam()(&after);
  Push(Slice(0, 0));
  Push(Slice(0, 1));
  SetCaps(after);
  ASSERT_EQ(Waiting(), 1U) << "the scan leaves before the caps change";
  const BufferPtr old = Pull();
  EXPECT_TRUE(IsCorrupted(old));
  EXPECT_EQ(ColumnsOf(old), Columns({1, 2, 0, 0}));
  EXPECT_EQ(OutInfo().fields, before.fields);
  EXPECT_EQ(OutInfo().width, kColumns);
  const guint slices = kColumns / after.width;
  for (guint i = 2; i < slices; ++i)
    Push(MakeSlice({0, i, slices, i * after.width}, after.FrameSize()));
  for (guint i = 0; i < slices; ++i)
    Push(MakeSlice({1, i, slices, i * after.width}, after.FrameSize()));
  const BufferPtr whole = Pull();
  EXPECT_FALSE(IsCorrupted(whole));
  EXPECT_EQ(MetaOf(whole).scan_id, 1U);
  EXPECT_EQ(OutInfo().fields, after.fields);
  EXPECT_EQ(OutInfo().height, after.height);
  EXPECT_EQ(gst_buffer_get_size(whole.get()), OutInfo().FrameSize());
  EXPECT_EQ(Waiting(), 0U);
}
INSTANTIATE_TEST_SUITE_P(All, AssemblerOfTwoLayouts,
                         ::testing::Values(
                             +[](CloudInfo* cloud) {
                               cloud->fields = *PointFields::Parse(
                                   "x:F32:0,y:F32:4,z:F32:8,reflectivity:U8:12");
                             },
                             +[](CloudInfo* cloud) {
                               cloud->fields =
                                   *PointFields::Parse("z:F32:0,y:F32:4,x:F32:8,intensity:U8:12");
                             },
                             +[](CloudInfo* cloud) { cloud->point_step = 16; },
                             +[](CloudInfo* cloud) { cloud->width = 16; },
                             +[](CloudInfo* cloud) {
                               cloud->height = 3;
                               cloud->sensor_model->beams.push_back({0, -3, 0});
                             }));

/// The sensor has only one beam. With a sensor model, columns have positions in the scan. Without a
/// sensor model, points are appended.
TEST_F(Assembler, NeverMixesColumnsAndPoints) {
  CloudInfo columns = SliceInfo();
  columns.height = 1;
  columns.sensor_model->beams.resize(1);
  CloudInfo points = columns;
  points.sensor_model.reset();
  for (const guint width : {kWidth, 4 * kWidth}) {
    points.width = width;
    for (const auto& [before, after] :
         {std::pair(&columns, &points), std::pair(&points, &columns)}) {
      SetCaps(*before);
      Push(MakeSlice({0, 0, kSlices, 0}, before->FrameSize()));
      SetCaps(*after);
      ASSERT_EQ(Waiting(), 1U);
      EXPECT_TRUE(IsCorrupted(Pull()));
      for (guint i = 0; i < kSlices; ++i)
        Push(MakeSlice({1, i, kSlices, i * kWidth}, after->FrameSize()));
      EXPECT_EQ(ColumnsOf(Pull()).size(), after->width * kSlices);
      EXPECT_EQ(Waiting(), 0U);
      test::Flush(h_.get());
    }
  }
}

TEST_F(Assembler, StartsAfreshAfterAStateCycle) {
  for (int cycle = 0; cycle < 3; ++cycle) {
    Push(Slice(9, 0));
    gst_element_set_state(h_->element, GST_STATE_NULL);
    gst_harness_play(h_.get());
    SetCaps(SliceInfo());
    for (guint i = 0; i < kSlices; ++i) Push(Slice(3, i));
    EXPECT_EQ(MetaOf(Pull()).scan_id, 3U);
  }
}

TEST_F(Assembler, RefusesCapsThatAreNoCloud) {
  const CapsPtr caps(gst_caps_from_string("application/x-pointcloud2,point-step=4"));
  gst_pad_push_event(h_->srcpad, gst_event_new_caps(caps.get()));
  EXPECT_EQ(gst_harness_push(h_.get(), Slice(0, 0).release()), GST_FLOW_NOT_NEGOTIATED);
}

class LiveAssembler : public Assembler {
 protected:
  LiveAssembler() {
    // The harness answers latency queries like a live source whose latency is the duration of a
    // slice.
    gst_harness_set_live(h_.get(), TRUE);
    gst_harness_set_upstream_latency(h_.get(), kSweep);
    test::UseTestClock(h_.get());
  }
};

TEST_F(LiveAssembler, AScanLeavesAtItsDeadlineWithoutItsLastSlice) {
  for (guint i = 0; i < 3; ++i) Push(Slice(0, i));
  ASSERT_TRUE(gst_harness_wait_for_clock_id_waits(h_.get(), 1, test::kPatience.count()));
  // The deadline is the time of the first column, plus the duration of a scan, the latency of the
  // source, and max-wait.
  EXPECT_EQ(gst_test_clock_get_next_entry_time(GST_TEST_CLOCK(GST_ELEMENT_CLOCK(h_->element))),
            test::kClockStart + (100 + 25 + 20) * GST_MSECOND);
  EXPECT_EQ(Waiting(), 0U);
  ASSERT_TRUE(gst_harness_crank_single_clock_wait(h_.get()));
  const BufferPtr scan = Pull();
  EXPECT_EQ(ColumnsOf(scan), Columns({1, 2, 3, 0}));
  EXPECT_TRUE(IsCorrupted(scan));
  Push(Slice(0, 3));
  EXPECT_EQ(Stat("late-slices"), 1U);
}

TEST_F(LiveAssembler, AScanLeavesAtItsDeadlineAlsoBehindAFlush) {
  Push(Slice(0, 0));
  test::Flush(h_.get());
  for (guint i = 0; i < 3; ++i) Push(Slice(1, i));
  ASSERT_TRUE(test::AwaitClockWait(h_.get(), test::kClockStart + 245 * GST_MSECOND));
  ASSERT_TRUE(gst_harness_crank_single_clock_wait(h_.get()));
  EXPECT_EQ(ColumnsOf(Pull()), Columns({1, 2, 3, 0}));
}

/// Waits until the thread of the element's timer sleeps. Returns false if that takes too long.
bool AwaitSleepOfTimer(GstElement* assembler) {
  // GStreamer names a thread after its element and pad. Linux cuts the name to 15 characters.
  const std::string name = (std::string(GST_OBJECT_NAME(assembler)) + ":src").substr(0, 15);
  return test::Eventually([&] {
    for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task")) {
      std::ifstream stat(thread.path() / "stat");
      std::string text;
      std::getline(stat, text);
      if (text.find("(" + name + ") S ") != std::string::npos) return true;
    }
    return false;
  });
}

TEST_F(Assembler, AScanFromBeforeTheClockRanLeavesAtItsDeadline) {
  gst_harness_set_live(h_.get(), TRUE);
  gst_harness_set_upstream_latency(h_.get(), kSweep);
  gst_element_set_state(h_->element, GST_STATE_PAUSED);
  gst_element_set_clock(h_->element, nullptr);
  for (guint i = 0; i < 3; ++i) Push(Slice(0, i));
  ASSERT_TRUE(AwaitSleepOfTimer(h_->element));
  test::UseTestClock(h_.get());
  gst_element_set_state(h_->element, GST_STATE_PLAYING);
  ASSERT_TRUE(gst_harness_wait_for_clock_id_waits(h_.get(), 1, test::kPatience.count()));
  ASSERT_TRUE(gst_harness_crank_single_clock_wait(h_.get()));
  EXPECT_EQ(ColumnsOf(Pull()), Columns({1, 2, 3, 0}));
}

TEST_F(LiveAssembler, AScanOfASenderThatStartedAgainHasItsOwnDeadline) {
  Push(Slice(40, 0));
  ASSERT_TRUE(gst_harness_wait_for_clock_id_waits(h_.get(), 1, test::kPatience.count()));
  Push(Slice(0, 0));
  EXPECT_EQ(MetaOf(Pull()).scan_id, 40U);
  EXPECT_TRUE(test::AwaitClockWait(h_.get(), test::kClockStart + (100 + 25 + 20) * GST_MSECOND));
  ASSERT_TRUE(gst_harness_crank_single_clock_wait(h_.get()));
  EXPECT_EQ(MetaOf(Pull()).scan_id, 0U);
}

TEST_F(LiveAssembler, ALateSliceStillFindsItsScanWhileTheNextBegins) {
  for (guint i = 0; i < 3; ++i) Push(Slice(0, i));
  Push(Slice(1, 0));
  EXPECT_EQ(Waiting(), 0U);
  Push(Slice(0, 3));
  EXPECT_FALSE(IsCorrupted(Pull()));
}

TEST_F(LiveAssembler, ASliceOfAScanBetweenTwoOpenOnesIsLate) {
  Push(Slice(0, 0));
  Push(Slice(2, 0));
  Push(Slice(1, 0));
  EXPECT_EQ(Stat("late-slices"), 1U);
  EXPECT_EQ(Waiting(), 0U);
  for (guint i = 1; i < kSlices; ++i) Push(Slice(2, i));
  EXPECT_EQ(MetaOf(Pull()).scan_id, 0U);
  EXPECT_EQ(MetaOf(Pull()).scan_id, 2U);
  EXPECT_EQ(Stat("scans"), 2U);
}

TEST_F(LiveAssembler, AWholeScanDoesNotWaitForTheOneBefore) {
  Push(Slice(0, 0));
  for (guint i = 0; i < kSlices; ++i) Push(Slice(1, i));
  EXPECT_TRUE(IsCorrupted(Pull()));
  EXPECT_FALSE(IsCorrupted(Pull()));
}

TEST_F(LiveAssembler, SaysItIsLateByAScanAndTheWait) {
  for (guint i = 0; i < kSlices; ++i) Push(Slice(0, i));
  EXPECT_EQ(gst_harness_query_latency(h_.get()), (25 + 100 + 20) * GST_MSECOND);
}

TEST_F(LiveAssembler, StopsWhileAScanWaits) {
  Push(Slice(0, 0));
  ASSERT_TRUE(gst_harness_wait_for_clock_id_waits(h_.get(), 1, test::kPatience.count()));
  gst_element_set_state(h_->element, GST_STATE_NULL);
  EXPECT_EQ(Waiting(), 0U);
}

TEST(AssemblerOfTheTestSource, GivesTheScansThatTheSourceWouldHaveGiven) {
  const auto scans = [](const char* pipeline) {
    const Harness h(gst_harness_new_parse(pipeline));
    gst_harness_play(h.get());
    std::vector<std::vector<guint8>> all;
    for (int i = 0; i < 2; ++i) {
      const BufferPtr scan(gst_harness_pull(h.get()));
      const BufferMap map(scan.get(), GST_MAP_READ);
      all.emplace_back(map.data(), map.data() + map.size());
    }
    return all;
  };
  EXPECT_EQ(scans("lidartestsrc model=os1-32 mode=512x10 num-buffers=16 ! scanassembler"),
            scans("lidartestsrc model=os1-32 mode=512x10 num-buffers=2 slices-per-scan=1"));
}

TEST_F(Assembler, ASliceOfAnotherSizeIsInvalid) {
  const gsize size = SliceInfo().FrameSize();
  Push(MakeSlice({0, 0}, size - 1));
  Push(MakeSlice({0, 0}, size + 1));
  EXPECT_EQ(Stat("invalid-slices"), 2U);
  Push(MakeSlice({0, 0}, size));
  EXPECT_EQ(Stat("invalid-slices"), 2U);
}

TEST_F(Assembler, AScanOfDenseSlicesIsNotDense) {
  CloudInfo info = SliceInfo();
  info.is_dense = true;
  SetCaps(info);
  for (guint i = 0; i < kSlices; ++i) Push(Slice(0, i));
  Pull();
  EXPECT_FALSE(OutInfo().is_dense);
}

TEST_F(Assembler, AnOpenScanLeavesInTheSegmentThatItBeganIn) {
  Push(Slice(0, 0));
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  gst_harness_push_event(h_.get(), gst_event_new_segment(&segment));
  EXPECT_EQ(Waiting(), 0U);  // an equal segment does not end the scan
  segment.base = GST_SECOND;
  gst_harness_push_event(h_.get(), gst_event_new_segment(&segment));
  ASSERT_EQ(Waiting(), 1U);
  EXPECT_TRUE(IsCorrupted(Pull()));
}

TEST_F(Assembler, AGapBeforeTheCapsOfTheFirstScanStays) {
  const auto gaps = [&] {
    gst_harness_push_event(h_.get(), gst_event_new_gap(0, GST_MSECOND));
    int count = 0;
    while (const EventPtr event{gst_harness_try_pull_event(h_.get())})
      count += GST_EVENT_TYPE(event.get()) == GST_EVENT_GAP ? 1 : 0;
    return count;
  };
  EXPECT_EQ(gaps(), 0);
  for (guint i = 0; i < kSlices; ++i) Push(Slice(0, i));
  EXPECT_EQ(gaps(), 1);
}

TEST_F(Assembler, AScanDoesNotContinueTheLastIfItsFirstSliceDoesNot) {
  guint scan = 0;
  for (const bool gap : {true, false, true}) {
    for (guint i = 0; i < kSlices; ++i) {
      BufferPtr slice = Slice(scan, i);
      if (gap && i == 0) GST_BUFFER_FLAG_SET(slice.get(), GST_BUFFER_FLAG_DISCONT);
      Push(std::move(slice));
    }
    ++scan;
    EXPECT_EQ(GST_BUFFER_IS_DISCONT(Pull().get()), gap);
  }
}

TEST_F(Assembler, EachRunWarnsOnceOfSlicesWithoutTheirMeta) {
  const test::ElementBus bus(h_->element);
  for (int run = 0; run < 2; ++run) {
    for (int i = 0; i < 2; ++i)
      Push(BufferPtr(gst_buffer_new_allocate(nullptr, SliceInfo().FrameSize(), nullptr)));
    EXPECT_EQ(bus.Texts(GST_MESSAGE_WARNING).size(), 1U) << run;
    gst_element_set_state(h_->element, GST_STATE_NULL);
    gst_element_set_state(h_->element, GST_STATE_PLAYING);
    gst_pad_push_event(h_->srcpad, gst_event_new_stream_start("again"));
    SetCaps(SliceInfo());
    gst_pad_push_event(h_->srcpad, test::NewSegment());
  }
}

}  // namespace
}  // namespace lidar::gst
