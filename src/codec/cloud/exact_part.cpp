// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/exact_part.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>

#include "src/base/byte_writer.h"
#include "src/codec/cloud/exact_number.h"
#include "src/codec/cloud/firing_guess.h"
#include "src/codec/cloud/number_model.h"
#include "src/codec/mixing/binary_coder.h"
#include "src/codec/varint.h"

namespace lidar::codec::cloud {
namespace {

using Model = NumberModel<3>;

/// The ways to predict a number: by the last number of the beam, by FiringGuess, or, if the guess
/// is larger, by the number of the beam that many firings ago. The last way suits drivers that
/// restart time with each packet.
constexpr std::uint32_t kByBeam = 0;
constexpr std::uint32_t kByFiring = 1;
constexpr std::uint32_t kMostFiringsAgo = 64;

struct FieldCode {
  NumberForm form;
  std::uint32_t guess = kByBeam;
};

/// The keys by which the points may be sorted. A good key is one for which the original order takes
/// few steps.
constexpr unsigned kAsVisited = 0;
constexpr unsigned kAsDecoded = 1;
constexpr unsigned kByFirstField = 2;

struct ExactHeader {
  FiringOrder firing;  // if there are beams
  std::vector<FieldCode> fields;
  std::optional<unsigned> order_key;  // none: the order is not kept
};

std::uint32_t Class(std::int64_t number, std::int64_t most) {
  return static_cast<std::uint32_t>(std::clamp(number, -most, most) + most);
}

/// Codes the distances of ranks from their guesses. A large distance takes 64 plain bits.
template <class Coder>
class RankCoder {
 public:
  explicit RankCoder(Coder* coder) : coder_(*coder) {}
  /// Codes and returns `distance`.
  std::int64_t Code(std::int64_t distance, const Model::Contexts& contexts) {
    constexpr std::int32_t kEscape = Model::kTooLarge - 1;
    const bool fits = distance > -kEscape && distance < kEscape;
    const std::int32_t number =
        model_->Code(fits ? static_cast<std::int32_t>(distance) : kEscape, contexts, &coder_);
    if (number == Model::kTooLarge) failed_ = true;
    if (number < kEscape) return number;
    std::uint64_t raw = 0;
    for (unsigned bit = 64; bit-- > 0;) {
      const bool is_set = (static_cast<std::uint64_t>(distance) >> bit & 1) != 0;
      raw = raw << 1 | (coder_.Code(is_set, mixing::kOne / 2) ? 1U : 0U);
    }
    return static_cast<std::int64_t>(raw);
  }
  bool failed() const { return failed_ || coder_.overran(); }

 private:
  std::unique_ptr<Model> model_ = std::make_unique<Model>();
  Coder& coder_;
  bool failed_ = false;
};

/// Estimates the size of what a RankCoder would write.
class RankMeter {
 public:
  std::int64_t Code(std::int64_t distance, const Model::Contexts& /*contexts*/) {
    bits_ += 2 * std::log2(1 + std::abs(static_cast<double>(distance)));
    return distance;
  }
  static constexpr bool failed() { return false; }
  double bits() const { return bits_; }

