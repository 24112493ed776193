// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/cell_tree.h"

#include <algorithm>
#include <cmath>

#include "src/codec/mixing/binary_coder.h"

namespace lidar::codec::cloud {
namespace {

using mixing::BinaryDecoder;
using mixing::BinaryEncoder;
using mixing::BitLength;
using mixing::BitMixer;
using mixing::Counter;
using mixing::Weights;

constexpr std::uint32_t kTable = 1U << 16;

std::uint32_t Hash(std::uint64_t value) {
  return static_cast<std::uint32_t>(value * 0x9E3779B97F4A7C15U >> 48);
}

/// The direction from the middle of a grid to the cell at `p`, in half cells. The grid has 2^depth
/// cells along each axis.
struct Direction {
  Direction(const CellPosition& p, unsigned depth) {
    const auto at = [&](unsigned k) {
      return 2 * static_cast<std::int64_t>(p[k]) + 1 - (std::int64_t{1} << depth);
    };
    const std::int64_t x = at(0);
    const std::int64_t y = at(1);
    z = at(2);
    rho = static_cast<std::int64_t>(std::sqrt(static_cast<double>(x * x + y * y)));
  }
  /// Returns the tangent of the elevation in 1/`parts`, clamped to +-`limit`.
  std::int64_t Tangent(std::int64_t parts, std::int64_t limit) const {
    // Doubles are exact enough to round these quotients down correctly. A division of doubles is
    // faster.
    const auto quotient = static_cast<std::int64_t>(
        static_cast<double>(z * parts) / static_cast<double>(std::max<std::int64_t>(rho, 1)));
    return std::clamp(quotient, -limit, limit);
  }
  std::uint32_t RangeClass() const {
    const auto r = static_cast<std::uint64_t>(std::max(rho, z < 0 ? -z : z));
    const auto bits = static_cast<unsigned>(64 - __builtin_clzll(r | 1));
    const std::uint64_t next = bits > 1 ? r >> (bits - 2) & 1 : 0;
    return static_cast<std::uint32_t>(2 * bits + next);
  }
  std::int64_t rho = 0;
  std::int64_t z = 0;
};

/// A bit for each of 4 x 4 x 4 cells: the children of a node, and the cells around them. Cell (x,
/// y, z) is bit x + 4 y + 16 z. The children have coordinates 1 and 2.
using CellBits = std::uint64_t;
constexpr std::array<unsigned, 8> kChildAt = {21, 22, 25, 26, 37, 38, 41, 42};

/// Returns, for each child of a node, the neighbours of the node that touch this child.
constexpr std::array<std::uint32_t, 8> NodesByChild() {
  std::array<std::uint32_t, 8> nodes{};
  for (unsigned child = 0; child < 8; ++child)
    for (unsigned i = 0; i < 27; ++i) {
      const auto touches = [](unsigned side, unsigned bit) { return side == 1 || side == 2 * bit; };
      if (touches(i % 3, child & 1) && touches(i / 3 % 3, child >> 1 & 1) &&
          touches(i / 9, child >> 2))
        nodes[child] |= 1U << i;
    }
  return nodes;
}
constexpr std::array<std::uint32_t, 8> kNodesBy = NodesByChild();

/// Returns the bits that each set of children has in CellBits. Bit n of the index is child n. The
/// results are shifted so that child 0 is bit 0.
constexpr std::array<CellBits, 256> SpreadChildren() {
  std::array<CellBits, 256> spread{};
  for (unsigned children = 0; children < 256; ++children)
    for (unsigned child = 0; child < 8; ++child)
      if ((children >> child & 1) != 0) spread[children] |= CellBits{1} << (kChildAt[child] - 21);
  return spread;
}
constexpr std::array<CellBits, 256> kSpread = SpreadChildren();

/// A neighbour of a node. `shift` is the distance in CellBits from the node's children to the
/// neighbour's children. `inside` are the neighbour's children that are among the 4 x 4 x 4 cells.
struct Neighbour {
  int shift = 0;
  unsigned inside = 0;
};
constexpr std::array<Neighbour, 27> FindNeighbours() {
  std::array<Neighbour, 27> all{};
  for (int i = 0; i < 27; ++i) {
    const int first[3] = {2 * (i % 3) - 1, 2 * (i / 3 % 3) - 1, 2 * (i / 9) - 1};
    all[static_cast<unsigned>(i)].shift = first[0] + 4 * first[1] + 16 * first[2];
    for (unsigned child = 0; child < 8; ++child) {
      bool inside = true;
      for (unsigned k = 0; k < 3; ++k) {
        const int at = first[k] + static_cast<int>(child >> k & 1);
        inside = inside && at >= 0 && at < 4;
      }
      if (inside) all[static_cast<unsigned>(i)].inside |= 1U << child;
    }
  }
  return all;
}
constexpr std::array<Neighbour, 27> kNeighbours = FindNeighbours();

/// The place of a node among the 27 nodes of its neighbourhood.
constexpr unsigned kOwnPlace = 13;

/// A parent whose children may be neighbours of a node.
struct ParentBeside {
  unsigned parent = 0;                   // its place among the 27 around the node's parent
  unsigned near = 0;                     // bits of its children that may be neighbours
  std::array<std::uint8_t, 8> places{};  // places of these children among the 27 around the node
};
/// Returns the parents whose children may be neighbours. The first index is the node's place in its
/// own parent. Bit k of the second index is 1 if a parent is beside the node's own parent along
/// axis k.
constexpr std::array<std::array<ParentBeside, 8>, 8> FindParentsBeside() {
  std::array<std::array<ParentBeside, 8>, 8> all{};
  for (unsigned child = 0; child < 8; ++child)
    for (unsigned i = 0; i < 27; ++i) {
      const std::array<unsigned, 3> steps = {i % 3, i / 3 % 3, i / 9};
      unsigned parent = 0;
      unsigned beside = 0;  // bit k: the parent differs along axis k
      unsigned there = 0;
      unsigned scale = 1;
      for (unsigned k = 0; k < 3; ++k) {
        const unsigned at = 1 + (child >> k & 1) + steps[k];  // relative to the own parent, plus 2
        parent += at / 2 * scale;
        beside |= (at / 2 != 1 ? 1U : 0U) << k;
        there |= at % 2 << k;
        scale *= 3;
      }
      if (i == kOwnPlace) continue;
      ParentBeside& found = all[child][beside];
      found.parent = parent;
      found.near |= 1U << there;
      found.places[there] = static_cast<std::uint8_t>(i);
    }
  return all;
}
constexpr auto kParentsBeside = FindParentsBeside();

/// Returns a table. Entry i is the number whose digits in base 3 are the bits of i. If
/// `lowest_first`, the lowest bit is the lowest digit, otherwise the highest digit.
template <unsigned kDigits>
constexpr std::array<std::uint32_t, 1U << kDigits> Base3(bool lowest_first) {
  std::array<std::uint32_t, 1U << kDigits> numbers{};
  for (unsigned bits = 0; bits < 1U << kDigits; ++bits)
    for (unsigned k = kDigits; k-- > 0;)
      numbers[bits] = numbers[bits] * 3 + (bits >> (lowest_first ? k : kDigits - 1 - k) & 1);
  return numbers;
}
constexpr auto kFaces3 = Base3<6>(true);
constexpr auto kLayer3 = Base3<8>(false);

/// Returns a bit for each of the 27 cells around a cell. The index of x changes fastest. Bit 13 is
/// the cell itself.
std::uint32_t About(CellBits cells, unsigned at) {
  const CellBits from = cells >> (at - 21);
  const auto plane = [&](unsigned z) {
    const auto bits = static_cast<std::uint32_t>(from >> 16 * z);
    return (bits & 7) | (bits >> 1 & 0x38) | (bits >> 2 & 0x1C0);
  };
  return plane(0) | plane(1) << 9 | plane(2) << 18;
}
std::uint32_t FacesOf(std::uint32_t about) {
  return (about >> 4 & 1) << 5 | (about >> 10 & 1) << 4 | (about >> 12 & 1) << 3 |
         (about >> 14 & 1) << 2 | (about >> 16 & 1) << 1 | (about >> 22 & 1);
}
std::uint32_t LayerOf(std::uint32_t about) { return (about >> 9 & 15) | (about >> 14 & 15) << 4; }

std::uint32_t Ones(std::uint32_t bits) {
  bits -= bits >> 1 & 0x55555555;
  bits = (bits & 0x33333333) + (bits >> 2 & 0x33333333);
  return ((bits + (bits >> 4)) & 0x0F0F0F0F) * 0x01010101 >> 24;
}

/// The states of the 26 cells around a cell.
struct Tally {
  static constexpr std::uint32_t kItself = 1U << 13;

