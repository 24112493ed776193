// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes occupied cells and their counts. The cells are the leaves of an octree, which is coded
// level by level. Several contexts predict each bit.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "src/codec/cloud/cell_list.h"
#include "src/codec/cloud/node_map.h"
#include "src/codec/mixing/bit_mixer.h"

namespace lidar::codec::cloud {

/// The limits of a decoder's work.
struct CellLimits {
  std::size_t points = 0;  // exact number of points
  std::size_t nodes = 0;   // largest number of nodes in all levels
};

/// Codes lists of cells. Keeps its buffers between clouds.
class CellTree {
 public:
  CellTree();
  CellTree(CellTree&&) noexcept;
  CellTree& operator=(CellTree&&) noexcept;
  ~CellTree();

  /// Codes `cells`. A decoder fills `cells`, except for the depth, which the caller has set.
  /// Returns false if the stream is damaged or exceeds `limits`.
  template <class Coder>
  bool Code(CellList* cells, const CellLimits& limits, Coder* coder);
  /// Returns the number of nodes that the last Code() visited.
  std::size_t nodes() const { return nodes_; }

 private:
  static constexpr unsigned kContexts = 9;
  struct Model;
  struct Surroundings;
  struct Family;
  struct CountContext;
  /// A node, and where it is in the tree.
  struct Place {
    CellPosition position;
    std::uint32_t node = 0;  // index in its level
    unsigned depth = 0;      // depth of its children
    unsigned to_leaves = 0;  // levels from its children to the leaves
    unsigned child = 0;      // which child of its parent
  };
  struct Level {
    std::vector<std::uint64_t> codes;
    std::vector<std::uint8_t> occupancy;  // a bit for each child
  };

  void FillLevels(const CellList& cells);
  template <class Coder>
  bool CodeLevel(unsigned depth, unsigned leaf_depth, const CellLimits& limits, Coder* coder);
  template <class Coder>
  std::uint8_t CodeNode(std::uint8_t occupancy, const Place& place, const Family& family,
                        Coder* coder);
  template <class Coder>
  bool CodeCounts(CellList* cells, const CellLimits& limits, Coder* coder);
  template <class Coder>
  std::uint32_t CodeCount(std::uint32_t count, const CountContext& context, Coder* coder);
  void ListParents(const Level& parents);
  Family FamilyOf(const Level& parents, std::uint32_t parent) const;
  void Look(const Place& place, const Family& family, Surroundings* around) const;

  std::unique_ptr<Model> model_;
  std::array<Level, kMostDepth + 1> levels_;
  NodeMap map_;
  std::vector<std::uint32_t> first_children_;  // index of each parent's first child
  std::size_t nodes_ = 0;
};

}  // namespace lidar::codec::cloud
