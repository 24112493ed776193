// SPDX-License-Identifier: LGPL-2.1-or-later
// Maps buffers with automatic unmapping, and copies their flags, times and metas.
#pragma once
#include <gst/gst.h>

#include "src/base/byte_reader.h"

namespace lidar::gst {

/// Maps a buffer for the lifetime of this object. It does not own the buffer. Check operator bool()
/// before use, because mapping may fail.
class BufferMap {
 public:
  BufferMap(GstBuffer* buffer, GstMapFlags flags)
      : buffer_(gst_buffer_map(buffer, &info_, flags) ? buffer : nullptr) {}
  ~BufferMap() {
    if (buffer_ != nullptr) gst_buffer_unmap(buffer_, &info_);
  }
  BufferMap(const BufferMap&) = delete;
  BufferMap& operator=(const BufferMap&) = delete;

  explicit operator bool() const { return buffer_ != nullptr; }
  guint8* data() { return info_.data; }
  const guint8* data() const { return info_.data; }
  gsize size() const { return info_.size; }
  ByteView view() const { return {info_.data, info_.size}; }

 private:
  GstMapInfo info_{};
  GstBuffer* buffer_;
};

/// Copies flags, times and metas from `input` to `output`.
inline void CopyMetadata(GstBuffer* output, GstBuffer* input) {
  constexpr auto kAll = static_cast<GstBufferCopyFlags>(
      GST_BUFFER_COPY_FLAGS | GST_BUFFER_COPY_TIMESTAMPS | GST_BUFFER_COPY_META);
  gst_buffer_copy_into(output, input, kAll, 0, static_cast<gsize>(-1));
}

}  // namespace lidar::gst
