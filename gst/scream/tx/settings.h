// SPDX-License-Identifier: LGPL-2.1-or-later
// The properties of screamtx and its pads, and the controller's parameters that follow from them.
#pragma once
#include <gst/gst.h>

#include <string>

#include "gst/common/properties.h"
#include "src/scream/controller.h"

namespace lidar::gst {

enum EcnMode { kEcnOff, kEcnEct0, kEcnEct1 };
GType EcnModeType();

/// The settings of a sink pad. If a bitrate is 0, the element's bitrate applies.
struct TxPadSettings {
  gdouble priority = 1;
  guint min_bps = 0;
  guint start_bps = 0;
  guint max_bps = 0;
  bool strict = false;
};
using TxPadProperties = std::array<Property<TxPadSettings>, 5>;
const TxPadProperties& TxPadPropertyTable();

struct TxSettings {
  guint min_bps = 100'000;
  guint start_bps = 1'000'000;
  guint max_bps = 50'000'000;
  guint max_total_bps = 0;  // 0: no limit by the element
  gint ecn_mode = kEcnEct1;
  Duration stats_interval{};   // 0: no messages
  Duration report_interval{};  // to the receiver; 0: no reports
  DataSize packet_overhead = DataSize::Bytes(28);
  bool send_bye = false;
  bool key_unit_on_loss = false;
  bool pure_draft = false;
  Duration max_queue_delay = scream::Parameters().max_queue_delay;
  Duration feedback_interval{};
  SharedStructure tuning;
};
using TxProperties = std::array<Property<TxSettings>, 14>;
const TxProperties& TxPropertyTable();

/// Applies `tuning`, which may be NULL, to `parameters`. Returns a text that says what is wrong, or
/// an empty text.
std::string ReadTuning(const GstStructure* tuning, scream::Parameters* parameters);

/// Returns the controller's parameters. If `pure_draft` is set, `tuning` is ignored.
scream::Parameters ToParameters(const TxSettings& settings);

}  // namespace lidar::gst
