// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads files of points as clouds of this plugin set.
#pragma once
#include <gst/gst.h>

#include <optional>
#include <string>

#include "gst/common/refs.h"
#include "gst/lidar/cloud_info.h"
#include "src/cloud/cloud_files.h"

namespace lidar::gst {

/// Returns the file type that the caps name, or nothing for caps of raw clouds.
std::optional<CloudFileType> CloudFileTypeOf(const GstCaps* caps);
const char* NameOf(CloudFileType type);

struct FileBuffer {
  CloudInfo info;  // describes the cloud; its width is 0 if the cloud is empty
  BufferPtr buffer;
};
/// Reads a file. The cloud has little-endian numbers, and x, y and z as F32 side by side. If the
/// file cannot be read, returns nothing and sets `why` to a reason for the user.
std::optional<FileBuffer> ReadCloudFile(CloudFileType type, ByteView file, std::string* why);

/// Registers typefind functions for all file types that have a header.
gboolean RegisterCloudFileTypes(GstPlugin* plugin);

}  // namespace lidar::gst
