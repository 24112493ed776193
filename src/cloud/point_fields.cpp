// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cloud/point_fields.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

namespace lidar {
namespace {

struct TypeName {
  FieldType type;
  std::string_view name;
  std::size_t size;
};
constexpr std::array<TypeName, 8> kTypes = {{{FieldType::kI8, "I8", 1},
                                             {FieldType::kU8, "U8", 1},
                                             {FieldType::kI16, "I16", 2},
                                             {FieldType::kU16, "U16", 2},
                                             {FieldType::kI32, "I32", 4},
                                             {FieldType::kU32, "U32", 4},
                                             {FieldType::kF32, "F32", 4},
                                             {FieldType::kF64, "F64", 8}}};

const TypeName& Describe(FieldType type) { return kTypes[static_cast<std::size_t>(type)]; }

/// Removes the part of `text` up to the first `separator`, and returns this part without the
/// separator.
std::string_view TakeUntil(char separator, std::string_view* text) {
  const std::size_t end = text->find(separator);
  const std::string_view head = text->substr(0, end);
  text->remove_prefix(end == std::string_view::npos ? text->size() : end + 1);
  return head;
}

/// Returns true if `text` is a valid name. Names come from networks and are used in caps and logs,
/// so they must be printable ASCII.
bool IsName(std::string_view text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

std::optional<PointField> ParseField(std::string_view text, std::string* why) {
  const std::string field = "the field \"" + std::string(text) + "\"";
  const std::string_view name = TakeUntil(':', &text);
  const std::string_view type = TakeUntil(':', &text);
  const auto known =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& t) { return t.name == type; });
  std::uint32_t offset = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), offset);
  if (!IsName(name)) {
    *why = field + " has no name, or one that is not ASCII";
  } else if (known == kTypes.end()) {
    *why = field + " is not of type I8, U8, I16, U16, I32, U32, F32 or F64";
  } else if (parsed.ec != std::errc() || parsed.ptr != text.data() + text.size()) {
    *why = field + " has no offset in bytes, as in x:F32:0";
  } else if (offset > PointFields::kMaxPointStep - known->size) {
    *why = field + " ends past the " + std::to_string(PointFields::kMaxPointStep) +
           " bytes that a point may have";
  } else {
    return PointField{std::string(name), known->type, offset};
  }
  return std::nullopt;
}

}  // namespace

std::size_t SizeOf(FieldType type) { return Describe(type).size; }

bool operator==(const PointField& a, const PointField& b) {
  return a.name == b.name && a.type == b.type && a.offset == b.offset;
}

PointFields& PointFields::Add(std::string name, FieldType type) {
  fields_.push_back({std::move(name), type, MinimumStep()});
  return *this;
}

std::optional<PointFields> PointFields::Parse(std::string_view text, std::string* why) {
  std::string ignored;
  std::string& reason = why != nullptr ? *why : ignored;
  reason = "there are no fields";
  PointFields fields;
  while (!text.empty()) {
    auto field = ParseField(TakeUntil(',', &text), &reason);
    if (!field) return std::nullopt;
    if (fields.Find(field->name) != nullptr) {
      reason = "there are two fields " + field->name;
      return std::nullopt;
    }
    if (fields.fields_.size() == kMaxFields) {
      reason = "there are more than " + std::to_string(kMaxFields) + " fields";
      return std::nullopt;
    }
    fields.fields_.push_back(*std::move(field));
  }
  if (fields.empty()) return std::nullopt;
  return fields;
}

std::string PointFields::ToString() const {
  std::string text;
  for (const PointField& f : fields_) {
    if (!text.empty()) text += ',';
    text.append(f.name).append(":").append(Describe(f.type).name).append(":");
    text += std::to_string(f.offset);
  }
  return text;
}

const PointField* PointFields::Find(std::string_view name) const {
  const auto found = std::find_if(fields_.begin(), fields_.end(),
                                  [&](const PointField& f) { return f.name == name; });
  return found == fields_.end() ? nullptr : &*found;
}

bool PointFields::Has(std::string_view name, FieldType type) const {
  const PointField* f = Find(name);
  return f != nullptr && f->type == type;
}

bool PointFields::HasPackedXyz() const {
  return Has("x", FieldType::kF32) && Has("y", FieldType::kF32) && Has("z", FieldType::kF32) &&
         Find("y")->offset == Find("x")->offset + 4 && Find("z")->offset == Find("x")->offset + 8;
}

bool PointFields::ArePacked() const {
  std::vector<PointField> ordered = fields_;
  std::sort(ordered.begin(), ordered.end(),
            [](const PointField& a, const PointField& b) { return a.offset < b.offset; });
  std::size_t end = 0;
  for (const PointField& f : ordered) {
    if (f.offset != end) return false;
    end += SizeOf(f.type);
  }
  return true;
}

std::uint32_t PointFields::MinimumStep() const {
  std::uint32_t end = 0;
  for (const PointField& f : fields_)
    end = std::max(end, f.offset + static_cast<std::uint32_t>(SizeOf(f.type)));
  return end;
}

}  // namespace lidar