 private:
  double bits_ = 0;
};

/// The points of a slice, and the order in which they are coded.
struct Visited {
  const PointPlaces& places;
  const FiringOrder& firing;
  std::vector<std::uint32_t> visit;
};

Visited VisitOf(const PointPlaces& places, const FiringOrder& firing) {
  return {places, firing, firing.Visit(places)};
}

/// Codes a field of the first `count` points that are visited.
template <class Ranks>
bool CodeField(const Visited& v, const FieldCode& code, std::size_t count, Ranks* ranks,
               std::vector<std::uint64_t>* numbers) {
  struct Beam {
    std::int64_t level = 0;
    std::int64_t distance = 0;
  };
  std::vector<Beam> beams(std::size_t{v.places.beams} + 1);  // the last one is for loose points
  FiringGuess guess(v.places.beams);
  RepeatGuess repeat(v.places.beams, code.guess > kByFiring ? code.guess : 0);
  std::int64_t last = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const PointPlace& place = v.places.points[v.visit[i]];
    std::uint64_t& bits = (*numbers)[v.visit[i]];
    const bool by_firing = code.guess != kByBeam && !place.is_loose();
    const std::uint32_t index = place.is_loose() ? v.places.beams : place.beam;
    Beam& beam = beams[index];
    const std::uint32_t firing = place.is_loose() ? 0 : v.firing.FiringOf(place, v.places.columns);
    std::int64_t level = beam.level;
    std::uint32_t state = place.is_loose() ? 0 : 1;
    std::optional<std::int64_t>* before = nullptr;
    if (by_firing) {
      level = guess.LevelOf(place.beam, firing);
      state = !guess.Knows(place.beam) ? 2 : guess.starts() ? 3 : 4;
      before = repeat.At(place.beam, firing);
      if (before != nullptr && *before) {
        level = **before;
        state = 5;
      }
    }
    const std::int64_t expected = code.form.RankAt(level);
    const auto residue = static_cast<std::uint32_t>(level & (NumberForm::kParts - 1));
    const Model::Contexts contexts = {state * 16 + Class(beam.distance, 7),
                                      state * 64 + Class(last, 7) * 4 + Class(beam.distance, 1),
                                      state * 64 + residue * 4 + Class(last, 1)};
    const std::int64_t distance = ranks->Code(Minus(code.form.RankOf(bits), expected), contexts);
    if (ranks->failed()) return false;
    const std::int64_t rank = Plus(expected, distance);
    bits = code.form.WithRank(rank);
    beam.level = code.form.LevelOf(rank);
    beam.distance = last = distance;
    if (by_firing) guess.Learn(place.beam, firing, beam.level);
    if (before != nullptr) *before = beam.level;
  }
  return true;
}

/// Returns the indices of all points, sorted by `key`.
std::vector<std::uint32_t> Sequence(const Visited& v, unsigned key,
                                    const std::vector<ExactField>& fields) {
  std::vector<std::uint32_t> sequence = v.visit;
  if (key == kAsDecoded) std::iota(sequence.begin(), sequence.end(), 0U);
  if (key < kByFirstField) return sequence;
  const auto& numbers = fields[key - kByFirstField].numbers;
  const NumberForm form{fields[key - kByFirstField].type};
  std::vector<std::int64_t> ranks(numbers.size());
  std::transform(numbers.begin(), numbers.end(), ranks.begin(),
                 [&](std::uint64_t bits) { return form.RankOf(bits); });
  std::stable_sort(sequence.begin(), sequence.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return ranks[a] < ranks[b]; });
  return sequence;
}

/// Returns the place in `sequence` of each point, in the original order of the points.
std::vector<std::uint32_t> PlacesInSequence(const std::vector<std::uint32_t>& sequence,
                                            const std::vector<std::uint32_t>& order) {
  std::vector<std::uint32_t> places(order.size());
  for (std::uint32_t i = 0; i < sequence.size(); ++i) places[order[sequence[i]]] = i;
  return places;
}

/// The free places of a sequence. Each call takes nearly constant time.
class FreePlaces {
 public:
  explicit FreePlaces(std::uint32_t count) : next_(std::size_t{count} + 1) {
    std::iota(next_.begin(), next_.end(), 0U);
  }
  /// Returns the first free place that is not before `place`, or the number of places if there is
  /// none.
  std::uint32_t From(std::uint32_t place) {
    while (next_[place] != place) place = next_[place] = next_[next_[place]];
    return place;
  }
  /// Takes `place`. Returns false if it was already taken.
  bool Take(std::uint32_t place) {
    if (next_[place] != place) return false;
    next_[place] = place + 1;
    return true;
  }

