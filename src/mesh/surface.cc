// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace hullslam {
namespace {

using Voxel = VoxelVolume::Voxel;
using Block = VoxelVolume::Block;

constexpr int kSide = VoxelVolume::kSide;
constexpr size_t kCells = static_cast<size_t>(kSide) * kSide * kSide;
constexpr float kLeastEdges = 3.0F;  // of a cell that have the surface: a plane has three to six
constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

size_t IndexOf(const Eigen::Vector3i& at) {
  return static_cast<size_t>((at.z() * kSide + at.y()) * kSide + at.x());
}

// The corners of a cell: bit 0 of the index is x, bit 1 is y, bit 2 is z.
Eigen::Vector3i Corner(unsigned index) {
  return {static_cast<int>(index & 1U), static_cast<int>((index >> 1U) & 1U),
          static_cast<int>(index >> 2U)};
}

// The part of a surface in one block. The cell of a voxel has it as its first corner.
struct Part {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Colour> colours;
  std::array<uint32_t, kCells> vertex{};  // of each cell; kNone where there is none
  std::vector<TriangleMesh::Triangle> triangles;
  uint32_t first = 0;  // index of the first vertex in the whole surface
};

class Extraction {
 public:
  Extraction(const VoxelVolume& volume, TaskRunner& runner)
      : volume_(volume), runner_(runner), limit_(static_cast<float>(volume.truncation())) {
    for (const auto& block : volume.blocks()) {
      blocks_.push_back(block.get());
    }
    std::ranges::sort(blocks_, [](const Block* a, const Block* b) {
      return std::ranges::lexicographical_compare(a->place, b->place);
    });
    parts_.resize(blocks_.size());
  }

  SurfaceMesh Run() {
    ForBlocks([&](size_t i) { MakeVertices(i); });
    uint32_t count = 0;
    for (Part& part : parts_) {
      part.first = count;
      count += static_cast<uint32_t>(part.positions.size());
    }
    ForBlocks([&](size_t i) { MakeTriangles(i); });
    SurfaceMesh surface;
    for (const Part& part : parts_) {
      surface.positions.insert(surface.positions.end(), part.positions.begin(),
                               part.positions.end());
      surface.colours.insert(surface.colours.end(), part.colours.begin(), part.colours.end());
      surface.triangles.insert(surface.triangles.end(), part.triangles.begin(),
                               part.triangles.end());
    }
    return surface;
  }

 private:
  // The blocks at a block and on one side of it, by the indices of Corner().
  using Eight = std::array<size_t, 8>;

  void ForBlocks(const std::function<void(size_t)>& task) {
    constexpr size_t kPerTask = 64;
    runner_.Run((blocks_.size() + kPerTask - 1) / kPerTask, [&](size_t i) {
      for (size_t k = i * kPerTask; k < std::min(blocks_.size(), (i + 1) * kPerTask); ++k) {
        task(k);
      }
    });
  }

  // The index of the block at a place; kNone if there is none.
  size_t FindBlock(const Eigen::Vector3i& place) const {
    const auto found = std::lower_bound(
        blocks_.begin(), blocks_.end(), place, [](const Block* block, const Eigen::Vector3i& at) {
          return std::ranges::lexicographical_compare(block->place, at);
        });
    return found != blocks_.end() && (*found)->place == place
               ? static_cast<size_t>(found - blocks_.begin())
               : kNone;
  }

  // `side` is 1 for the blocks behind a block and -1 for those before it.
  Eight NeighboursOf(size_t block, int side) const {
    Eight found{};
    for (unsigned i = 0; i < 8; ++i) {
      found[i] = FindBlock(blocks_[block]->place + side * Corner(i));
    }
    return found;
  }

  // The voxel at a place of a block or just behind it; null if it was not seen.
  const Voxel* VoxelAt(const Eight& behind, Eigen::Vector3i at) const {
    const size_t block = behind[Wrap(at)];
    if (block == kNone) {
      return nullptr;
    }
    const Voxel& voxel = blocks_[block]->voxels[IndexOf(at)];
    return voxel.weight > 0.0F ? &voxel : nullptr;
  }

