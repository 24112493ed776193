// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests that an element that was stopped or flushed behaves like a new one.
#include <gtest/gtest.h>

#include <functional>

#include "src/base/byte_writer.h"
#include "tests/support/run_trace.h"

namespace lidar::test {
namespace {

constexpr const char* kPoints =
    "application/x-pointcloud2,width=2,height=1,point-step=12,"
    "fields=(string)\"x:F32:0,y:F32:4,z:F32:8\",framerate=10/1,is-bigendian=false";
constexpr const char* kColumns =
    "application/x-pointcloud2,width=8,height=2,point-step=12,"
    "fields=(string)\"x:F32:0,y:F32:4,z:F32:8\",framerate=10/1,is-bigendian=false";

/// Returns a cloud of two points on the x axis.
gst::BufferPtr Points(float one, float two) {
  std::vector<std::uint8_t> bytes;
  ByteWriter w(&bytes);
  for (const float v : {one, 0.0F, 0.0F, two, 0.0F, 0.0F}) w.LeF32(v);
  return gst::BufferPtr(gst_buffer_new_memdup(bytes.data(), bytes.size()));
}

gst::BufferPtr Bytes(gsize size, guint8 value) {
  gst::BufferPtr buffer(gst_buffer_new_allocate(nullptr, size, nullptr));
  gst_buffer_memset(buffer.get(), 0, value, size);
  return buffer;
}

gst::BufferPtr At(gst::BufferPtr buffer, GstClockTime ms, guint scan, guint slice, guint slices) {
  GST_BUFFER_PTS(buffer.get()) = ms * GST_MSECOND;
  GST_BUFFER_DURATION(buffer.get()) = 100 * GST_MSECOND / slices;
  const GstLidarSlice meta{scan, slice, slices, 8 * slice};
  gst_lidar_buffer_set_slice(buffer.get(), &meta);
  gst_lidar_buffer_set_capture_time(buffer.get(), GST_SECOND + ms * GST_MSECOND);
  return buffer;
}

void Push(GstHarness* h, gst::BufferPtr buffer) { gst_pad_push(h->srcpad, buffer.release()); }

/// A case of the tests below. `run` leaves much state behind: incomplete clouds, warnings, and
/// counts.
struct Case {
  const char* name;
  const char* element;
  const char* caps;
  std::function<void(GstHarness*)> run;
};

void FilterClouds(GstHarness* h) {
  g_object_set(h->element, "max-range", 5.0, nullptr);
  Push(h, At(Points(1, 9), 0, 0, 0, 1));  // this cloud has no pose
  for (const double range : {5.0, 3.0}) {
    g_object_set(h->element, "max-range", range, nullptr);
    auto cloud = At(Points(2, 4), 100, 1, 0, 1);
    const GstLidarPose pose{{1, 0, 0}, {0, 0, 0, 1}, GST_LIDAR_TRACKING_OK, {}};
    gst_lidar_buffer_set_pose(cloud.get(), &pose);
    Push(h, std::move(cloud));
  }
}

void FilterToAFrame(GstHarness* h) {
  for (guint i = 0; i < 2; ++i) Push(h, At(Points(1, 2), 100 * i, i, 0, 1));
}

void ParseClouds(GstHarness* h) {
  Push(h, Bytes(24, 1));
  Push(h, Bytes(0, 0));  // causes a warning, and a gap before the next cloud
  Push(h, Bytes(24, 2));
  Push(h, Bytes(0, 0));
}

void ParseHalves(GstHarness* h) {
  for (guint8 i = 1; i < 4; ++i) Push(h, Bytes(16, i));
  Push(h, Bytes(20, 9));  // the last cloud is cut off
}

void ParseFiles(GstHarness* h) {
  const std::string file =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n1 2 3\n";
  for (int i = 0; i < 2; ++i)
    Push(h, gst::BufferPtr(gst_buffer_new_memdup(file.data(), file.size())));
}

void AssembleScans(GstHarness* h) {
  for (guint i = 0; i < 4; ++i) Push(h, At(Bytes(192, 1), 25 * i, 7, i, 4));
  Push(h, At(Bytes(192, 2), 25, 7, 1, 4));  // this slice is late
  Push(h, At(Bytes(99, 2), 100, 8, 0, 4));  // this slice has another size
  for (guint i : {0U, 1U, 1U}) Push(h, At(Bytes(192, 3), 100 + 25 * i, 8, i, 4));
  Push(h, At(Bytes(192, 4), 200, 9, 0, 4));  // scans 8 and 9 stay incomplete
}

void WriteFiles(GstHarness* h) {
  for (guint i = 0; i < 2; ++i) Push(h, At(Points(1, 2), 50 * i, 3, i, 2));  // causes a warning
}

class SecondRun : public ::testing::TestWithParam<Case> {
 protected:
  SecondRun() {
    const gst::ElementPtr element(gst_parse_launch(GetParam().element, nullptr));
    h_.reset(gst_harness_new_with_element(element.get(), "sink", "src"));
    trace_.emplace(h_.get());
  }
  ~SecondRun() override { trace_.reset(); }
  void Run() { GetParam().run(h_.get()); }