 private:
  /// The entry of a free place is the place itself. The entry of a taken place is a later place,
  /// but not later than the next free place.
  std::vector<std::uint32_t> next_;
};

/// Codes the original order of the points as steps through `sequence`.
template <class Coder>
bool CodeOrder(const std::vector<std::uint32_t>& sequence, std::vector<std::uint32_t>* order,
               Coder* coder) {
  std::vector<std::uint32_t> places;
  if constexpr (!Coder::kDecodes) places = PlacesInSequence(sequence, *order);
  places.resize(sequence.size());
  FreePlaces free(static_cast<std::uint32_t>(sequence.size()));
  RankCoder<Coder> ranks(coder);
  std::array<std::int64_t, 3> last{};
  std::int64_t next = 0;
  for (std::uint32_t i = 0; i < sequence.size(); ++i) {
    next = free.From(static_cast<std::uint32_t>(next));
    const Model::Contexts contexts = {Class(last[0], 15),
                                      Class(last[0], 7) * 16 + Class(last[1], 7),
                                      Class(last[1], 7) * 16 + Class(last[2], 7)};
    const std::int64_t step = ranks.Code(Minus(places[i], next), contexts);
    const std::int64_t place = Plus(next, step);
    if (ranks.failed() || place < 0 || place >= static_cast<std::int64_t>(sequence.size()) ||
        !free.Take(static_cast<std::uint32_t>(place))) {
      return false;
    }
    if constexpr (Coder::kDecodes) (*order)[sequence[static_cast<std::size_t>(place)]] = i;
    last = {step, last[0], last[1]};
    next = place + 1;
  }
  return true;
}

/// Codes the delay and the rank of each beam.
template <class Coder>
bool CodeSlots(std::uint32_t columns, FiringOrder* firing, Coder* coder) {
  const auto model = std::make_unique<Model>();
  const Model::Contexts delays = {0, 0, 0};
  const Model::Contexts ranks = {1, 1, 1};
  FiringOrder::Slot last;
  for (FiringOrder::Slot& slot : firing->slots) {
    const auto delay =
        model->Code(static_cast<std::int32_t>(slot.delay) - static_cast<std::int32_t>(last.delay),
                    delays, coder);
    const auto rank = model->Code(
        static_cast<std::int32_t>(slot.rank) - static_cast<std::int32_t>(last.rank), ranks, coder);
    slot.delay = last.delay + static_cast<std::uint32_t>(delay);
    slot.rank = last.rank + static_cast<std::uint32_t>(rank);
    if (coder->overran() || slot.delay >= columns || slot.rank >= firing->slots.size())
      return false;
    last = slot;
  }
  return true;
}

template <class Coder>
bool CodeAll(const PointPlaces& places, ExactHeader* header, ExactPart* part, Coder* coder) {
  if (places.beams > 0 && !CodeSlots(places.columns, &header->firing, coder)) return false;
  const Visited visited = VisitOf(places, header->firing);
  for (std::size_t i = 0; i < part->fields.size(); ++i) {
    RankCoder<Coder> ranks(coder);
    if (!CodeField(visited, header->fields[i], visited.visit.size(), &ranks,
                   &part->fields[i].numbers)) {
      return false;
    }
  }
  if (!header->order_key) return true;
  const auto sequence = Sequence(visited, *header->order_key, part->fields);
  return CodeOrder(sequence, &part->order, coder);
}

// The flags in the first byte of a section.
constexpr unsigned kOrderFlag = 1;
constexpr unsigned kDescendsFlag = 2;
// The type of a field begins at this bit of its first byte.
constexpr unsigned kTypeShift = 5;

