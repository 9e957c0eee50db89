#include "figures/influence.hpp"

#include <algorithm>
#include <cmath>

#include "figures/charts.hpp"
#include "figures/ground.hpp"
#include "figures/profile.hpp"
#include "run/drawn_numbers.hpp"
#include "run/influence.hpp"
#include "simulation/particle_setup.hpp"
#include "study/summary.hpp"
#include "support/measures.hpp"

namespace talus::figures {
namespace {

namespace fs = std::filesystem;

/// "friction: 62 % [55, 69] of the variance of the front"
std::string share_text(const Plan& plan, const RegressionSummary& of, std::size_t block) {
  const auto percent = [](double share) { return fixed(100 * share, 0); };
  const VarianceShare& share = of.shares[block];
  return plan.draws[block].name + ": " + percent(share.value) + " % [" + percent(*share.ci95.lo) + ", " +
         percent(*share.ci95.hi) + "]";
}

/// The influence as a frame of the soil, 0 where its interval includes 0.
Frame frame_of(const Influence& influence, const std::vector<Vec2>& points) {
  Frame frame;
  frame.n_soil = points.size();
  frame.position = points;
  for (std::size_t i = 0; i < points.size(); ++i)
    frame.stdev.push_back(std::abs(influence.value[i]) > influence.half_width[i] ? influence.value[i] : 0.0);
  return frame;
}

/// Properties that are drawn once have no picture, but a share.
std::string others_text(const Plan& plan, const RegressionSummary& of) {
  std::string text;
  for (std::size_t block = 0; block < plan.draws.size(); ++block)
    if (plan.draws[block].count == 1) text += (text.empty() ? "; drawn once: " : ", ") + share_text(plan, of, block);
  return text;
}

/// The same range below and above 0, so that white is 0.
ColourRange range_of(const std::vector<Frame>& frames) {
  double most = 0.0;
  for (const Frame& frame : frames)
    for (const double value : frame.stdev) most = std::max(most, std::abs(value));
  return most > 0.0 ? ColourRange{-most, most} : ColourRange{-1.0, 1.0};
}

}  // namespace

std::vector<fs::path> plot_influence(const StudyFiles& study, Tables tables, const LoadedCase& of,
                                     const fs::path& name) {
  add_missing_draws(tables.plan, of);
  const RegressionSummary regression = summary_of(tables.plan, tables.runs, tables.floor).regression(leading_measure);
  if (!regression.done()) return {};
  const Model& model = of.value.model;
  std::vector<Vec2> points;
  for (const SoilPoint& point : plan_particles(model).soil) points.push_back(point.x);
  const std::vector<Influence> all = influence_at(of.value, points, tables.plan, regression);
  if (all.empty()) return {};
  std::vector<Frame> frames;
  for (const Influence& influence : all) frames.push_back(frame_of(influence, points));
  std::vector<Snapshot> shots;
  for (std::size_t k = 0; k < all.size(); ++k)
    shots.push_back({&frames[k], Colour::influence,
                     share_text(tables.plan, regression, all[k].block) + " of the variance of the front"});
  const Stamps stamps{study.title,
                      "Change of the 99 % front per standard deviation at a place; white: not distinct from 0" +
                          others_text(tables.plan, regression),
                      study.source + "  ·  " + count_text(study), study.quality};
  std::vector<fs::path> drawn;
  for (const char* ending : {".svg", ".png"})
    plot_profiles(shots, model.terrain, model.dx, drawn.emplace_back(fs::path(name).concat(ending)), stamps,
                  {.mark_front = false, .range = range_of(frames), .structures = structures_of(model)});
  return drawn;
}

}  // namespace talus::figures
