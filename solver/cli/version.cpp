#include "cli/version.hpp"

#include <hwy/highway.h>
#include <hwy/targets.h>

#include <bit>

namespace talus::cli {

std::string version() { return TALUS_VERSION; }

std::string version_text() {
  // The best target is the lowest bit that the processor supports.
  const auto supported = hwy::SupportedTargets();
  const auto best = supported & -supported;
  return "talus " + version() + "\ncompiler: " + TALUS_COMPILER + "\nprocessor: " + hwy::TargetName(best) +
         "\npair loops: compiled for " + hwy::TargetName(HWY_STATIC_TARGET);
}

}  // namespace talus::cli
