#pragma once
// Checkpoints: a CheckpointState on disk, read back complete and undamaged or refused. Not thread-safe (HDF5).
//
// A file begins with a block of 512 bytes of text (what it is, its length, the checksum of what follows), then comes
// HDF5: it is checked before HDF5 sees it, and h5dump and h5py read it all the same, since HDF5 lets others use the
// first 512 bytes of a file ("user block").

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "simulation/checkpoint_state.hpp"

namespace talus {

/// Which run a checkpoint belongs to: only the same run may continue from it.
struct CheckpointHeader {
  std::string talus_version;  ///< another version may compute other bits
  std::string case_hash;      ///< LoadedCase::hash
  std::uint64_t seed = 0;
  std::optional<std::int64_t> realization;  ///< unset: the deterministic case
  std::optional<double> perturbation;       ///< relative change of tan(phi) of a noise-floor replicate [-]
  bool operator==(const CheckpointHeader&) const = default;
};

/// Writes a checkpoint atomically. Every number is restored bit for bit.
/// @throws IoError naming the path; an older checkpoint is then untouched
/// @throws std::invalid_argument when an array has no name, or one that HDF5 cannot store ('/', '.')
void write_checkpoint(const std::filesystem::path& path, const CheckpointState& state, const CheckpointHeader& header);

/// Reads a checkpoint of the run that `expected` describes.
/// @throws IoError naming the path: missing, no checkpoint, truncated, damaged, or of another run (and what differs)
CheckpointState read_checkpoint(const std::filesystem::path& path, const CheckpointHeader& expected);

}  // namespace talus
