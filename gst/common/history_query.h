// SPDX-License-Identifier: LGPL-2.1-or-later
// The query "lidar-history". A source answers it if its server stores the stream.
#pragma once
#include <gst/gst.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "gst/common/refs.h"

namespace lidar::gst {

struct UnrefSample {
  void operator()(GstSample* sample) const { gst_sample_unref(sample); }
};
using SamplePtr = std::unique_ptr<GstSample, UnrefSample>;

struct HistoryQuestion {
  GstClockTime time = GST_CLOCK_TIME_NONE;  // earlier buffers may be omitted [ns since 1970]
  guint64 position = 0;                     // where the answer begins; ignored if `time` is set
  guint64 most_bytes = 0;                   // approximate limit of the size; 0: only times
};

struct HistoryAnswer {
  guint64 from = 0;  // capture time of the oldest stored buffer [ns since 1970]; 0: none
  guint64 to = 0;
  std::vector<SamplePtr> samples;  // caps, and buffers with metas; the offset is the position
  guint64 position = 0;            // `position` for the next question
  bool ended = true;               // true if no newer buffer is stored yet
  guint64 damaged = 0;             // number of buffers that were omitted
  bool unanswered = false;         // the server did not answer, so the other values are wrong
};

constexpr const char* kHistoryQuery = "lidar-history";

inline QueryPtr NewHistoryQuery(const HistoryQuestion& question) {
  return QueryPtr(gst_query_new_custom(
      GST_QUERY_CUSTOM,
      gst_structure_new(kHistoryQuery, "time", G_TYPE_UINT64, question.time, "position",
                        G_TYPE_UINT64, question.position, "most-bytes", G_TYPE_UINT64,
                        question.most_bytes, nullptr)));
}

/// Returns nothing if `query` is not a history query.
inline std::optional<HistoryQuestion> ParseHistoryQuestion(GstQuery* query) {
  const GstStructure* s = gst_query_get_structure(query);
  if (GST_QUERY_TYPE(query) != GST_QUERY_CUSTOM || s == nullptr ||
      !gst_structure_has_name(s, kHistoryQuery))
    return std::nullopt;
  HistoryQuestion question;
  gst_structure_get(s, "time", G_TYPE_UINT64, &question.time, "position", G_TYPE_UINT64,
                    &question.position, "most-bytes", G_TYPE_UINT64, &question.most_bytes, nullptr);
  return question;
}

inline void SetHistoryAnswer(GstQuery* query, const HistoryAnswer& answer) {
  GstStructure* s = gst_query_writable_structure(query);
  gst_structure_set(s, "from", G_TYPE_UINT64, answer.from, "to", G_TYPE_UINT64, answer.to,
                    "position", G_TYPE_UINT64, answer.position, "ended", G_TYPE_BOOLEAN,
                    gboolean{answer.ended}, "damaged", G_TYPE_UINT64, answer.damaged, "unanswered",
                    G_TYPE_BOOLEAN, gboolean{answer.unanswered}, nullptr);
  GValue samples = G_VALUE_INIT;
  gst_value_list_init(&samples, static_cast<guint>(answer.samples.size()));
  for (const SamplePtr& sample : answer.samples) {
    GValue value = G_VALUE_INIT;
    g_value_init(&value, GST_TYPE_SAMPLE);
    gst_value_set_sample(&value, sample.get());
    gst_value_list_append_and_take_value(&samples, &value);
  }
  gst_structure_take_value(s, "samples", &samples);
}

inline HistoryAnswer ParseHistoryAnswer(GstQuery* query) {
  const GstStructure* s = gst_query_get_structure(query);
  HistoryAnswer answer;
  gboolean ended = TRUE;
  gboolean unanswered = FALSE;
  gst_structure_get(s, "from", G_TYPE_UINT64, &answer.from, "to", G_TYPE_UINT64, &answer.to,
                    "position", G_TYPE_UINT64, &answer.position, "ended", G_TYPE_BOOLEAN, &ended,
                    "damaged", G_TYPE_UINT64, &answer.damaged, "unanswered", G_TYPE_BOOLEAN,
                    &unanswered, nullptr);
  answer.ended = ended != FALSE;
  answer.unanswered = unanswered != FALSE;
  const GValue* samples = gst_structure_get_value(s, "samples");
  const guint count = samples != nullptr ? gst_value_list_get_size(samples) : 0;
  for (guint i = 0; i < count; ++i)
    answer.samples.emplace_back(
        gst_sample_ref(gst_value_get_sample(gst_value_list_get_value(samples, i))));
  return answer;
}

}  // namespace lidar::gst
