// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads ROS 2 messages in CDR, which come from DDS peers or from recordings.
#include <cmath>
#include <optional>
#include <vector>

#include "src/cdr/coded_slice.h"
#include "src/cdr/messages.h"
#include "src/cdr/point_cloud2.h"
#include "src/cloud/transform_tree.h"
#include "tests/fuzz/fuzz.h"

namespace {

using lidar::ByteView;
using Bytes = std::vector<std::uint8_t>;

/// Checks that a message that was read can be written, and that reading the result gives the same
/// message.
template <class Message>
void CheckComesBack(ByteView data, std::optional<Message> (*read)(ByteView),
                    Bytes (*write)(const Message&)) {
  const auto message = read(data);
  if (!message) return;
  const Bytes said = write(*message);
  const auto again = read({said.data(), said.size()});
  FUZZ_CHECK(again && write(*again) == said);
}

void CheckCloud(ByteView data) {
  // The limit of the points of a cloud [bytes]. It is small, because a fuzzer has little memory.
  constexpr std::size_t kEnough = 16U << 20;
  std::string why;
  const auto cloud = lidar::cdr::ReadPointCloud2(data, &why);
  FUZZ_CHECK(cloud || !why.empty());
  if (!cloud) return;
  FUZZ_CHECK(cloud->data.size <= data.size);
  const Bytes said = lidar::cdr::WritePointCloud2(*cloud);
  const auto again = lidar::cdr::ReadPointCloud2({said.data(), said.size()});
  FUZZ_CHECK(again && again->layout == cloud->layout && again->data.size == cloud->data.size);
  const auto converter = lidar::cdr::PointConverter::Make(cloud->layout, {}, &why);
  if (!converter || converter->size() > kEnough) return;
  for (const auto& field : converter->points().fields.all())
    FUZZ_CHECK(field.offset + lidar::SizeOf(field.type) <= converter->points().point_step);
  Bytes points(converter->size());
  FUZZ_CHECK(converter->Convert(*cloud, points.data()) ==
             lidar::cdr::RowStride(*cloud).has_value());
}

/// Checks the transforms that a sender may publish. For two frames the tree returns a transform of
/// finite numbers, or a reason why there is no transform.
void CheckTree(ByteView data) {
  const auto transforms = lidar::cdr::ReadTransforms(data);
  if (!transforms) return;
  lidar::TransformTree tree;
  for (const auto& t : *transforms)
    tree.Set(t.header.frame_id, t.child_frame_id, t.header.stamp, {t.translation, t.rotation},
             t.header.stamp.time_since_epoch().count() % 2 == 0);
  for (const auto& t : *transforms) {
    const auto answer =
        tree.Find(transforms->front().header.frame_id, t.child_frame_id, t.header.stamp);
    FUZZ_CHECK(answer.transform || !answer.why.empty());
    if (!answer.transform) continue;
    for (const double v : *answer.transform) FUZZ_CHECK(std::isfinite(v));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace lidar::cdr;
  const ByteView data{bytes, size};
  CheckCloud(data);
  CheckComesBack<Imu>(data, ReadImu, WriteImu);
  CheckComesBack<Odometry>(data, ReadOdometry, WriteOdometry);
  CheckComesBack<Transforms>(data, ReadTransforms, WriteTransforms);
  CheckTree(data);
  if (const auto made = ReadLivox(data))
    FUZZ_CHECK(made->points.size() == std::size_t{26} * made->cloud.layout.width);
  CheckComesBack<CodedSlice>(data, ReadCodedSlice, WriteCodedSlice);
  return 0;
}