  Tally(CellBits occupied, CellBits unknown, unsigned at) : mask(About(occupied, at) & ~kItself) {
    constexpr std::uint32_t kCornersOfPlane = 0x145;
    constexpr std::uint32_t kEdgesOfPlane = 0xAA;
    constexpr std::uint32_t kAllCorners = kCornersOfPlane | kCornersOfPlane << 18;
    constexpr std::uint32_t kAllEdges = kEdgesOfPlane | kCornersOfPlane << 9 | kEdgesOfPlane << 18;
    const std::uint32_t open = About(unknown, at);
    faces = kFaces3[FacesOf(mask)] + 2 * kFaces3[FacesOf(open)];
    layer = kLayer3[LayerOf(mask)] + 2 * kLayer3[LayerOf(open)];
    faces_on = Ones(FacesOf(mask));
    edges_on = Ones(mask & kAllEdges);
    edges_open = Ones(open & kAllEdges);
    corners_on = Ones(mask & kAllCorners);
  }
  std::uint32_t mask = 0;   // occupied cells
  std::uint32_t faces = 0;  // states of the six cells at its faces: 0 empty, 1 occupied, 2 unknown
  std::uint32_t layer = 0;  // states of the eight cells around it at the same height
  std::uint32_t faces_on = 0;
  std::uint32_t edges_on = 0;
  std::uint32_t edges_open = 0;
  std::uint32_t corners_on = 0;
};

}  // namespace

struct CellTree::Model {
  void Reset() {
    for (auto& table : counters) table.fill({});
    for (auto& table : counts) table.fill({});
    Weights equal;
    equal.values.fill(mixing::kWeightOne / 4);
    for (auto* set : {&first, &second, &count_weights}) set->fill(equal);
  }
  std::array<std::array<Counter, kTable>, kContexts> counters;
  std::array<Weights, 1024> first;
  std::array<Weights, 1024> second;
  std::array<std::array<Counter, kTable>, 3> counts;
  std::array<Weights, 1024> count_weights;
};

/// A parent node and the 26 nodes around it.
struct CellTree::Family {
  std::array<std::uint8_t, 27> occupancy{};
  std::array<std::uint32_t, 27> first_children{};  // index of each node's first child
};

struct CellTree::Surroundings {
  CellBits occupied = 0;
  CellBits unknown = 0;
  std::uint32_t nodes = 0;  // occupied nodes among the 26 neighbours
};

CellTree::CellTree() = default;
CellTree::CellTree(CellTree&&) noexcept = default;
CellTree& CellTree::operator=(CellTree&&) noexcept = default;
CellTree::~CellTree() = default;

void CellTree::FillLevels(const CellList& cells) {
  levels_[cells.depth].codes = cells.codes;
  for (unsigned d = cells.depth; d-- > 0;) {
    levels_[d].codes.clear();
    levels_[d].occupancy.clear();
    for (const std::uint64_t code : levels_[d + 1].codes) {
      if (levels_[d].codes.empty() || levels_[d].codes.back() != code >> 3) {
        levels_[d].codes.push_back(code >> 3);
        levels_[d].occupancy.push_back(0);
      }
      levels_[d].occupancy.back() =
          static_cast<std::uint8_t>(levels_[d].occupancy.back() | 1U << (code & 7));
    }
  }
}

/// Adds the parents to `map_`, and finds the index of each parent's first child.
void CellTree::ListParents(const Level& parents) {
  map_.Reset(parents.codes.size());
  first_children_.resize(parents.codes.size());
  std::uint32_t first = 0;
  for (std::uint32_t i = 0; i < parents.codes.size(); ++i) {
    map_.Add(NodeMap::KeyOf(PositionOf(parents.codes[i])), i);
    first_children_[i] = first;
    first += Ones(parents.occupancy[i]);
  }
}

CellTree::Family CellTree::FamilyOf(const Level& parents, std::uint32_t parent) const {
  constexpr std::uint64_t kOneEach = NodeMap::kStepX + NodeMap::kStepY + NodeMap::kStepZ;
  const std::uint64_t corner = NodeMap::KeyOf(PositionOf(parents.codes[parent])) - kOneEach;
  Family family;
  for (unsigned i = 0; i < 27; ++i) {
    const std::uint32_t index =
        i == kOwnPlace ? parent
                       : map_.Find(corner + i % 3 * NodeMap::kStepX + i / 3 % 3 * NodeMap::kStepY +
                                   i / 9 * NodeMap::kStepZ);
    if (index == NodeMap::kAbsent) continue;
    family.occupancy[i] = parents.occupancy[index];
    family.first_children[i] = first_children_[index];
  }
  return family;
}

/// Sets the occupied and the unknown cells around a node's children. All children of a neighbour
/// are unknown if the neighbour is not coded yet.
void CellTree::Look(const Place& place, const Family& family, Surroundings* around) const {
  const auto& occupancy = levels_[place.depth - 1].occupancy;
  *around = {};
  for (const ParentBeside& beside : kParentsBeside[place.child]) {
    const unsigned nodes = family.occupancy[beside.parent];
    for (unsigned left = nodes & beside.near; left != 0; left &= left - 1) {
      const auto child = static_cast<unsigned>(__builtin_ctz(left));
      const unsigned i = beside.places[child];
      const std::uint32_t index =
          family.first_children[beside.parent] + Ones(nodes & ((1U << child) - 1));
      around->nodes |= 1U << i;
      const bool known = index < place.node;
      const unsigned children = (known ? occupancy[index] : 0xFFU) & kNeighbours[i].inside;
      const int shift = kNeighbours[i].shift;
      const CellBits bits = shift < 0 ? kSpread[children] >> -shift : kSpread[children] << shift;
      (known ? around->occupied : around->unknown) |= bits;
    }
  }
  around->unknown |= kSpread[0xFF] << kChildAt[0];
}

template <class Coder>
std::uint8_t CellTree::CodeNode(std::uint8_t occupancy, const Place& place, const Family& family,
                                Coder* coder) {
  Surroundings around;
  Look(place, family, &around);
  const unsigned level = std::min(place.to_leaves, 7U);
  unsigned coded = 0;
  unsigned ones = 0;
  for (unsigned child = 0; child < 8; ++child) {
    const unsigned at = kChildAt[child];
    if (child == 7 && ones == 0) {
      coded |= 0x80;
      break;
    }
    const Tally tally(around.occupied, around.unknown, at);
    const CellPosition cell = {2 * place.position[0] + (child & 1),
                               2 * place.position[1] + (child >> 1 & 1),
                               2 * place.position[2] + (child >> 2)};
    const Direction direction(cell, place.depth);
    const std::uint32_t range = direction.RangeClass();
    const std::uint32_t some = std::min(ones, 3U);
    const std::int64_t parts = std::int64_t{1} << std::min(range / 2 + 1, 11U);
    const auto tangent = static_cast<std::uint64_t>(direction.Tangent(parts, 4'095) + 4'096);
    const std::array<std::uint32_t, kContexts> contexts = {
        (level * 8 + child) * 256 + coded,
        (tally.faces * 2 + (ones > 0 ? 1 : 0)) * 8 + level,
        Hash(((((std::uint64_t{tally.edges_on} * 16 + tally.edges_open) * 16 + tally.corners_on) *
                   8 +
               tally.faces_on) *
                  4 +
              some) *
                 8 +
             level),
        Hash((std::uint64_t{tally.mask} * 2 + (level == 0 ? 1 : 0)) * 4 + some),
        Hash((tangent * 64 + range) * 4 + some),
        (range * 4 + some) * 64 + tally.faces_on * 8 + std::min(tally.edges_on, 7U),
        Hash(((std::uint64_t{family.occupancy[kOwnPlace]} * 8 + child) * 256 + coded) * 8 + level),
        Hash(((std::uint64_t{around.nodes} & kNodesBy[child]) * 8 + child) * 4 + some),
        Hash((std::uint64_t{tally.layer} * 2 + (level == 0 ? 1 : 0)) * 4 + some)};
    BitMixer<kContexts, 0> mixer;
    mixer.Ask([&](unsigned k)
                  __attribute__((always_inline)) { return &model_->counters[k][contexts[k]]; });
    const bool bit = mixer.Code(
        (occupancy >> child & 1) != 0, &model_->first[(level * 4 + some) * 8 + child],
        &model_->second[(tally.faces_on * 8 + std::min(tally.edges_on, 7U)) * 8 + level], coder);
    around.unknown &= ~(CellBits{1} << at);
    if (!bit) continue;
    around.occupied |= CellBits{1} << at;
    coded |= 1U << child;
    ++ones;
  }
  return static_cast<std::uint8_t>(coded);
}

template <class Coder>
bool CellTree::CodeLevel(unsigned depth, unsigned leaf_depth, const CellLimits& limits,
                         Coder* coder) {
  Level& level = levels_[depth];
  Level& next = levels_[depth + 1];
  nodes_ += level.codes.size();
  if (nodes_ > limits.nodes) return false;
  if (depth > 0) ListParents(levels_[depth - 1]);
  if constexpr (Coder::kDecodes) {
    level.occupancy.resize(level.codes.size());
    next.codes.clear();
  }
  Family family;
  std::uint32_t next_parent = 0;
  for (std::uint32_t i = 0; i < level.codes.size(); ++i) {
    const std::uint64_t code = level.codes[i];
    if (depth > 0 && (i == 0 || code >> 3 != level.codes[i - 1] >> 3))
      family = FamilyOf(levels_[depth - 1], next_parent++);
    const Place place{PositionOf(code), i, depth + 1, leaf_depth - depth - 1,
                      static_cast<unsigned>(code & 7)};
    const std::uint8_t coded = CodeNode(level.occupancy[i], place, family, coder);
    if constexpr (!Coder::kDecodes) continue;
    level.occupancy[i] = coded;
    for (unsigned child = 0; child < 8; ++child)
      if ((coded >> child & 1) != 0) next.codes.push_back(code << 3 | child);
    if (coder->overran() || next.codes.size() > limits.points) return false;
  }
  return true;
}

/// The context in which a cell's count is coded.
struct CellTree::CountContext {
  std::uint32_t last = 0;   // count of the previous cell
  std::uint32_t mean = 0;   // mean count of the neighbours, in halves
  std::uint32_t range = 0;  // class of the range
};

template <class Coder>
std::uint32_t CellTree::CodeCount(std::uint32_t count, const CountContext& context, Coder* coder) {
  const auto octave = [](std::uint32_t v) {
    const auto bits = static_cast<std::uint32_t>(BitLength(v));
    return v < 4 ? v : 2 * bits + (v >> (bits - 2) & 1) - 2;
  };
  const std::uint32_t last = octave(context.last);
  const std::uint32_t mean = octave(context.mean);
  const auto code = [&](bool bit, std::uint32_t node) {
    const std::array<std::uint32_t, 3> at = {
        Hash((std::uint64_t{node} * 64 + last) * 64 + mean),
        Hash((std::uint64_t{node} * 64 + context.range) * 8 + std::min(mean / 2, 7U)),
        Hash(std::uint64_t{node} * 64 + mean)};
    BitMixer<3, 0> mixer;
    mixer.Ask([&](unsigned k) __attribute__((always_inline)) { return &model_->counts[k][at[k]]; });
    return mixer.Code(bit, &model_->count_weights[node], coder);
  };
  // Small counts have a unary code. Larger counts have an Exp-Golomb code.
  constexpr std::uint32_t kSmall = 12;
  std::uint32_t value = 1;
  while (value < kSmall && code(count > value, value)) ++value;
  if (value < kSmall) return value;
  const std::uint32_t rest = count - kSmall + 1;
  constexpr unsigned kMostLength = 28;
  unsigned length = 0;
  const auto wanted = static_cast<unsigned>(BitLength(rest) - 1);
  while (length < kMostLength && code(length < wanted, 16 + length)) ++length;
  value = 1;
  for (unsigned place = length; place-- > 0;)
    value = value << 1 | (code((rest >> place & 1) != 0, 64 + 32 * length + place) ? 1U : 0U);
  return value + kSmall - 1;
}

template <class Coder>
bool CellTree::CodeCounts(CellList* cells, const CellLimits& limits, Coder* coder) {
  const std::size_t size = cells->codes.size();
  if constexpr (Coder::kDecodes) cells->counts.assign(size, 0);
  map_.Reset(size);
  std::uint64_t sum = 0;
  CountContext context;
  for (std::uint32_t i = 0; i < size; ++i) {
    const CellPosition p = PositionOf(cells->codes[i]);
    const std::uint64_t key = NodeMap::KeyOf(p);
    std::uint32_t known = 0;
    std::uint64_t counted = 0;
    for (const std::uint64_t step : {NodeMap::kStepX, NodeMap::kStepY, NodeMap::kStepZ}) {
      const std::uint32_t there = map_.Find(key - step);
      if (there == NodeMap::kAbsent) continue;
      ++known;
      counted += cells->counts[there];
    }
    context.mean = known == 0 ? 0 : static_cast<std::uint32_t>(2 * counted / known);
    context.range = Direction(p, cells->depth).RangeClass();
    const std::uint32_t count = CodeCount(cells->counts[i], context, coder);
    cells->counts[i] = context.last = count;
    map_.Add(key, i);
    sum += count;
    if (coder->overran() || sum > limits.points) return false;
  }
  return sum == limits.points;
}

template <class Coder>
bool CellTree::Code(CellList* cells, const CellLimits& limits, Coder* coder) {
  if (model_ == nullptr) model_ = std::make_unique<Model>();
  model_->Reset();
  nodes_ = 0;
  levels_[0].codes.assign(1, 0);
  if constexpr (!Coder::kDecodes) FillLevels(*cells);
  for (unsigned depth = 0; depth < cells->depth; ++depth)
    if (!CodeLevel(depth, cells->depth, limits, coder)) return false;
  if constexpr (Coder::kDecodes) cells->codes = levels_[cells->depth].codes;
  return CodeCounts(cells, limits, coder);
}

template bool CellTree::Code(CellList*, const CellLimits&, BinaryEncoder*);
template bool CellTree::Code(CellList*, const CellLimits&, BinaryDecoder*);

}  // namespace lidar::codec::cloud
