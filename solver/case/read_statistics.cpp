// The keys of random_field and study. Defaults are those of the structs.

#include "case/sections.hpp"
#include "case/vertices.hpp"
#include "random_field/random_field.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

constexpr Quantity length{"m", 0.0, 1e6, true};
constexpr Quantity log_stdev_range{"", -5.0, 5.0};
constexpr Quantity cov_range{"", 0.0, 10.0};

constexpr Names<FieldDirection> directions[] = {
    {"xy", FieldDirection::xy}, {"x", FieldDirection::x}, {"y", FieldDirection::y}};
constexpr Names<FieldSampler> samplers[] = {{"karhunen_loeve", FieldSampler::karhunen_loeve},
                                            {"circulant_embedding", FieldSampler::circulant_embedding}};
constexpr Names<Truncation> truncations[] = {{"largest", Truncation::largest},
                                             {"diagonal", Truncation::diagonal},
                                             {"variance_share", Truncation::variance_share}};
constexpr Names<RootIntervals> intervals[] = {{"complete", RootIntervals::complete}, {"paper", RootIntervals::paper}};
constexpr Names<Sampling> samplings[] = {{"monte_carlo", Sampling::monte_carlo},
                                         {"latin_hypercube", Sampling::latin_hypercube}};

void read_correlation(ObjectReader& in, FieldSpec& spec) {
  std::optional<double> both, x, y;
  in.optional_number("correlation_length_m", both, length,
                     {"Correlation length along x and y; half the scale of fluctuation.",
                      "site investigation; [Z20] Table 4", "none"});
  in.optional_number("correlation_length_x_m", x, length,
                     {"Correlation length along x.", "site investigation", "none"});
  in.optional_number("correlation_length_y_m", y, length,
                     {"Correlation length along y.", "site investigation", "none"});
  in.one_form({{{"correlation_length_m"}, {"properties"}},
               {{"correlation_length_x_m", "correlation_length_y_m"}, {"properties"}},
               {{"properties"}}});
  const auto given = [&](const char* key) { return in.find(key) != nullptr; };
  const bool one_axis = given("correlation_length_x_m") || given("correlation_length_y_m");
  const auto require = [&](const char* key) {
    if (!given(key)) in.fault(key, "is missing; " + length.describe());
  };
  if (given("correlation_length_m") && one_axis) {
    in.fault("correlation_length_m", "is given beside correlation_length_x_m or correlation_length_y_m; give one form");
  } else if (one_axis) {
    require("correlation_length_x_m");
    require("correlation_length_y_m");
  } else if (spec.properties.empty() || spec.in_space()) {
    require("correlation_length_m");
  }
  spec.ell_x = x.value_or(both.value_or(spec.ell_x));
  spec.ell_y = y.value_or(both.value_or(spec.ell_y));
}

/// Friction in short: either the mean and standard deviation of ln(tan phi), or the mean and coefficient of variation
/// of tan(phi). Without a mean the median is that of the material. Or properties, which have been read.
void read_marginal(ObjectReader& in, FieldSpec& spec) {
  std::optional<double> stdev, cov;
  in.optional_number("log_mean", spec.mu, {"", -20.0, 5.0},
                     {"Mean of ln(tan phi): the logarithm of the median.", "[Z20] Eq. 12, Table 4",
                      "ln(tan phi) of each particle's material"});
  in.optional_number("mean_tan_phi", spec.mean, {"", 0.0, 100.0, true},
                     {"Mean of tan(phi) itself, which the field has at every particle whatever its truncation and "
                      "averaging.",
                      "laboratory", "none: the median is that of the material"});
  in.optional_number("log_stdev", stdev, log_stdev_range,
                     {"Standard deviation of ln(tan phi); a negative one mirrors the draws, as [Z20] prints it.",
                      "[Z20] Eq. 12, Table 4", "none"});
  in.optional_number("cov_tan_phi", cov, cov_range,
                     {"Coefficient of variation of tan(phi) itself, of the whole field; truncation and averaging leave "
                      "less, which result.json states.",
                      "laboratory; 0.05 to 0.4 in soils", "none"});
  in.one_form({{{"log_stdev"}, {"log_mean"}}, {{"cov_tan_phi"}, {"mean_tan_phi"}}, {{"properties"}, {"correlation"}}});
  const auto given = [&](const char* key) { return in.find(key) != nullptr; };
  const bool log_form = given("log_stdev") || given("log_mean");
  const bool tan_form = given("cov_tan_phi") || given("mean_tan_phi");
  if (given("properties")) {
    for (const char* key : {"log_mean", "log_stdev", "mean_tan_phi", "cov_tan_phi"})
      if (given(key)) in.fault(key, "is given beside properties; state it under properties.friction");
  } else if (log_form && tan_form) {
    in.fault("", "mixes log_mean, log_stdev with mean_tan_phi, cov_tan_phi; give one pair");
  } else if (!log_form && !tan_form) {
    in.fault("log_stdev", "is missing (or cov_tan_phi, or properties): how much the friction angle varies");
  } else if (tan_form && !given("cov_tan_phi")) {
    in.fault("cov_tan_phi", "is missing; " + cov_range.describe());
  } else if (log_form && !given("log_stdev")) {
    in.fault("log_stdev", "is missing; " + log_stdev_range.describe());
  }
  spec.sigma = stdev.value_or(spec.sigma);
  if (cov) spec.sigma = log_stdev(*cov);
}

