#pragma once
// Neighbours of clusters: as many particles as a vector has lanes, close to each other, share one list of the particles
// that may come near any of them (after Pall & Hess 2013). One vector then holds one value of all particles of a
// cluster, and each particle sums its neighbours in ascending order whatever the width of the vector.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "neighbours/cell_list.hpp"

namespace talus {

/// Cuts places in cell order into clusters of up to `lanes`; no cluster reaches over the end of a row of cells.
/// @returns first place of each cluster, and one more: the number of places
std::vector<std::uint32_t> clusters(const CellList& cells, std::size_t lanes);

/// For each cluster the places of the particles to sum over, ascending.
struct ClusterList {
  /// Clusters whose lists a thread makes at a time, one after the other in memory.
  static constexpr std::size_t batch_size = 32;
  /// Each list is filled up to a multiple of it with a place where nothing is, and so many more stand behind the last.
  static constexpr std::size_t block = 2;

  struct Batch {
    std::vector<std::uint32_t> places;
    std::array<std::uint32_t, batch_size + 1> at;  ///< where each cluster's part of `places` begins
  };
  std::vector<Batch> batches;

  /// For the clusters of `first`, as clusters() returns them.
  void resize(std::span<const std::uint32_t> first) { batches.resize((first.size() + batch_size - 2) / batch_size); }
};

}  // namespace talus
