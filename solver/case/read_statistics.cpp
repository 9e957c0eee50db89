// The keys of random_field and study. Defaults are those of the structs.

#include <algorithm>

#include "case/sections.hpp"
#include "case/vertices.hpp"
#include "math/angle.hpp"
#include "random_field/random_field.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

constexpr Quantity length{"m", 0.0, 1e6, true};
constexpr Quantity signed_log_stdev_range{"", -5.0, 5.0};
constexpr Quantity cov_tan_phi_range{"", 0.0, 10.0};

constexpr Names<FieldDirection> field_directions[] = {
    {"xy", FieldDirection::xy}, {"x", FieldDirection::x}, {"y", FieldDirection::y}};
constexpr Names<FieldSampler> samplers[] = {{"karhunen_loeve", FieldSampler::karhunen_loeve},
                                            {"circulant_embedding", FieldSampler::circulant_embedding}};
constexpr Names<Truncation> truncations[] = {{"largest", Truncation::largest},
                                             {"diagonal", Truncation::diagonal},
                                             {"variance_share", Truncation::variance_share}};
constexpr Names<RootIntervals> intervals[] = {{"complete", RootIntervals::complete}, {"paper", RootIntervals::paper}};
constexpr Names<Sampling> samplings[] = {{"monte_carlo", Sampling::monte_carlo},
                                         {"latin_hypercube", Sampling::latin_hypercube}};

constexpr Names<Covariance> covariances[] = {{"exponential", Covariance::exponential},
                                             {"exponential_isotropic", Covariance::exponential_isotropic},
                                             {"squared_exponential", Covariance::squared_exponential},
                                             {"matern_3_2", Covariance::matern_3_2},
                                             {"matern_5_2", Covariance::matern_5_2},
                                             {"cosine_exponential", Covariance::cosine_exponential}};

/// Lengths along x and y, given as one or as two.
struct Lengths {
  std::optional<double> both, x, y;
};

/// Declares and reads KEY_m, KEY_x_m and KEY_y_m.
Lengths read_lengths(ObjectReader& in, const std::string& key, const std::string& sentence, const std::string& source) {
  Lengths found;
  in.optional_number(key + "_m", found.both, length, {sentence + " along x and y.", source, "none"});
  in.optional_number(key + "_x_m", found.x, length,
                     {sentence + " along x, with a dip along the bedding.", source, "none"});
  in.optional_number(key + "_y_m", found.y, length,
                     {sentence + " along y, with a dip across the bedding.", source, "none"});
  return found;
}

/// Faults unless exactly one form of lengths is given, whole; none is needed where nothing varies in space.
void check_lengths(ObjectReader& in, bool needed) {
  using Keys = std::vector<std::string>;
  const Keys forms[] = {{"correlation_length_m"},
                        {"correlation_length_x_m", "correlation_length_y_m"},
                        {"scale_of_fluctuation_m"},
                        {"scale_of_fluctuation_x_m", "scale_of_fluctuation_y_m"}};
  const auto given = [&](const std::string& key) { return in.find(key) != nullptr; };
  std::vector<Keys> found;
  for (const Keys& form : forms)
    if (std::ranges::any_of(form, given)) found.push_back(form);
  if (found.empty() && !needed) return;
  if (found.empty()) found.push_back({"correlation_length_m"});
  if (found.size() > 1) {
    const std::string& first = *std::ranges::find_if(found[0], given);
    in.fault(first, "is given beside " + found[1].front() + (found[1].size() > 1 ? " or " + found[1].back() : "") +
                        "; give one form");
    return;
  }
  for (const std::string& key : found[0])
    if (!given(key)) in.fault(key, "is missing; " + length.describe());
}

void read_correlation(ObjectReader& in, FieldSpec& spec) {
  in.choice(
      "covariance", spec.covariance, covariances,
      {"Correlation of the normal field beneath a property, such as ln(tan phi), with r^2 = (dx/lx)^2 + (dy/ly)^2 and "
       "l the correlation length. exponential: "
       "exp(-|dx|/lx - |dy|/ly); exponential_isotropic: exp(-r); squared_exponential: exp(-r^2); matern_3_2: (1 + "
       "sqrt(3) r) exp(-sqrt(3) r); matern_5_2: (1 + sqrt(5) r + 5 r^2/3) exp(-sqrt(5) r); cosine_exponential: "
       "exp(-|dx|/lx - |dy|/ly) cos(dx/lx) cos(dy/ly).",
       "[Z20] Eq. 13; Vanmarcke 1983; Rasmussen & Williams 2006 for matern", "exponential"});
  if (spec.covariance == Covariance::exponential) in.remove_record("covariance");  // keeps the hash of earlier cases
  const Lengths ell = read_lengths(in, "correlation_length", "Correlation length", "site investigation; [Z20] Table 4");
  const Lengths theta =
      read_lengths(in, "scale_of_fluctuation",
                   "Scale of fluctuation, in place of the correlation length: 2 l for exponential and "
                   "exponential_isotropic, 1.772 l "
                   "for squared_exponential, 2.309 l for matern_3_2, 2.385 l for matern_5_2, l for cosine_exponential;",
                   "site investigation; Vanmarcke 1983");
  in.one_form({{{"correlation_length_m"}, {"properties"}},
               {{"correlation_length_x_m", "correlation_length_y_m"}, {"properties"}},
               {{"scale_of_fluctuation_m"}, {"properties"}},
               {{"scale_of_fluctuation_x_m", "scale_of_fluctuation_y_m"}, {"properties"}},
               {{"properties"}}});
  check_lengths(in, spec.properties.empty() || spec.in_space());
  const double factor = scale_of_fluctuation_factor(spec.covariance);
  const auto choose = [&](std::optional<double> own_ell, std::optional<double> own_theta, double fallback) {
    if (own_ell || ell.both) return own_ell ? *own_ell : *ell.both;
    if (own_theta || theta.both) return (own_theta ? *own_theta : *theta.both) / factor;
    return fallback;
  };
  spec.ell_x = choose(ell.x, theta.x, spec.ell_x);
  spec.ell_y = choose(ell.y, theta.y, spec.ell_y);
  double dip = 0.0;
  in.number("dip_deg", dip, {"deg", -90.0, 90.0},
            {"Angle by which the bedding falls towards +x: the axes of the correlation lengths, and of direction, are "
             "turned by it.",
             "geological mapping", "0"});
  spec.dip = radians(dip);
  if (dip == 0.0) in.remove_record("dip_deg");
  in.number("nugget", spec.nugget, {"", 0.0, 1.0, false, true},
            {"Share of the variance that varies from particle to particle without correlation. It is drawn for every "
             "particle, so that cell_average does not reduce it and another spacing draws other values.",
             "site investigation", "0"});
  if (spec.nugget == 0.0) in.remove_record("nugget");
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
  in.optional_number("log_stdev", stdev, signed_log_stdev_range,
                     {"Standard deviation of ln(tan phi); a negative one mirrors the draws, as [Z20] prints it.",
                      "[Z20] Eq. 12, Table 4", "none"});
  in.optional_number("cov_tan_phi", cov, cov_tan_phi_range,
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
    in.fault("cov_tan_phi", "is missing; " + cov_tan_phi_range.describe());
  } else if (log_form && !given("log_stdev")) {
    in.fault("log_stdev", "is missing; " + signed_log_stdev_range.describe());
  }
  spec.sigma = stdev.value_or(spec.sigma);
  if (cov) spec.sigma = log_stdev(*cov);
}

