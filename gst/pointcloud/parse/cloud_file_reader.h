// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads files of points as our clouds.
#pragma once
#include <gst/gst.h>

#include <optional>
#include <string>

#include "gst/common/refs.h"
#include "gst/lidar/cloud_info.h"
#include "src/cloud/cloud_files.h"

namespace lidar::gst {

/// The file type of caps; nothing for caps of raw clouds.
std::optional<CloudFileType> CloudFileTypeOf(const GstCaps* caps);
const char* NameOf(CloudFileType type);

struct FileBuffer {
  CloudInfo info;  // of the cloud; width 0: it is empty
  BufferPtr buffer;
};
/// Returns nothing if `file` cannot be read; `why` then has the reason in words for a user. The
/// cloud has x, y and z as adjacent F32, and little-endian numbers.
std::optional<FileBuffer> ReadCloudFile(CloudFileType type, ByteView file, std::string* why);

/// Registers the types that have a header with typefind.
gboolean RegisterCloudFileTypes(GstPlugin* plugin);

}  // namespace lidar::gst
