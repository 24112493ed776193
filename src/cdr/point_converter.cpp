// SPDX-License-Identifier: LGPL-2.1-or-later
#include <algorithm>
#include <cstring>

#include "src/cdr/point_cloud2.h"
#include "src/cloud/field_number.h"

namespace lidar::cdr {
namespace {

const PointField* FindField(const std::vector<PointField>& fields, const std::string& name) {
  const auto found = std::find_if(fields.begin(), fields.end(),
                                  [&](const PointField& f) { return f.name == name; });
  return found == fields.end() ? nullptr : &*found;
}

/// Returns true if the field can be used. Its name becomes part of caps, so it must not contain a
/// comma or a colon.
bool IsUsable(const RosField& f) {
  const auto bad = [](char c) { return c < ' ' || c > '~' || c == ',' || c == ':'; };
  return f.datatype >= 1 && f.datatype <= 8 && f.count <= PointFields::kMaxFields &&
         !f.name.empty() && std::none_of(f.name.begin(), f.name.end(), bad);
}

/// Appends the fields that are kept. An array becomes one field for each element. Returns false if
/// a field extends past the end of the point, or if there are no fields or too many.
bool Expand(const RosLayout& layout, std::vector<PointField>* out, std::string* why) {
  for (const RosField& f : layout.fields) {
    if (!IsUsable(f)) continue;
    const auto type = static_cast<FieldType>(f.datatype - 1);
    const std::uint32_t count = std::max(f.count, 1u);  // some drivers set it to 0
    if (f.offset + std::uint64_t{count} * SizeOf(type) > layout.point_step) {
      *why = "the field " + f.name + " ends past point_step " + std::to_string(layout.point_step);
      return false;
    }
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto offset = f.offset + i * static_cast<std::uint32_t>(SizeOf(type));
      std::string name = count == 1 ? f.name : f.name + "[" + std::to_string(i) + "]";
      if (FindField(*out, name) == nullptr) out->push_back({std::move(name), type, offset});
    }
    if (out->size() > PointFields::kMaxFields) {
      *why = "there are more than " + std::to_string(PointFields::kMaxFields) + " fields";
      return false;
    }
  }
  if (out->empty()) *why = "there are no fields";
  return !out->empty();
}

constexpr const char* kAxes[] = {"x", "y", "z"};

bool HaveAxes(const std::vector<PointField>& fields) {
  return std::all_of(std::begin(kAxes), std::end(kAxes),
                     [&](const char* axis) { return FindField(fields, axis) != nullptr; });
}

/// Returns a layout with the same fields at the same offsets. Returns nothing if our elements
/// cannot use that layout.
std::optional<PointLayout> Same(const std::vector<PointField>& source, std::uint32_t step) {
  if (step > PointFields::kMaxPointStep) return std::nullopt;
  std::string text;
  PointLayout layout;
  layout.point_step = step;
  for (const PointField& f : source) {
    PointFields one;
    one.Add(f.name, f.type);
    const std::string name_and_type = one.ToString();  // name:type:0
    if (!text.empty()) text += ',';
    text += name_and_type.substr(0, name_and_type.size() - 1) + std::to_string(f.offset);
  }
  auto fields = PointFields::Parse(text);
  if (!fields || (HaveAxes(source) && !fields->HasPackedXyz())) return std::nullopt;
  layout.fields = *std::move(fields);
  return layout;
}

/// Returns a layout without gaps. It begins with x, y and z as F32, and the other fields follow.
PointLayout Packed(const std::vector<PointField>& source) {
  PointLayout layout;
  if (HaveAxes(source))
    for (const char* axis : kAxes) layout.fields.Add(axis, FieldType::kF32);
  for (const PointField& f : source)
    if (!layout.fields.Find(f.name)) layout.fields.Add(f.name, f.type);
  layout.point_step = layout.fields.MinimumStep();
  return layout;
}

}  // namespace

std::optional<PointConverter> PointConverter::Make(const RosLayout& layout,
                                                   const std::optional<PointLayout>& wanted,
                                                   std::string* why) {
  std::string ignored;
  std::string& reason = why != nullptr ? *why : ignored;
  std::vector<PointField> source;
  if (!Expand(layout, &source, &reason)) return std::nullopt;
  PointConverter converter;
  converter.from_ = layout;
  if (wanted) {
    converter.to_ = *wanted;
  } else if (auto same = Same(source, layout.point_step)) {
    converter.to_ = *std::move(same);
  } else {
    converter.to_ = Packed(source);
  }
  if (!converter.Plan(source, &reason)) return std::nullopt;
  const std::uint64_t step = std::max(layout.point_step, converter.to_.point_step);
  const std::uint64_t points = std::uint64_t{layout.width} * layout.height;
  if (points <= kMaxSize / step) return converter;
  reason = "width x height x point_step is above 1 GiB";
  return std::nullopt;
}

bool PointConverter::Plan(const std::vector<PointField>& source, std::string* why) {
  bool copies = !from_.is_bigendian && to_.point_step == from_.point_step;
  for (const PointField& to : to_.fields.all()) {
    const PointField* from = FindField(source, to.name);
    if (from == nullptr) {
      *why = "there is no field " + to.name;
      return false;
    }
    const auto size = static_cast<std::uint32_t>(SizeOf(from->type));
    const bool converts = from->type != to.type || (from_.is_bigendian && size > 1);
    copies = copies && !converts && from->offset == to.offset;
    Step* last = steps_.empty() ? nullptr : &steps_.back();
    if (last != nullptr && !converts && !last->converts &&
        from->offset == last->from + last->size && to.offset == last->to + last->size) {
      last->size += size;
    } else {
      steps_.push_back({from->offset, to.offset, size, from->type, to.type, converts});
    }
  }
  if (copies) steps_.clear();
  return true;
}

void PointConverter::ConvertPoint(const std::uint8_t* from, std::uint8_t* to) const {
  for (const Step& s : steps_) {
    if (s.converts)
      WriteNumber(ReadNumber(from + s.from, s.from_type, from_.is_bigendian), s.to_type, to + s.to);
    else
      std::memcpy(to + s.to, from + s.from, s.size);
  }
}

bool PointConverter::Convert(const PointCloud2& cloud, std::uint8_t* out) const {
  const auto stride = RowStride(cloud);
  if (!stride) return false;
  // Returns early if there are no points, because there may still be four billion empty rows.
  if (size() == 0) return true;
  const std::size_t row = std::size_t{from_.width} * from_.point_step;
  if (!copies()) std::fill_n(out, size(), std::uint8_t{0});
  for (std::uint32_t y = 0; y < from_.height; ++y) {
    const std::uint8_t* from = cloud.data.data + y * *stride;
    if (copies()) {
      std::copy_n(from, row, out);
      out += row;
      continue;
    }
    for (std::uint32_t x = 0; x < from_.width; ++x) {
      ConvertPoint(from, out);
      from += from_.point_step;
      out += to_.point_step;
    }
  }
  return true;
}

}  // namespace lidar::cdr