  Harness h_;
  std::optional<RunTrace> trace_;
};

TEST_P(SecondRun, IsAsTheFirst) {
  trace_->Begin(GetParam().caps);
  Run();
  const Lines first = trace_->Take();
  EXPECT_GE(first.size(), 3U);
  trace_->Stop();
  trace_->Take();
  trace_->Begin(GetParam().caps);
  Run();
  EXPECT_EQ(trace_->Take(), first);
}

TEST_P(SecondRun, GivesTheSameCloudsBehindAFlush) {
  trace_->Begin(GetParam().caps);
  Run();
  Lines first = trace_->TakeBuffers();
  trace_->Flush();
  trace_->Take();
  Run();
  Lines behind = trace_->TakeBuffers();
  // The first buffer after a flush may have the flag DISCONT, so its flags are not compared.
  for (Lines* lines : {&first, &behind}) {
    if (lines->empty()) continue;
    std::string& line = lines->front();
    line.erase(line.find(" flags"), line.find(" size") - line.find(" flags"));
  }
  EXPECT_EQ(behind, first);
}

INSTANTIATE_TEST_SUITE_P(
    Of, SecondRun,
    ::testing::Values(Case{"FilterByPose", "pointcloudfilter invalid=remove apply-pose=true",
                           kPoints, FilterClouds},
                      Case{"FilterToAFrame", "pointcloudfilter target-frame=map tf-timeout=0",
                           kPoints, FilterToAFrame},
                      Case{"ParseClouds", "pointcloudparse",
                           "application/x-pointcloud2,height=1,point-step=12,"
                           "fields=(string)\"x:F32:0,y:F32:4,z:F32:8\",framerate=10/1",
                           ParseClouds},
                      Case{"ParseHalves", "pointcloudparse", kPoints, ParseHalves},
                      Case{"ParseFiles", "pointcloudparse", "application/x-ply", ParseFiles},
                      Case{"Assembler", "scanassembler", kColumns, AssembleScans},
                      Case{"PcdFiles", "pcdenc", kPoints, WriteFiles},
                      Case{"PlyFiles", "plyenc", kPoints, WriteFiles}),
    [](const auto& which) { return which.param.name; });

/// A file with one point. If `caps` is null, the type of the file must be found in its content.
struct FileCase {
  const char* name;
  const char* caps;
  std::string file;
};

std::vector<FileCase> FileCases() {
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n1 2 3\n";
  const std::string pcd =
      "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\n"
      "HEIGHT 1\nPOINTS 1\nDATA ascii\n4 5 6\n";
  std::vector<std::uint8_t> kitti;
  ByteWriter w(&kitti);
  for (const float v : {7.0F, 8.0F, 9.0F, 0.5F}) w.LeF32(v);
  return {{"ply", nullptr, ply},
          {"pcd", nullptr, pcd},
          {"kitti", nullptr, std::string(kitti.begin(), kitti.end())},
          {"ply by caps", "application/x-ply", ply},
          {"pcd by caps", "application/x-pcd", pcd},
          {"raw", kPoints, std::string(24, '\1')}};
}

class FileAfterAnother : public ::testing::Test {
 protected:
  FileAfterAnother() : h_(gst_harness_new_with_padnames("pointcloudparse", "sink", "src")) {
    trace_.emplace(h_.get());
  }
  ~FileAfterAnother() override { trace_.reset(); }
  void PlayFile(const FileCase& which) {
    gst_harness_play(h_.get());
    gst_pad_push_event(h_->srcpad, gst_event_new_stream_start(which.name));
    if (which.caps != nullptr) trace_->PushCaps(which.caps);
    gst_pad_push_event(h_->srcpad, NewSegment(GST_FORMAT_BYTES));
    for (int i = 0; i < 2; ++i)
      Push(h_.get(), gst::BufferPtr(gst_buffer_new_memdup(which.file.data(), which.file.size())));
  }
  /// Stops the element, and also the source, which would otherwise keep its caps.
  void StopAll() {
    trace_->Stop();
    gst_pad_set_active(h_->srcpad, FALSE);
    gst_pad_set_active(h_->srcpad, TRUE);
    trace_->Take();
  }
  static bool IsBuffer(const std::string& line) { return line.rfind("buffer", 0) == 0; }
  static std::vector<int> SizesOf(const Lines& buffers) {
    std::vector<int> sizes;
    for (const std::string& line : buffers)
      sizes.push_back(std::stoi(line.substr(line.find(" size ") + 6)));
    return sizes;
  }
  static Lines BytesOf(Lines buffers) {
    for (std::string& line : buffers)
      line = line.substr(line.find(" size"), line.find(" slice") - line.find(" size"));
    return buffers;
  }

