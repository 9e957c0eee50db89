#pragma once

#include "particles/particles.hpp"

namespace talus {

/// Calls f(name, array) for every array of doubles of the soil.
template <class S, class F>
void for_each_real(S& s, F&& f) {
  for_each_state(s, f);
  for_each_rate(s, f);
  for_each_derived(s, f);
}

}  // namespace talus
