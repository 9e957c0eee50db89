// Numbers within their ranges that together ask for more than any run can do.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "case/sections.hpp"
#include "particles/geometry.hpp"
#include "simulation/particle_setup.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

/// Of a run. A step takes about 0.1 ms with 1,000 particles, so 1e9 steps take more than a day for a coarse case and
/// more than a year for one of 1e6 particles. The shipped cases take 1e3 to 1e5.
constexpr double most_steps = 1e9;

/// Along one axis, the most that random_field.terms may ask for.
constexpr double most_modes = 1e6;

/// The key that makes the steps so short: one that sets the step itself, else the one whose default would do.
std::string key_of_short_step(const Model& model, double step, double steps) {
  if (model.time.fixed_step) return "/time/fixed_step_s";
  if (model.time.max_step && step == *model.time.max_step) return "/time/max_step_s";
  return steps * model.numerics.cfl / Numerics{}.cfl <= most_steps ? "/numerics/cfl" : "/time/end_s";
}

/// The least length with which half of the variance of an exponential covariance takes at most `most_modes` modes along
/// an extent L: the eigenvalue of the frequency w is 2 l/(1 + w^2 l^2), half of their sum lies below w = 1/l, and the
/// frequencies lie pi/L apart.
double least_correlation_length(double extent) { return extent / (std::numbers::pi * most_modes); }

void check_correlation(double length, double extent, const char* axis, Faults& faults) {
  const double least = least_correlation_length(extent);
  if (length >= least) return;
  faults.add("/random_field", "a correlation length of " + rounded(length) + " m along " + axis + " is too short for " +
                                  rounded(extent) + " m of slide: half of the variance would take " +
                                  rounded(extent / (std::numbers::pi * length)) + " modes along it; at most " +
                                  rounded(most_modes) + " are allowed, that is a length of at least " + rounded(least) +
                                  " m");
}

}  // namespace

void check_steps(const Model& model, Faults& faults) {
  const double step = first_step(model);
  const double steps = model.time.end / step;
  if (steps <= most_steps) return;
  const std::string key = key_of_short_step(model, step, steps);
  std::string message = "means " + rounded(steps) + " time steps of " + rounded(step) +
                        " s until end_s = " + rounded(model.time.end) + " s; at most " + rounded(most_steps) +
                        " are allowed, ";
  if (key == "/numerics/cfl")
    message += "that is a Courant number of at least " + rounded(model.numerics.cfl * steps / most_steps);
  else if (key == "/time/end_s")
    message += "that is an end of at most " + rounded(step * most_steps) +
               " s; spacing, speed of sound and viscosity bound the step";
  else
    message += "that is a step of at least " + rounded(model.time.end / most_steps) + " s";
  faults.add(key, message);
}

void check_modes(const Case& c, Faults& faults) {
  if (!c.field || (!c.field->properties.empty() && !c.field->in_space()) ||
      c.field->sampler != FieldSampler::karhunen_loeve)
    return;
  if (c.field->covariance != Covariance::exponential) return;  // their modes are counted where they are solved
  const Box domain = c.field->domain.value_or(bounding_box(c.model.slide));
  if (c.field->along_x()) check_correlation(c.field->ell_x, domain.width(), "x", faults);
  if (c.field->along_y()) check_correlation(c.field->ell_y, domain.height(), "y", faults);
}

}  // namespace talus
