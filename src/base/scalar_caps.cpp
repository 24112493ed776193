// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/base/scalar_caps.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace lidar {
namespace {

using Value = ScalarCaps::Value;
using Fraction = ScalarCaps::Fraction;
using Bytes = ScalarCaps::Bytes;
using Doubles = ScalarCaps::Doubles;

constexpr std::string_view kPrefix = "application/x-";
// The names of the types, in the order of the types in Value.
constexpr std::array<std::string_view, std::variant_size_v<Value>> kTypeNames = {
    "string", "boolean", "int",      "uint",   "gint64", "guint64",
    "float",  "double",  "fraction", "buffer", "double"};
constexpr std::size_t kDoubles = kTypeNames.size() - 1;  // index of Doubles in Value

bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool IsDigit(char c) { return c >= '0' && c <= '9'; }
/// Returns true if `c` needs no quotes in a string.
bool IsBare(char c) {
  return IsLetter(c) || IsDigit(c) || std::string_view("_-+/:.").find(c) != std::string_view::npos;
}

bool IsName(std::string_view text) {
  const auto fits = [](char c) {
    return IsLetter(c) || IsDigit(c) || c == '-' || c == '_' || c == '.';
  };
  return !text.empty() && text.size() <= ScalarCaps::kMaxName && IsLetter(text.front()) &&
         std::all_of(text.begin(), text.end(), fits);
}

bool IsMediaType(std::string_view text) {
  return text.substr(0, kPrefix.size()) == kPrefix && text.size() <= ScalarCaps::kMaxName &&
         IsName(text.substr(kPrefix.size()));
}

/// Returns the size of the UTF-8 character at the beginning of `text`, or 0 if the character is
/// invalid.
std::size_t SizeOfCharacter(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  if (byte(0) < 0x80) return 1;
  const std::size_t size = byte(0) >= 0xF0 ? 4 : byte(0) >= 0xE0 ? 3 : 2;
  if (byte(0) < 0xC2 || byte(0) > 0xF4 || text.size() < size) return 0;
  std::uint32_t code = byte(0) & (0xFFU >> (size + 1));
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3FU);
  }
  constexpr std::array<std::uint32_t, 5> kLeast = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  return code >= kLeast[size] && code <= 0x10FFFF && !surrogate ? size : 0;
}

/// Returns true if `text` is valid UTF-8 without control characters, which would spoil logs.
bool IsPrintable(std::string_view text) {
  while (!text.empty()) {
    const std::size_t size = SizeOfCharacter(text);
    if (size == 0 || text[0] == 0x7F || (text[0] >= 0 && text[0] < ' ')) return false;
    text.remove_prefix(size);
  }
  return true;
}

