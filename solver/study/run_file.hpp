#pragma once
// What a study reads of the result.json of one of its runs (schemas/result.schema.json).

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "study/record.hpp"

namespace talus {

struct RunFile {
  Record record;                            ///< done
  bool interrupted = false;                 ///< the run did not come to its end
  std::uint64_t seed = 0;                   ///< of the random field
  std::optional<std::int64_t> realization;  ///< unset: a run without random numbers
  bool perturbed = false;                   ///< a replicate that measures the numerical noise
  std::string case_hash;
};

/// Reads the result of the run with this index; keys that it does not know are passed over.
/// @throws IoError naming the file: it cannot be read, or is not the result of a run
RunFile read_run_file(const std::filesystem::path& file, std::int64_t index);

}  // namespace talus
