// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/tx/settings.h"

#include <optional>
#include <sstream>

#include "gst/common/enum_type.h"
#include "src/scream/tuning.h"

namespace lidar::gst {
namespace {

constexpr gdouble kMaxBps = 4294967295.0;
constexpr gdouble kMaxDelay = 60e9;
constexpr gint kLive = GST_PARAM_MUTABLE_PLAYING;

Ecn ToEcn(gint mode) {
  switch (mode) {
    case kEcnEct0:
      return Ecn::kEct0;
    case kEcnEct1:
      return Ecn::kEct1;
    default:
      return Ecn::kNotEct;
  }
}

/// Returns the value of a number or a boolean, or nothing for another type.
std::optional<gdouble> NumberOf(const GValue* v) {
  if (G_VALUE_HOLDS_BOOLEAN(v)) return g_value_get_boolean(v) != FALSE ? 1 : 0;
  GValue number = G_VALUE_INIT;
  g_value_init(&number, G_TYPE_DOUBLE);
  if (G_VALUE_HOLDS_STRING(v) || !g_value_transform(v, &number)) return std::nullopt;
  return g_value_get_double(&number);
}

std::string RangeOf(const scream::Tunable& t) {
  if (t.is_switch()) return "true or false";
  std::ostringstream text;
  text << "a number from " << t.min << " to " << t.max;
  return text.str();
}

}  // namespace

GType EcnModeType() {
  static const GEnumValue values[] = {{kEcnOff, "Not ECN-capable", "off"},
                                      {kEcnEct0, "Classic ECN, ECT(0)", "ect0"},
                                      {kEcnEct1, "L4S, ECT(1)", "ect1"},
                                      {0, nullptr, nullptr}};
  static const GType type = RegisterEnum("GstLidarScreamEcnMode", values);
  return type;
}

const TxPadProperties& TxPadPropertyTable() {
  using S = TxPadSettings;
  static const TxPadProperties table = {{
      {"priority", "Weight of this pad's share of the bitrate", &S::priority, 0.01, 100, kLive},
      {"min-bitrate", "Lowest target, IP included; 0 takes the element's [bit/s]", &S::min_bps, 0,
       kMaxBps, kLive},
      {"start-bitrate", "First target, IP included; 0 takes the element's [bit/s]", &S::start_bps,
       0, kMaxBps, kLive},
      {"max-bitrate", "Highest target, IP included; 0 takes the element's [bit/s]", &S::max_bps, 0,
       kMaxBps, kLive},
      {"strict-priority",
       "Goes before all pads without, and gets its maximum before they get more than they need",
       &S::strict, 0, 0, kLive},
  }};
  return table;
}

const TxProperties& TxPropertyTable() {
  using S = TxSettings;
  static const TxProperties table = {{
      {"min-bitrate", "Lowest target of a pad without its own, IP included [bit/s]", &S::min_bps, 1,
       kMaxBps, kLive},
      {"start-bitrate", "First target of a pad without its own, IP included [bit/s]", &S::start_bps,
       1, kMaxBps, kLive},
      {"max-bitrate", "Highest target of a pad without its own, IP included [bit/s]", &S::max_bps,
       1, kMaxBps, kLive},
      {"max-total-bitrate",
       "Highest target of all pads together, IP included; 0: the sum of the pads' limits [bit/s]",
       &S::max_total_bps, 0, kMaxBps},
      {"ecn-mode", "ECN codepoint of sent packets; ect1 also selects the L4S reaction",
       EnumField<S>{&S::ecn_mode, EcnModeType}},
      {"max-queue-delay",
       "Greatest age of live input, half as much more in a gap of the link; older frames are "
       "dropped whole. Other input waits [ns]",
       &S::max_queue_delay, 1e6, kMaxDelay},
      {"feedback-interval",
       "Longest time between reports of a healthy receiver; above 0 it reports at the end of "
       "frames [ns]",
       &S::feedback_interval, 0, kMaxDelay},
      {"stats-interval", "Time between element messages with the statistics; 0 for none [ns]",
       &S::stats_interval, 0, static_cast<gdouble>(G_MAXINT64), kLive},
      {"packet-overhead", "UDP and IP header of a packet on the wire [bytes]", &S::packet_overhead,
       0, 1000, kLive},
      {"send-bye", "Send an RTCP BYE on the src pad before EOS", &S::send_bye, 0, 0, kLive},
      {"sender-report-interval",
       "Time between RTCP reports to the receiver about the path as the sender measures it; at "
       "least 100 ms; 0: none [ns]",
       &S::report_interval, 0, kMaxDelay, kLive},
      {"key-unit-on-loss",
       "Request a key frame from a video encoder also after losses on the network, not only after "
       "drops of the queue",
       &S::key_unit_on_loss, 0, 0, kLive},
      {"pure-draft", "Follow the draft exactly: its constants, no optional parts, no extensions",
       &S::pure_draft},
      {"tuning",
       "Constants and switches of the controller by name, as tuning,beta-loss=0.6; an unknown one "
       "is an error at the start",
       &S::tuning},
  }};
  return table;
}

std::string ReadTuning(const GstStructure* tuning, scream::Parameters* parameters) {
  const int n = tuning != nullptr ? gst_structure_n_fields(tuning) : 0;
  for (int i = 0; i < n; ++i) {
    const std::string name = gst_structure_nth_field_name(tuning, static_cast<guint>(i));
    const scream::Tunable* tunable = scream::FindTunable(name);
    if (tunable == nullptr) return "\"" + name + "\" is not one of " + scream::TunableNames();
    const auto value = NumberOf(gst_structure_get_value(tuning, name.c_str()));
    if (!value || !tunable->Set(*value, parameters))
      return "\"" + name + "\" must be " + RangeOf(*tunable);
  }
  return {};
}

scream::Parameters ToParameters(const TxSettings& s) {
  scream::Parameters p;
  ReadTuning(s.tuning.get(), &p);
  if (s.pure_draft) p = scream::Parameters::Draft();
  p.ecn = ToEcn(s.ecn_mode);
  p.max_queue_delay = s.max_queue_delay;
  p.feedback_interval = s.feedback_interval;
  if (s.max_total_bps > 0) p.max_total_bitrate = DataRate::BitsPerSecond(s.max_total_bps);
  return p;
}

}  // namespace lidar::gst