template <class T>
std::optional<T> ParseNumber(std::string_view text) {
  T value{};
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
  if constexpr (std::is_floating_point_v<T>)
    if (!std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<bool> ParseBool(std::string_view text) {
  if (text == "true") return true;
  if (text == "false") return false;
  return std::nullopt;
}

/// Returns true if GStreamer accepts `value` as a fraction.
bool IsFraction(const Fraction& value) {
  return value.denominator > 0 && value.numerator > std::numeric_limits<std::int32_t>::min();
}

std::optional<Fraction> ParseFraction(std::string_view text) {
  const auto slash = text.find('/');
  if (slash == text.npos) return std::nullopt;
  const auto n = ParseNumber<std::int32_t>(text.substr(0, slash));
  const auto d = ParseNumber<std::int32_t>(text.substr(slash + 1));
  if (!n || !d || !IsFraction({*n, *d})) return std::nullopt;
  return Fraction{*n, *d};
}

std::optional<Bytes> ParseBytes(std::string_view text) {
  if (text.size() % 2 != 0) return std::nullopt;
  Bytes bytes(text.size() / 2);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const char* begin = text.data() + 2 * i;
    if (std::from_chars(begin, begin + 2, bytes[i], 16).ptr != begin + 2) return std::nullopt;
  }
  return bytes;
}

template <std::size_t type>
std::optional<Value> ParseAs(std::string_view text) {
  using T = std::variant_alternative_t<type, Value>;
  const auto value = [&] {
    if constexpr (std::is_same_v<T, std::string>)
      return std::optional<std::string>(text);
    else if constexpr (std::is_same_v<T, bool>)
      return ParseBool(text);
    else if constexpr (std::is_same_v<T, Fraction>)
      return ParseFraction(text);
    else if constexpr (std::is_same_v<T, Bytes>)
      return ParseBytes(text);
    else
      return ParseNumber<T>(text);
  }();
  if (!value) return std::nullopt;
  return Value(std::in_place_index<type>, *value);
}

template <std::size_t... types>
std::optional<Value> ParseValue(std::size_t type, std::string_view text,
                                std::index_sequence<types...>) {
  constexpr std::array<std::optional<Value> (*)(std::string_view), sizeof...(types)> kParsers = {
      ParseAs<types>...};
  return kParsers[type](text);
}

/// Parses a text from its beginning to its end.
class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  bool at_end() const { return text_.empty(); }

  bool Take(char c) {
    if (text_.empty() || text_[0] != c) return false;
    text_.remove_prefix(1);
    return true;
  }
  void SkipSpaces() {
    while (Take(' ')) {
    }
  }
  std::string_view TakeBare() {
    const auto end = std::find_if_not(text_.begin(), text_.end(), IsBare);
    const auto size = static_cast<std::size_t>(end - text_.begin());
    const std::string_view taken = text_.substr(0, size);
    text_.remove_prefix(size);
    return taken;
  }
  /// Parses a quoted string. The opening quote was already read. Reads the closing quote, too.
  std::optional<std::string> TakeQuoted() {
    std::string out;
    while (!Take('"')) {
      const bool escaped = Take('\\');
      if (text_.empty() || (text_[0] & 0x80) != 0) return std::nullopt;
      if (escaped && IsDigit(text_[0])) {
        std::uint8_t byte = 0;
        const char* begin = text_.data();
        if (text_.size() < 3) return std::nullopt;
        const auto result = std::from_chars(begin, begin + 3, byte, 8);
        if (result.ec != std::errc() || result.ptr != begin + 3) return std::nullopt;
        out += static_cast<char>(byte);
        text_.remove_prefix(3);
      } else {
        out += text_[0];
        text_.remove_prefix(1);
      }
    }
    return out;
  }

 private:
  std::string_view text_;
};

/// Parses an array of doubles. The opening bracket was already read. Reads the closing bracket,
/// too.
std::optional<Value> TakeDoubles(Reader* r) {
  Doubles values;
  do {
    r->SkipSpaces();
    const auto value = ParseNumber<double>(r->TakeBare());
    if (!value || values.size() == ScalarCaps::kMaxDoubles) return std::nullopt;
    values.push_back(*value);
  } while (r->Take(','));
  r->SkipSpaces();
  if (!r->Take('>')) return std::nullopt;
  return Value(std::move(values));
}

std::optional<ScalarCaps::Field> TakeField(Reader* r) {
  ScalarCaps::Field field{std::string(r->TakeBare()), {}};
  if (!IsName(field.name) || !r->Take('=') || !r->Take('(')) return std::nullopt;
  const auto* type = std::find(kTypeNames.begin(), kTypeNames.end(), r->TakeBare());
  if (type == kTypeNames.end() || !r->Take(')')) return std::nullopt;
  const bool is_string = type == kTypeNames.begin();
  std::optional<Value> value;
  if (is_string && r->Take('"')) {
    value = r->TakeQuoted();
  } else if (*type == kTypeNames[kDoubles] && r->Take('<')) {
    value = TakeDoubles(r);
  } else {
    const std::string_view bare = r->TakeBare();
    if (is_string && (bare.empty() || bare == "NULL")) return std::nullopt;
    value = ParseValue(static_cast<std::size_t>(type - kTypeNames.begin()), bare,
                       std::make_index_sequence<kDoubles>());
  }
  if (!value || (is_string && !IsPrintable(std::get<std::string>(*value)))) return std::nullopt;
  field.value = *std::move(value);
  return field;
}

void AppendString(const std::string& value, std::string* text) {
  if (!value.empty() && value != "NULL" && std::all_of(value.begin(), value.end(), IsBare)) {
    *text += value;
    return;
  }
  *text += '"';
  for (const char c : value) {
    if (!IsBare(c)) *text += '\\';
    if ((c & 0x80) != 0) {
      for (const int shift : {6, 3, 0})
        *text += static_cast<char>('0' + (static_cast<std::uint8_t>(c) >> shift & 7));
    } else {
      *text += c;
    }
  }
  *text += '"';
}