  // The vertex of the cell at a place of a block or just before it; kNone if it has none.
  uint32_t VertexAt(const Eight& before, Eigen::Vector3i at) const {
    const size_t block = before[Wrap(at)];
    if (block == kNone) {
      return kNone;
    }
    const uint32_t vertex = parts_[block].vertex[IndexOf(at)];
    return vertex == kNone ? kNone : parts_[block].first + vertex;
  }

  // Brings a place that is one block too far along some axes into the neighbour. Returns the
  // neighbour as an index of Corner().
  static unsigned Wrap(Eigen::Vector3i& at) {
    unsigned neighbour = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (at[axis] < 0 || at[axis] >= kSide) {
        neighbour |= 1U << static_cast<unsigned>(axis);
        at[axis] += at[axis] < 0 ? kSide : -kSide;
      }
    }
    return neighbour;
  }

  // Whether the surface is between two seen voxels.
  bool HasSurface(const Voxel& a, const Voxel& b) const {
    return (a.distance < 0.0F) != (b.distance < 0.0F) && std::abs(a.distance - b.distance) < limit_;
  }

  void MakeVertices(size_t block) {
    Part& part = parts_[block];
    part.vertex.fill(kNone);
    const Eight behind = NeighboursOf(block, 1);
    Eigen::Vector3i at;
    for (at.z() = 0; at.z() < kSide; ++at.z()) {
      for (at.y() = 0; at.y() < kSide; ++at.y()) {
        for (at.x() = 0; at.x() < kSide; ++at.x()) {
          MakeVertex(*blocks_[block], behind, at, part);
        }
      }
    }
  }

  void MakeVertex(const Block& block, const Eight& behind, const Eigen::Vector3i& at, Part& part) {
    std::array<const Voxel*, 8> corners{};
    for (unsigned i = 0; i < 8; ++i) {
      corners[i] = VoxelAt(behind, at + Corner(i));
    }
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    Eigen::Vector3f colour = Eigen::Vector3f::Zero();
    float count = 0.0F;
    for (unsigned i = 0; i < 8; ++i) {
      for (unsigned axis = 0; axis < 3; ++axis) {
        const unsigned other = i | (1U << axis);
        if (other == i || corners[i] == nullptr || corners[other] == nullptr ||
            !HasSurface(*corners[i], *corners[other])) {
          continue;
        }
        const float share =
            corners[i]->distance / (corners[i]->distance - corners[other]->distance);
        Eigen::Vector3f zero = Corner(i).cast<float>();
        zero[axis] += share;
        sum += zero;
        colour += MixColours(*corners[i], *corners[other], share);
        count += 1.0F;
      }
    }
    if (count < kLeastEdges) {
      return;
    }
    part.vertex[IndexOf(at)] = static_cast<uint32_t>(part.positions.size());
    part.positions.push_back(static_cast<float>(volume_.voxel()) *
                             ((kSide * block.place + at).cast<float>() + sum / count));
    const auto channel = [&](int i) {
      return static_cast<uint8_t>(
          std::lround(std::clamp(colour[i] / count / 256.0F, 0.0F, 255.0F)));
    };
    part.colours.push_back({channel(0), channel(1), channel(2)});
  }

  // The colour between two voxels, of which at least one is near a surface and has a colour.
  static Eigen::Vector3f MixColours(const Voxel& a, const Voxel& b, float share) {
    const auto colour = [](const Voxel& voxel) {
      return Eigen::Vector3f(voxel.colour[0], voxel.colour[1], voxel.colour[2]);
    };
    if (a.has_colour == 0 || b.has_colour == 0) {
      return colour(a.has_colour != 0 ? a : b);
    }
    return (1.0F - share) * colour(a) + share * colour(b);
  }

