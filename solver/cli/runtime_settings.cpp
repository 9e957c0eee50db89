#include "cli/runtime_settings.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>

namespace talus::cli {

void settle_runtime(char** argv) {
  const bool spins = std::getenv("GOMP_SPINCOUNT") == nullptr && std::getenv("OMP_WAIT_POLICY") == nullptr;
  const bool small_pages = std::getenv("GLIBC_TUNABLES") == nullptr;
  if (!spins && !small_pages) return;
  std::error_code failed;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", failed);
  if (failed) return;
  if (spins) setenv("GOMP_SPINCOUNT", "5000", 0);
  if (small_pages) setenv("GLIBC_TUNABLES", "glibc.malloc.hugetlb=1", 0);
  execv(program.c_str(), argv);
}

}  // namespace talus::cli