void AppendBytes(const Bytes& value, std::string* text) {
  constexpr const char* kHex = "0123456789abcdef";
  for (const std::uint8_t byte : value) (*text += kHex[byte >> 4]) += kHex[byte & 15];
}

template <class T>
void AppendNumber(T value, std::string* text) {
  std::array<char, 64> digits;
  *text += std::string_view(
      digits.data(),
      static_cast<std::size_t>(
          std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr - digits.data()));
}

void AppendDoubles(const Doubles& values, std::string* text) {
  *text += "< ";
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) *text += ", ";
    AppendNumber(values[i], text);
  }
  *text += " >";
}

void AppendValue(const Value& value, std::string* text) {
  std::visit(
      [&](const auto& v) {
        using T = std::decay_t<decltype(v)>;
        if constexpr (std::is_same_v<T, std::string>) {
          AppendString(v, text);
        } else if constexpr (std::is_same_v<T, bool>) {
          *text += v ? "true" : "false";
        } else if constexpr (std::is_same_v<T, Bytes>) {
          AppendBytes(v, text);
        } else if constexpr (std::is_same_v<T, Doubles>) {
          AppendDoubles(v, text);
        } else if constexpr (std::is_same_v<T, Fraction>) {
          AppendNumber(v.numerator, text);
          *text += '/';
          AppendNumber(v.denominator, text);
        } else {
          AppendNumber(v, text);
        }
      },
      value);
}

/// Returns what is wrong with `value`, or nothing if it is valid.
std::optional<std::string> WrongIn(const Value& value) {
  if (const auto* text = std::get_if<std::string>(&value))
    if (!IsPrintable(*text)) return "has characters that cannot be printed";
  if (const auto* fraction = std::get_if<Fraction>(&value))
    if (!IsFraction(*fraction)) return "is not a fraction";
  const auto is_finite = [](double v) { return std::isfinite(v); };
  const auto* one = std::get_if<float>(&value);
  const auto* two = std::get_if<double>(&value);
  const auto* more = std::get_if<Doubles>(&value);
  if ((one != nullptr && !std::isfinite(*one)) || (two != nullptr && !std::isfinite(*two)) ||
      (more != nullptr && !std::all_of(more->begin(), more->end(), is_finite)))
    return "is not finite";
  if (more != nullptr && (more->empty() || more->size() > ScalarCaps::kMaxDoubles))
    return "must have 1 to " + std::to_string(ScalarCaps::kMaxDoubles) + " values";
  return std::nullopt;
}

}  // namespace

std::optional<ScalarCaps> ScalarCaps::Parse(std::string_view text) {
  if (text.size() > kMaxText) return std::nullopt;
  Reader r(text);
  ScalarCaps caps;
  caps.media_type = r.TakeBare();
  if (!IsMediaType(caps.media_type)) return std::nullopt;
  while (r.Take(',')) {
    r.SkipSpaces();
    auto field = TakeField(&r);
    if (!field || caps.fields.size() == kMaxFields || caps.Find(field->name) != nullptr)
      return std::nullopt;
    caps.fields.push_back(*std::move(field));
  }
  if (!r.at_end()) return std::nullopt;
  return caps;
}

std::optional<std::string> ScalarCaps::ToText(std::string* why) const {
  const auto refuse = [&](const std::string& reason) {
    if (why != nullptr) *why = reason;
    return std::nullopt;
  };
  if (!IsMediaType(media_type)) return refuse(media_type + " does not begin with application/x-");
  if (fields.size() > kMaxFields)
    return refuse("the caps have more than " + std::to_string(kMaxFields) + " fields");
  std::string text = media_type;
  for (const Field& field : fields) {
    if (!IsName(field.name))
      return refuse("the field name " + field.name +
                    " must begin with a letter and have only letters, digits, -, _ and .");
    if (const auto wrong = WrongIn(field.value))
      return refuse("the field " + field.name + " " + *wrong);
    text.append(", ").append(field.name).append("=(");
    text.append(kTypeNames[field.value.index()]).append(")");
    AppendValue(field.value, &text);
  }
  if (text.size() > kMaxText)
    return refuse("the text of the caps has more than " + std::to_string(kMaxText) + " bytes");
  return text;
}

const ScalarCaps::Value* ScalarCaps::Find(std::string_view name) const {
  const auto at = std::find_if(fields.begin(), fields.end(),
                               [&](const Field& field) { return field.name == name; });
  return at == fields.end() ? nullptr : &at->value;
}

}  // namespace lidar
