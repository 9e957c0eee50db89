#include "case/study_plan.hpp"

namespace talus {

Plan make_plan(const LoadedCase& loaded, std::uint64_t seed, const std::string& version) {
  const Case& c = loaded.value;
  if (c.study.realizations > 1) {
    const char* same = "every realization would be the same: ";
    if (!c.field) throw ConfigError("/random_field", std::string(same) + "a study needs a random field");
    if (c.field->sigma == 0.0)
      throw ConfigError("/random_field", std::string(same) + "the standard deviation of the field is 0");
    if (!c.field->xi.empty())
      throw ConfigError("/random_field/xi", std::string(same) + "the coefficients are given; remove them to draw");
  }
  if (c.study.sampling == Sampling::latin_hypercube && c.study.stop_half_width)
    throw ConfigError(
        "/study/stop_when_ci_half_width_below_m",
        "a Latin hypercube is one sample of a fixed size and cannot stop early; use monte_carlo or remove this");
  return {.title = c.title, .case_hash = loaded.hash, .version = version, .seed = seed, .study = c.study};
}

}  // namespace talus
