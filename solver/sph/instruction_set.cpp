// Which instruction set the pair loops use.

#include "sph/pair_loops.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sph/instruction_set.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace talus::HWY_NAMESPACE {

const char* target_name() { return hwy::TargetName(HWY_TARGET); }

}  // namespace talus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace talus {

HWY_EXPORT(target_name);

bool limit_pair_loops(const std::string& name) {
#if HWY_ARCH_X86
  // The better a set, the lower its bit.
  if (name == "AVX2") hwy::DisableTargets(HWY_AVX2 - 1);
  if (name == "SSE4") hwy::DisableTargets(HWY_SSE4 - 1);
  return name == "AVX2" || name == "SSE4";
#else
  return name.empty();
#endif
}

const char* pair_loops_target() { return HWY_DYNAMIC_DISPATCH(target_name)(); }

}  // namespace talus
#endif
