// SPDX-License-Identifier: LGPL-2.1-or-later
// exampleenc and exampledec: the smallest coder of docs/writing-an-encoder.md.
#pragma once
#include <gst/gst.h>

/// Registers both, as plugin_init() of a plugin would.
gboolean example_coder_register(GstPlugin* plugin);
