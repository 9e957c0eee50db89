// Random field and study: keys, units, ranges. Defaults are those of the structs.

#include <cstdint>

#include "case/sections.hpp"
#include "random_field/marginals.hpp"

namespace talus {
namespace {

constexpr Quantity length{"m", 0.0, 1e6, true};
constexpr Quantity coordinate{"m", -1e6, 1e6};
constexpr double most_exact_integer = 9007199254740991.0;  // 2^53 - 1: what every reader of JSON keeps exact

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
  const bool x_given = in.find("correlation_length_x_m") != nullptr,
             y_given = in.find("correlation_length_y_m") != nullptr;
  const bool both_given = in.find("correlation_length_m") != nullptr;
  if (both_given && (x_given || y_given)) {
    in.fault("correlation_length_m", "is given beside correlation_length_x_m or correlation_length_y_m; give one form");
  } else if (x_given || y_given) {
    spec.ell_x = in.number("correlation_length_x_m", length);
    spec.ell_y = in.number("correlation_length_y_m", length);
  } else {
    spec.ell_x = spec.ell_y = in.number("correlation_length_m", length);
  }
}

/// Either the mean and standard deviation of ln(tan phi), or the mean and coefficient of variation of tan(phi). Without
/// a mean the median is that of the material.
void read_marginal(ObjectReader& in, FieldSpec& spec) {
  const auto log_mean = in.maybe_number("log_mean", {"", -20.0, 5.0});
  const auto mean = in.maybe_number("mean_tan_phi", {"", 0.0, 100.0, true});
  const bool log_form = in.find("log_stdev") != nullptr || in.find("log_mean") != nullptr;
  const bool tan_form = in.find("cov_tan_phi") != nullptr || in.find("mean_tan_phi") != nullptr;
  if (log_form && tan_form) {
    in.fault("", "mixes log_mean, log_stdev with mean_tan_phi, cov_tan_phi; give one pair");
  } else if (!log_form && !tan_form) {
    in.fault("log_stdev", "is missing (or cov_tan_phi): how much the friction angle varies");
  } else if (tan_form) {
    const double cov = in.number("cov_tan_phi", {"", 0.0, 10.0});
    const LogParameters log = log_parameters({mean.value_or(1.0), cov});
    spec.sigma = log.sigma;
    if (mean) spec.mu = log.mu;
  } else {
    spec.sigma = in.number("log_stdev", {"", -5.0, 5.0});
    spec.mu = log_mean;
  }
}

/// [lo, hi] with lo < hi
std::optional<std::vector<double>> read_extent(ObjectReader& in, std::string_view key) {
  const bool given = in.find(key) != nullptr;
  const std::vector<double> extent = in.numbers(key, coordinate, 2);
  if (extent.size() == 2 && extent[0] < extent[1]) return extent;
  if (!given || in.faults().none_under(in.pointer(key)))
    in.fault(key, given ? "is not [low, high] with low < high" : "is missing; [low, high] in metres");
  return {};
}

std::optional<Box> read_domain(ObjectReader& in) {
  const Json* value = in.find("domain_m");
  if (value == nullptr) return {};
  ObjectReader domain(*value, in.pointer("domain_m"), in.faults());
  const auto x = read_extent(domain, "x"), y = read_extent(domain, "y");
  in.record("domain_m", domain.finish());
  if (!x || !y) return {};
  return Box{{(*x)[0], (*y)[0]}, {(*x)[1], (*y)[1]}};
}

}  // namespace

FieldSpec read_field(ObjectReader in, Json& resolved) {
  FieldSpec spec;
  read_correlation(in, spec);
  read_marginal(in, spec);
  spec.direction = in.choice("direction", directions, spec.direction);
  spec.sampler = in.choice("sampler", samplers, spec.sampler);
  spec.truncation = in.choice("truncation", truncations, spec.truncation);
  spec.terms = static_cast<int>(in.integer("terms", {"", 1.0, 1e6}, spec.terms));
  spec.variance_share = in.number("variance_share", {"", 0.0, 1.0, true, true}, spec.variance_share);
  spec.root_intervals = in.choice("root_intervals", intervals, spec.root_intervals);
  spec.cell_average = in.flag("cell_average", spec.cell_average);
  spec.domain = read_domain(in);
  spec.xi = in.numbers("xi", {"", -40.0, 40.0}, 1'000'000);
  spec.grid_spacing = in.maybe_number("grid_spacing_m", length);
  resolved = in.finish();
  return spec;
}

StudySpec read_study(ObjectReader in, Json& resolved) {
  StudySpec s;
  s.realizations = in.integer("realizations", {"", 1.0, 1e9}, s.realizations);
  if (const auto seed = in.maybe_integer("seed", {"", 0.0, most_exact_integer}))
    s.seed = static_cast<std::uint64_t>(*seed);
  s.noise_floor_replicates =
      static_cast<int>(in.integer("noise_floor_replicates", {"", 0.0, 1000.0}, s.noise_floor_replicates));
  s.sampling = in.choice("sampling", samplings, s.sampling);
  s.stratified_modes = static_cast<int>(in.integer("stratified_modes", {"", 1.0, 10'000.0}, s.stratified_modes));
  s.stop_half_width = in.maybe_number("stop_when_ci_half_width_below_m", length);
  s.max_failed_share = in.number("max_failed_share", {"", 0.0, 1.0}, s.max_failed_share);
  s.histogram_edges = in.numbers("histogram_edges_m", coordinate, 10'000);
  if (s.histogram_edges.size() == 1) in.fault("histogram_edges_m", "has one edge; give at least two, or none");
  for (std::size_t k = 1; k < s.histogram_edges.size(); ++k)
    if (s.histogram_edges[k] <= s.histogram_edges[k - 1])
      in.faults().add(pointer_to(in.pointer("histogram_edges_m"), k), "does not exceed the edge before it");
  resolved = in.finish();
  return s;
}

}  // namespace talus