  void MakeTriangles(size_t block) {
    const Eight behind = NeighboursOf(block, 1);
    const Eight before = NeighboursOf(block, -1);
    Eigen::Vector3i at;
    for (at.z() = 0; at.z() < kSide; ++at.z()) {
      for (at.y() = 0; at.y() < kSide; ++at.y()) {
        for (at.x() = 0; at.x() < kSide; ++at.x()) {
          const Voxel& voxel = blocks_[block]->voxels[IndexOf(at)];
          for (int axis = 0; axis < 3 && voxel.weight > 0.0F; ++axis) {
            const Voxel* const next = VoxelAt(behind, at + Eigen::Vector3i::Unit(axis));
            if (next != nullptr && HasSurface(voxel, *next)) {
              JoinCells(before, at, axis, voxel.distance < 0.0F, parts_[block].triangles);
            }
          }
        }
      }
    }
  }

  // Joins the four cells around an edge. Seen from its end they are in anticlockwise order; the
  // front of the surface is there if `is_front_at_end`.
  void JoinCells(const Eight& before, const Eigen::Vector3i& at, int axis, bool is_front_at_end,
                 std::vector<TriangleMesh::Triangle>& triangles) const {
    const Eigen::Vector3i b = Eigen::Vector3i::Unit((axis + 1) % 3);
    const Eigen::Vector3i c = Eigen::Vector3i::Unit((axis + 2) % 3);
    std::array<uint32_t, 4> v = {VertexAt(before, at - b - c), VertexAt(before, at - c),
                                 VertexAt(before, at), VertexAt(before, at - b)};
    if (std::ranges::count(v, kNone) > 0) {
      return;
    }
    if (!is_front_at_end) {
      std::swap(v[1], v[3]);
    }
    triangles.push_back({v[0], v[1], v[2]});
    triangles.push_back({v[0], v[2], v[3]});
  }

  const VoxelVolume& volume_;
  TaskRunner& runner_;
  float limit_;                       // m
  std::vector<const Block*> blocks_;  // sorted by their places
  std::vector<Part> parts_;           // one per block
};

// The representative of a vertex in a forest of sets.
uint32_t RootOf(uint32_t vertex, std::vector<uint32_t>& parents) {
  while (parents[vertex] != vertex) {
    parents[vertex] = parents[parents[vertex]];
    vertex = parents[vertex];
  }
  return vertex;
}

}  // namespace

SurfaceMesh ExtractSurface(const VoxelVolume& volume, TaskRunner& runner) {
  return Extraction(volume, runner).Run();
}

SurfaceMesh WithoutSmallParts(const SurfaceMesh& surface, size_t least) {
  std::vector<uint32_t> parents(surface.positions.size());
  std::iota(parents.begin(), parents.end(), 0U);
  for (const TriangleMesh::Triangle& triangle : surface.triangles) {
    const uint32_t root = RootOf(triangle[0], parents);
    parents[RootOf(triangle[1], parents)] = root;
    parents[RootOf(triangle[2], parents)] = root;
  }
  std::vector<size_t> sizes(parents.size());
  for (const TriangleMesh::Triangle& triangle : surface.triangles) {
    ++sizes[RootOf(triangle[0], parents)];
  }
  SurfaceMesh kept;
  std::vector<uint32_t> places(parents.size(), kNone);
  for (uint32_t i = 0; i < parents.size(); ++i) {
    if (const size_t size = sizes[RootOf(i, parents)]; size > 0 && size >= least) {
      places[i] = static_cast<uint32_t>(kept.positions.size());
      kept.positions.push_back(surface.positions[i]);
      kept.colours.push_back(surface.colours[i]);
    }
  }
  for (const TriangleMesh::Triangle& triangle : surface.triangles) {
    if (places[triangle[0]] != kNone) {
      kept.triangles.push_back({places[triangle[0]], places[triangle[1]], places[triangle[2]]});
    }
  }
  return kept;
}

}  // namespace hullslam