  Harness h_;
  std::optional<RunTrace> trace_;
};

TEST_F(FileAfterAnother, IsReadAsByANewElementInASecondRun) {
  for (const FileCase& first : FileCases())
    for (const FileCase& second : FileCases()) {
      SCOPED_TRACE(std::string(second.name) + " after " + first.name);
      PlayFile(first);
      StopAll();
      PlayFile(second);
      const Lines after = trace_->Take();
      StopAll();
      PlayFile(second);
      EXPECT_EQ(after, trace_->Take());
      EXPECT_EQ(std::count_if(after.begin(), after.end(), IsBuffer), 2);
      StopAll();
    }
}

TEST_F(FileAfterAnother, IsReadAsByANewElementInASecondStream) {
  for (const FileCase& first : FileCases())
    for (const FileCase& second : FileCases()) {
      // The caps of the first file would stay.
      if ((second.caps == nullptr) != (first.caps == nullptr)) continue;
      SCOPED_TRACE(std::string(second.name) + " behind " + first.name);
      PlayFile(second);
      const Lines alone = BytesOf(trace_->TakeBuffers());
      StopAll();
      PlayFile(first);
      trace_->Take();
      PlayFile(second);
      EXPECT_EQ(BytesOf(trace_->TakeBuffers()), alone);
      StopAll();
    }
}

/// A source that knows the size of its file, and outputs the file in blocks.
class FileInBlocks : public FileAfterAnother {
 protected:
  FileInBlocks() {
    gst_pad_set_element_private(h_->srcpad, this);
    gst_pad_set_query_function(h_->srcpad, [](GstPad* pad, GstObject* parent, GstQuery* query) {
      if (GST_QUERY_TYPE(query) != GST_QUERY_DURATION)
        return gst_pad_query_default(pad, parent, query);
      const auto* self = static_cast<FileInBlocks*>(gst_pad_get_element_private(pad));
      gst_query_set_duration(query, GST_FORMAT_BYTES, static_cast<gint64>(self->size_));
      return gboolean{TRUE};
    });
  }
  void PlayBlocks(const std::string& file) {
    size_ = file.size();
    gst_harness_play(h_.get());
    gst_pad_push_event(h_->srcpad, gst_event_new_stream_start("file"));
    gst_pad_push_event(h_->srcpad, NewSegment(GST_FORMAT_BYTES));
    for (std::size_t at = 0; at < file.size(); at += 500) {
      const std::string block = file.substr(at, 500);
      Push(h_.get(), gst::BufferPtr(gst_buffer_new_memdup(block.data(), block.size())));
    }
  }
  std::size_t size_ = 0;
};

TEST_F(FileInBlocks, IsReadToItsEndWhateverTheSizeOfTheOneBefore) {
  const auto ply = [](int points) {
    std::string file = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(points) +
                       "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    for (int i = 0; i < points; ++i) file += std::to_string(i) + " 2 3\n";
    return file;
  };
  for (const bool stops : {false, true})
    for (const auto& [first, second] :
         std::vector<std::pair<int, int>>{{200, 400}, {400, 200}, {300, 300}}) {
      PlayBlocks(ply(first));
      EXPECT_EQ(SizesOf(trace_->TakeBuffers()), (std::vector<int>{12 * first}));
      if (stops) StopAll();
      PlayBlocks(ply(second));
      EXPECT_EQ(SizesOf(trace_->TakeBuffers()), (std::vector<int>{12 * second}));
      StopAll();
    }
}

/// Each kind of file contains the same two points.
TEST_F(FileAfterAnother, IsTheSameCloudInEveryEncoding) {
  std::vector<std::uint8_t> little;
  std::vector<std::uint8_t> big;
  ByteWriter w(&little);
  std::string text;
  for (const float v : {1.5F, -2.25F, 3.0F, 40.0F, 1e-3F, -0.125F}) {
    const std::size_t begin = little.size();
    w.LeF32(v);
    big.insert(big.end(), little.rbegin(), little.rbegin() + 4);
    text += std::to_string(v) + (begin == 8 ? "\n" : " ");
  }
  const std::string pcd =
      "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\n"
      "HEIGHT 1\nPOINTS 2\nDATA ";
  const auto ply = [](const char* format) {
    return std::string("ply\nformat ") + format +
           " 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
           "end_header\n";
  };
  const std::string bytes(little.begin(), little.end());
  const Lines expected(2, " size 24 crc " + std::to_string(Crc32({little.data(), little.size()})));
  for (const FileCase& file : std::vector<FileCase>{
           {"pcd text", nullptr, pcd + "ascii\n" + text},
           {"pcd binary", nullptr, pcd + "binary\n" + bytes},
           {"ply text", nullptr, ply("ascii") + text},
           {"ply little", nullptr, ply("binary_little_endian") + bytes},
           {"ply big", nullptr, ply("binary_big_endian") + std::string(big.begin(), big.end())}}) {
    PlayFile(file);
    EXPECT_EQ(BytesOf(trace_->TakeBuffers()), expected) << file.name;
    StopAll();
  }
}

}  // namespace
}  // namespace lidar::test