/// Particle spacings in a correlation length below which the field is averaged over cells by default.
constexpr double spacings_resolved = 4.0;

/// The shortest correlation length of the axes along which the field varies [m].
double shortest_length(const FieldSpec& spec) {
  if (!spec.along_y()) return spec.ell_x;
  return spec.along_x() ? std::min(spec.ell_x, spec.ell_y) : spec.ell_y;
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

void read_field(ObjectReader& in, FieldSpec& spec, double dx, const std::filesystem::path& directory,
                SourceLocations& origins) {
  read_properties(in, spec, directory, origins);
  read_correlation(in, spec);
  read_marginal(in, spec);
  in.choice("direction", spec.direction, field_directions, {"Axes along which the field varies.", "[Z20] Eqs. 11, 23"});
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
  const bool varies = spec.properties.empty() || spec.in_space();
  spec.cell_average = varies && shortest_length(spec) < spacings_resolved * dx * (1.0 - 1e-9);
  in.flag("cell_average", spec.cell_average,
          {"Average the field over each particle's cell (variance reduction).", "Vanmarcke 1983",
           "true where a correlation length is under four particle spacings"});
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
  const FieldData angles = read_field_data(in, directory, measured_angles);
  if (!angles.values.empty() &&
      std::ranges::count(origins.field_data.values, Property::friction, &FieldDatum::property))
    in.fault(in.find("data") != nullptr ? "data" : "data_csv",
             "is given beside properties.friction.data; give one list");
  origins.field_data.append(angles);
  spec.data = origins.field_data.values;
  std::ranges::copy(origins.field_data.forms, std::back_inserter(origins.files));
  double trend = 0.0;
  in.number(
      "trend_deg_per_m", trend, {"deg/m", -10.0, 10.0},
      {"Increase of the median friction angle with every metre below the ground surface before the slide; the "
       "angle at the surface is that of log_mean or the material (with mean_tan_phi: of the mean), with properties the "
       "median of friction, whose coefficient of variation stays.",
       "laboratory, soundings", "0"});
  spec.trend = radians(trend);
  if (trend == 0.0) in.remove_record("trend_deg_per_m");
}

namespace {

void read_hazard_class(ObjectReader& in, HazardClass& one) {
  const std::size_t before = in.faults().size();
  in.string("name", one.name, {1, 40}, {"Name of the class.", "hazard map"});
  in.optional_number("depth_m", one.depth, {"m", 0.0, 1e4, true},
                     {"Least peak depth of the flow.", "hazard map", "any"});
  in.optional_number("speed_m_s", one.speed, {"m/s", 0.0, 1e4, true},
                     {"Least peak depth-averaged speed.", "hazard map", "any"});
  in.optional_number("dynamic_pressure_Pa", one.dynamic_pressure, {"Pa", 0.0, 1e12, true},
                     {"Least peak dynamic pressure, density times speed squared.", "hazard map", "any"});
  if (!one.depth && !one.speed && !one.dynamic_pressure && in.faults().size() == before)
    in.fault("", "has no threshold; give depth_m, speed_m_s or dynamic_pressure_Pa");
}

}  // namespace

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
  in.objects("hazard_classes", {0, 20},
             {"Classes of hazard at the targets, from the weakest to the strongest. A run falls into the last class "
              "all of whose thresholds the flow at the target reaches, into none if it does not arrive.",
              "hazard map", "none"},
             "One class.", [&](ObjectReader& one) { read_hazard_class(one, s.hazard_classes.emplace_back()); });
  if (s.hazard_classes.empty()) in.remove_record("hazard_classes");
  if (s.histogram_edges.size() == 1) in.fault("histogram_edges_m", "has one edge; give at least two, or none");
  for (std::size_t k = 1; k < s.histogram_edges.size(); ++k)
    if (s.histogram_edges[k] <= s.histogram_edges[k - 1])
      in.faults().add(pointer_to(in.pointer("histogram_edges_m"), k), "does not exceed the edge before it");
}

}  // namespace talus
