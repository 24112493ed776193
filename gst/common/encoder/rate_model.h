// SPDX-License-Identifier: LGPL-2.1-or-later
// The rate model that an encoder's properties ask for.
#pragma once
#include <gst/gst.h>

#include <memory>

#include "gst/common/encoder/settings.h"
#include "src/rate/size_model.h"

namespace lidar::gst {

/// Null, and an error posted by `element`, where the file cannot be read or used.
std::unique_ptr<rate::SizeModel> LoadModel(GstElement* element, const EncoderSettings& settings);

}  // namespace lidar::gst
