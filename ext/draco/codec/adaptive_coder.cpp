// SPDX-License-Identifier: LGPL-2.1-or-later
#include "draco/codec/adaptive_coder.h"

#include "draco/codec/initial_models.h"

namespace lidar::codec {
namespace {

std::int32_t Mirror(std::int32_t residual, const Prediction& p) {
  return p.mirrored ? -residual : residual;
}

}  // namespace

void AdaptiveCoder::ResetModels() {
  value_model_.Reset(InitialModelsOfValues());
  level_model_.Reset(InitialModelsOfLevels());
}

/// Calls code_value(prediction), which gives the value, for every return in order, and code_level
/// likewise. False where a value leaves its limits.
template <bool kLevels, class CodeValue, class CodeLevel>
bool AdaptiveCoder::ForEachReturn(const BlockShape& shape, CodeValue&& code_value,
                                  CodeLevel&& code_level) {
  values_.Reset(shape.alignment, shape.columns);
  if (kLevels) levels_.Reset(shape.alignment, shape.columns);
  const std::uint8_t* mask = shape.mask.data();
  for (std::uint32_t beam = 0; beam < shape.alignment.beams(); ++beam) {
    values_.StartBeam(beam);
    if (kLevels) levels_.StartBeam(beam);
    for (std::uint32_t column = 0; column < shape.columns; ++column) {
      if (mask[column] == 0) continue;
      const Prediction p = values_.Predict(column);
      const std::int32_t value = code_value(p);
      if (static_cast<std::uint32_t>(value) >= kMaxBins) return false;
      values_.Set(column, value, p.value);
      if (kLevels) {
        const Prediction q = levels_.Predict(column);
        const std::int32_t level = code_level(q);
        if (static_cast<std::uint32_t>(level) > 255) return false;
        levels_.Set(column, level, q.value);
      }
    }
    values_.EndBeam(beam);
    if (kLevels) levels_.EndBeam(beam);
    mask += shape.columns;
  }
  return true;
}

void AdaptiveCoder::Encode(const BlockShape& shape, const IntegerLists& lists,
                           RansEncoder* encoder) {
  ResetModels();
  const std::int32_t* value = lists.values.data();
  const std::uint8_t* level = lists.levels.data();
  const auto code_value = [&](const Prediction& p) {
    value_model_.Encode(Mirror(*value - p.value, p), p.context, encoder);
    return *value++;
  };
  const auto code_level = [&](const Prediction& p) {
    const std::int32_t l = *level++;
    level_model_.Encode(Mirror(l - p.value, p), p.context, encoder);
    return l;
  };
  if (lists.levels.empty()) {
    ForEachReturn<false>(shape, code_value, code_level);
  } else {
    ForEachReturn<true>(shape, code_value, code_level);
  }
}

bool AdaptiveCoder::Decode(const BlockShape& shape, bool has_levels, RansDecoder* decoder,
                           IntegerLists* lists) {
  ResetModels();
  std::int32_t* value = lists->values.data();
  std::uint8_t* level = lists->levels.data();
  const auto code_value = [&](const Prediction& p) {
    *value = p.value + Mirror(value_model_.Decode(p.context, decoder), p);
    return *value++;
  };
  const auto code_level = [&](const Prediction& p) {
    const std::int32_t l = p.value + Mirror(level_model_.Decode(p.context, decoder), p);
    *level++ = static_cast<std::uint8_t>(l);
    return l;
  };
  if (!has_levels) return ForEachReturn<false>(shape, code_value, code_level);
  return ForEachReturn<true>(shape, code_value, code_level);
}

void AdaptiveCoder::ToResiduals(const BlockShape& shape, IntegerLists* lists) {
  std::int32_t* value = lists->values.data();
  ForEachReturn<false>(
      shape,
      [&](const Prediction& p) {
        const std::int32_t v = *value;
        *value++ = Mirror(v - p.value, p);
        return v;
      },
      [](const Prediction&) { return 0; });
}

bool AdaptiveCoder::FromResiduals(const BlockShape& shape, IntegerLists* lists) {
  std::int32_t* value = lists->values.data();
  return ForEachReturn<false>(
      shape,
      [&](const Prediction& p) {
        // Damaged residuals may be anything: unsigned, so that they wrap.
        const auto residual = static_cast<std::uint32_t>(*value);
        const auto predicted = static_cast<std::uint32_t>(p.value);
        *value =
            static_cast<std::int32_t>(p.mirrored ? predicted - residual : predicted + residual);
        return *value++;
      },
      [](const Prediction&) { return 0; });
}

}  // namespace lidar::codec