void WriteHeader(const ExactHeader& header, ByteWriter* writer) {
  writer->U8(static_cast<std::uint8_t>((header.order_key ? kOrderFlag : 0) |
                                       (header.firing.descends ? kDescendsFlag : 0)));
  writer->U8(static_cast<std::uint8_t>(header.fields.size()));
  for (const FieldCode& field : header.fields) {
    writer->U8(static_cast<std::uint8_t>(field.form.decimals |
                                         static_cast<unsigned>(field.form.type) << kTypeShift));
    writer->U8(static_cast<std::uint8_t>(field.guess));
    if (field.form.is_float())
      writer->U8(static_cast<std::uint8_t>(field.form.scale - NumberForm::kLeastScale));
  }
  if (header.order_key) writer->U8(static_cast<std::uint8_t>(*header.order_key));
  if (!header.firing.slots.empty()) WriteVarint(header.firing.first, writer);
}

/// Reads the header of a section up to the end of the fields.
bool ReadFields(ByteReader* reader, unsigned* flags, std::vector<FieldCode>* fields) {
  *flags = reader->U8();
  const unsigned count = reader->U8();
  if ((*flags & ~(kOrderFlag | kDescendsFlag)) != 0 || count > PointFields::kMaxFields)
    return false;
  for (unsigned i = 0; i < count; ++i) {
    const unsigned first = reader->U8();
    FieldCode field;
    field.form.type = static_cast<FieldType>(first >> kTypeShift);
    field.form.decimals = first & ((1U << kTypeShift) - 1);
    field.guess = reader->U8();
    if (field.form.is_float()) field.form.scale = reader->U8() + NumberForm::kLeastScale;
    if (field.form.decimals > (field.form.is_float() ? NumberForm::kMostDecimals : 0) ||
        field.guess > kMostFiringsAgo) {
      return false;
    }
    fields->push_back(field);
  }
  return reader->ok();
}

bool ReadHeader(ByteReader* reader, const PointPlaces& places, ExactHeader* header) {
  unsigned flags = 0;
  if (!ReadFields(reader, &flags, &header->fields)) return false;
  if ((flags & kOrderFlag) != 0) {
    header->order_key = reader->U8();
    if (*header->order_key >= kByFirstField + header->fields.size()) return false;
  }
  header->firing.descends = (flags & kDescendsFlag) != 0;
  header->firing.slots.resize(places.beams);
  bool ok = true;
  if (places.beams > 0) header->firing.first = ReadVarint(reader, &ok);
  return ok && reader->ok() && (places.beams == 0 || header->firing.first < places.columns);
}

/// Finds the order of firings from the order of the points. If too few points agree with it, finds
/// it from the field with which most points agree.
FiringOrder BestFiringOrder(const PointPlaces& places, const ExactPart& part) {
  if (places.beams == 0) return {};
  std::vector<std::int64_t> clock(part.order.begin(), part.order.end());
  double fit = 0;
  FiringOrder best = FindFiringOrder(places, clock, &fit);
  for (const ExactField& field : part.fields) {
    constexpr double kGood = 0.9;
    if (fit > kGood) break;
    const NumberForm form = FormsFor(field.type, field.numbers).front();
    std::transform(field.numbers.begin(), field.numbers.end(), clock.begin(),
                   [&](std::uint64_t bits) { return form.LevelOf(form.RankOf(bits)); });
    double other_fit = 0;
    FiringOrder other = FindFiringOrder(places, clock, &other_fit);
    if (other_fit <= fit) continue;
    fit = other_fit;
    best = std::move(other);
  }
  return best;
}

/// Returns the number of firings after which beams repeat most of their numbers. Returns kByFiring
/// if they do not repeat them.
std::uint32_t BestPeriod(const Visited& v, const std::vector<std::uint64_t>& numbers) {
  constexpr std::size_t kSample = 4'096;
  std::uint32_t best = kByFiring;
  std::size_t most = std::min(kSample, numbers.size()) / 2;
  for (std::uint32_t period = 2; v.places.beams > 0 && period <= kMostFiringsAgo; ++period) {
    RepeatGuess repeat(v.places.beams, period);
    std::size_t equal = 0;
    for (std::size_t i = 0; i < std::min(kSample, numbers.size()); ++i) {
      const PointPlace& place = v.places.points[v.visit[i]];
      if (place.is_loose()) break;
      auto& before = *repeat.At(place.beam, v.firing.FiringOf(place, v.places.columns));
      const auto bits = static_cast<std::int64_t>(numbers[v.visit[i]]);
      if (before == bits) ++equal;
      before = bits;
    }
    if (equal <= most) continue;
    most = equal;
    best = period;
  }
  return best;
}

