#include "cli/version.hpp"

#include "sph/pair_loops.hpp"

namespace talus::cli {

std::string version() { return TALUS_VERSION; }

std::string version_text() {
  return "talus " + version() + "\ncompiler: " + TALUS_COMPILER + "\npair loops: " + pair_loops_target() +
         " on this processor, chosen at run time";
}

}  // namespace talus::cli