void read_domain(ObjectReader& in, std::optional<Box>& domain) {
  in.object("domain_m", "Rectangle for which the modes are solved. Default: bounding box of the slide; source: user.",
            Absent::skip, [&](ObjectReader& box) {
              std::vector<double> extents[2];
              const char* names[] = {"x", "y"};
              for (int axis = 0; axis < 2; ++axis) {
                std::vector<double>& extent = extents[axis];
                box.numbers(names[axis], extent, coordinate, {2, 2},
                            {axis == 0 ? "[low, high] along x." : "[low, high] along y.", "user", "", "low < high"});
                if (extent.size() == 2 && extent[0] >= extent[1])
                  box.fault(names[axis], "is not [low, high] with low < high");
              }
              const auto &x = extents[0], &y = extents[1];
              if (x.size() == 2 && y.size() == 2) domain = Box{{x[0], y[0]}, {x[1], y[1]}};
            });
}

}  // namespace

void read_field(ObjectReader& in, FieldSpec& spec) {
  read_properties(in, spec);
  read_correlation(in, spec);
  read_marginal(in, spec);
  in.choice("direction", spec.direction, directions, {"Axes along which the field varies.", "[Z20] Eqs. 11, 23"});
  in.choice("sampler", spec.sampler, samplers,
            {"karhunen_loeve: truncated expansion; circulant_embedding: the full variance, on a grid.",
             "[Z20] Eq. 11; Dietrich & Newsam 1997"});
  in.choice(
      "truncation", spec.truncation, truncations,
      {"Modes kept. largest: the terms modes of the largest eigenvalue products; diagonal: the first terms pairs of "
       "equal index; variance_share: as many as reach variance_share.",
       "[Z20] Eq. 11"});
  in.integer(
      "terms", spec.terms, {"", 1.0, 1e6},
      {"Number of modes M for truncation largest and diagonal; unused otherwise, with a warning.", "[Z20] section 3"});
  in.number("variance_share", spec.variance_share, {"", 0.0, 1.0, true, true},
            {"Share of the variance to reach with truncation variance_share; unused otherwise, with a warning."});
  in.choice("root_intervals", spec.root_intervals, intervals,
            {"complete: every mode once; paper: the printed intervals, which skip every other mode.",
             "[Z20] Eqs. 15, 21 for paper"});
  in.flag("cell_average", spec.cell_average,
          {"Average the field over each particle's cell (variance reduction).", "Vanmarcke 1983"});
  read_domain(in, spec.domain);
  in.numbers(
      "xi", spec.xi, {"", -40.0, 40.0}, {0, 1'000'000},
      {"Standard normal coefficients to use instead of drawn ones, one per mode; with properties those of friction, "
       "cohesion, unit_weight and viscosity in this order, one for a property that is drawn once; empty: drawn.",
       "[Z20] Table 2"});
  in.optional_number("grid_spacing_m", spec.grid_spacing, length,
                     {"Grid of the circulant embedding. It does not depend on the particle spacing, and a realization "
                      "is the same field at every spacing. Particles take the value of the nearest node.",
                      "numerical", "a tenth of the correlation length along each axis"});
}

void read_study(ObjectReader& in, StudySpec& s) {
  in.integer("realizations", s.realizations, {"", 1.0, 1e9}, {"Realizations planned.", "[Z20] section 4 uses 1000"});
  in.optional_integer("seed", s.seed, {"", 0.0, static_cast<double>(max_exact_integer)},
                      {"Key of all random numbers; realization i depends on seed and i alone.", "user",
                       "drawn at random, and recorded"});
  in.integer("noise_floor_replicates", s.noise_floor_replicates, {"", 0.0, 1000.0},
             {"Runs that differ from realization 0 by a relative 1e-6 of tan(phi), to measure the numerical noise.",
              "method"});
  in.choice("sampling", s.sampling, samplings,
            {"How the coefficients are drawn.", "McKay et al. 1979 for latin_hypercube"});
  in.integer("stratified_modes", s.stratified_modes, {"", 1.0, 10'000.0},
             {"Leading modes that latin_hypercube stratifies."});
  in.optional_number("stop_when_ci_half_width_below_m", s.stop_half_width, length,
                     {"Stop once the half width of the 95 % interval of the mean influence zone is below this.", "user",
                      "none, all realizations run"});
  in.number("max_failed_share", s.max_failed_share, {"", 0.0, 1.0},
            {"End the study when more than this share of its runs fail."});
  in.numbers("histogram_edges_m", s.histogram_edges, coordinate, {0, 10'000},
             {"Edges of the histogram, increasing; none: chosen from the data at round numbers.", "user", "",
              ">= -1e6 and <= 1e6, none or at least two"});
  if (s.histogram_edges.size() == 1) in.fault("histogram_edges_m", "has one edge; give at least two, or none");
  for (std::size_t k = 1; k < s.histogram_edges.size(); ++k)
    if (s.histogram_edges[k] <= s.histogram_edges[k - 1])
      in.faults().add(pointer_to(in.pointer("histogram_edges_m"), k), "does not exceed the edge before it");
}

}  // namespace talus