FieldCode BestCode(const Visited& visited, const ExactField& field) {
  constexpr std::size_t kSample = 8'192;
  FieldCode best;
  double least = -1;
  std::vector<std::uint64_t> numbers = field.numbers;
  const std::uint32_t period = BestPeriod(visited, numbers);
  for (const NumberForm& form : FormsFor(field.type, field.numbers)) {
    for (const std::uint32_t guess : {kByBeam, kByFiring, period}) {
      if (guess != kByBeam && visited.places.beams == 0) continue;
      RankMeter meter;
      CodeField(visited, {form, guess}, std::min(kSample, numbers.size()), &meter, &numbers);
      if (least >= 0 && meter.bits() >= least) continue;
      best = {form, guess};
      least = meter.bits();
    }
  }
  return best;
}

/// Returns the key with which the original order of the points takes the fewest steps.
unsigned BestOrderKey(const Visited& visited, const ExactPart& part) {
  unsigned best = kAsVisited;
  std::size_t least = SIZE_MAX;
  for (unsigned key = kAsVisited; key < kByFirstField + part.fields.size(); ++key) {
    const auto sequence = Sequence(visited, key, part.fields);
    const auto places = PlacesInSequence(sequence, part.order);
    std::size_t steps = 0;
    for (std::size_t i = 1; i < places.size(); ++i)
      if (places[i] != places[i - 1] + 1) ++steps;
    if (steps >= least) continue;
    least = steps;
    best = key;
  }
  return best;
}

}  // namespace

void EncodeExactPart(const PointPlaces& places, const ExactPart& part,
                     std::vector<std::uint8_t>* out) {
  ExactHeader header;
  header.firing = BestFiringOrder(places, part);
  const Visited visited = VisitOf(places, header.firing);
  for (const ExactField& field : part.fields) header.fields.push_back(BestCode(visited, field));
  if (part.keeps_order) header.order_key = BestOrderKey(visited, part);
  ByteWriter writer(out);
  WriteHeader(header, &writer);
  mixing::BinaryEncoder bits(out);
  ExactPart coded = part;
  CodeAll(places, &header, &coded, &bits);
  bits.Finish();
}

std::optional<std::vector<FieldType>> ExactTypesOf(ByteView section) {
  ByteReader reader(section);
  unsigned flags = 0;
  std::vector<FieldCode> fields;
  if (!ReadFields(&reader, &flags, &fields)) return std::nullopt;
  std::vector<FieldType> types;
  for (const FieldCode& field : fields) types.push_back(field.form.type);
  return types;
}

bool DecodeExactPart(ByteView section, const PointPlaces& places, std::size_t most_numbers,
                     ExactPart* part) {
  *part = {};
  ByteReader reader(section);
  ExactHeader header;
  if (!ReadHeader(&reader, places, &header)) return false;
  for (const FieldCode& code : header.fields) part->fields.push_back({code.form.type, {}});
  part->keeps_order = header.order_key.has_value();
  const std::size_t points = places.points.size();
  if (part->empty() || part->Numbers(points) > most_numbers) return false;
  for (ExactField& field : part->fields) field.numbers.resize(points);
  if (part->keeps_order) part->order.resize(points);
  mixing::BinaryDecoder bits(reader.Rest());
  return CodeAll(places, &header, part, &bits) && bits.AtEnd();
}

}  // namespace lidar::codec::cloud
