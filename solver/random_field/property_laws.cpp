#include "random_field/property_laws.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "math/angle.hpp"
#include "random_field/nataf.hpp"
#include "support/error.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

const char* const correlation_pointer = "/random_field/correlation";

std::string pair_name(Property a, Property b) {
  return std::string(name_of(a).key) + " and " + std::string(name_of(b).key);
}

/// The place of a property in the list, if it is there.
std::optional<std::size_t> place_of(Property p, std::span<const PropertySpec> specs) {
  const auto at = std::ranges::find(specs, p, &PropertySpec::property);
  if (at == specs.end()) return std::nullopt;
  return static_cast<std::size_t>(at - specs.begin());
}

/// Three decimals, towards 0: a matrix stays positive definite.
double shortened(double rho) { return std::trunc(rho * 1e3) / 1e3; }

}  // namespace

std::string property_pointer(Property p) { return "/random_field/properties/" + std::string(name_of(p).key); }

PropertyLaws::PropertyLaws(const FieldSpec& spec, std::span<const FieldMaterial> materials) : specs_(spec.properties) {
  std::vector<Fault> faults;
  make_marginals(materials, faults);
  check_pairs(spec, faults);
  if (!faults.empty()) throw ConfigError(faults);
  CorrelationMatrix wanted(size());
  for (const PropertyCorrelation& c : spec.correlation)
    wanted.set(*place_of(c.a, specs_), *place_of(c.b, specs_), c.value);
  if (!wanted.positive_definite())
    throw ConfigError(correlation_pointer, "is impossible: the matrix is not positive definite; the nearest that is: " +
                                               listed(wanted.nearest_valid()));
  make_factors(wanted, materials, faults);
  if (!faults.empty()) throw ConfigError(faults);
}

void PropertyLaws::make_marginals(std::span<const FieldMaterial> materials, std::vector<Fault>& faults) {
  for (const FieldMaterial& material : materials)
    for (const PropertySpec& p : specs_) {
      applies_.push_back(material.takes(p));
      Marginal& marginal = marginals_.emplace_back();
      if (!applies_.back() || !material.used) continue;
      try {
        marginal = make_marginal(p, material.values[index_of(p.property)]);
      } catch (const std::domain_error& e) {
        faults.push_back(
            {property_pointer(p.property), std::string(e.what()) + " (material " + in_quotes(material.name) + ")"});
      }
    }
  for (const PropertySpec& p : specs_) {
    if (std::ranges::any_of(materials, [&](const FieldMaterial& m) { return m.used && m.takes(p); })) continue;
    if (std::ranges::any_of(materials, [&](const FieldMaterial& m) { return m.used && p.applies_to(m.name); })) {
      faults.push_back(
          {property_pointer(p.property),
           "varies friction in undrained soil, which has none (phi = 0): " +
               (p.material.empty() ? "every material is undrained" : in_quotes(p.material) + " is undrained") +
               "; remove it, or vary cohesion, which is the undrained "
               "strength there"});
      continue;
    }
    std::string names;
    for (const FieldMaterial& m : materials)
      if (m.used) names += (names.empty() ? "" : ", ") + m.name;
    faults.push_back({property_pointer(p.property) + "/material",
                      in_quotes(p.material) + " is not the name of a material of the slide; they are: " + names});
  }
}

void PropertyLaws::check_pairs(const FieldSpec& spec, std::vector<Fault>& faults) const {
  for (std::size_t k = 0; k < spec.correlation.size(); ++k) {
    const PropertyCorrelation& c = spec.correlation[k];
    const std::string at = std::string(correlation_pointer) + "/" + std::to_string(k);
    const auto a = place_of(c.a, specs_), b = place_of(c.b, specs_);
    for (const auto& [place, property] : {std::pair(a, c.a), std::pair(b, c.b)})
      if (!place || !specs_[*place].random())
        faults.push_back(
            {at + "/between", std::string(name_of(property).key) + " is not a random property of this case"});
    if (!a || !b) continue;
    const PropertySpec &p = specs_[*a], &q = specs_[*b];
    if (p.random() && q.random() && (p.varies != q.varies || p.layers != q.layers))
      faults.push_back({at, pair_name(c.a, c.b) + " can be correlated only if they have the same varies and layers"});
  }
}

void PropertyLaws::make_factors(const CorrelationMatrix& wanted, std::span<const FieldMaterial> materials,
                                std::vector<Fault>& faults) {
  for (std::size_t m = 0; m < materials.size(); ++m) {
    CorrelationMatrix gaussian(size());
    for (std::size_t i = 0; i < size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const bool both = materials[m].used && applies(i, m) && applies(j, m);
        if (!both || wanted(i, j) == 0.0 || marginal(i, m).stdev == 0.0 || marginal(j, m).stdev == 0.0) continue;
        try {
          gaussian.set(i, j, gaussian_correlation(marginal(i, m), marginal(j, m), wanted(i, j)));
        } catch (const std::domain_error& e) {
          faults.push_back({correlation_pointer, "the correlation " + to_text(wanted(i, j)) + " of " +
                                                     pair_name(specs_[j].property, specs_[i].property) + " " +
                                                     e.what()});
        }
      }
    if (!faults.empty()) return;
    if (!gaussian.positive_definite()) {
      CorrelationMatrix nearest = gaussian.nearest_valid();
      for (std::size_t i = 0; i < size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
          if (nearest(i, j) != 0.0 && marginal(i, m).stdev > 0.0 && marginal(j, m).stdev > 0.0)
            nearest.set(i, j, correlation_after_marginals(marginal(i, m), marginal(j, m), nearest(i, j)));
      faults.push_back({correlation_pointer,
                        "cannot be reached with these distributions: the correlations of the normal numbers beneath "
                        "them are not positive definite; the nearest that can: " +
                            listed(nearest)});
      return;
    }
    factors_.push_back(gaussian.lower_factor());
  }
}

std::string PropertyLaws::unmet(const PropertyDatum& datum) const {
  const PropertySpec& p = specs_[datum.property];
  const std::string name(name_of(p.property).key);
  if (!p.in_space()) return "cannot be met: " + name + " does not vary in space";
  if (!applies(datum.property, datum.material))
    return "cannot be met: " + name + " is not random in the material there; properties." + name + ".material is " +
           in_quotes(p.material);
  const Marginal& m = marginal(datum.property, datum.material);
  if (m.stdev == 0.0) return "cannot be met: the standard deviation of " + name + " is 0 there";
  const double low = m.value(-farthest), high = m.value(farthest);
  if (datum.value > low && datum.value < high) return "";
  const auto shown = [&](double value) {
    if (p.property == Property::friction) return rounded(degrees(std::atan(value))) + " deg";
    return rounded(value / name_of(p.property).factor) + " " + std::string(name_of(p.property).unit);
  };
  return "cannot be met: " + shown(datum.value) + " lies outside the distribution of " + name + ", " + shown(low) +
         " to " + shown(high) + "; give another distribution, or leave the datum out";
}

std::string PropertyLaws::listed(const CorrelationMatrix& matrix) const {
  std::string text;
  for (std::size_t i = 0; i < size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (matrix(i, j) != 0.0)
        text += (text.empty() ? "" : ", ") + pair_name(specs_[j].property, specs_[i].property) + " " +
                to_text(shortened(matrix(i, j)));
  return text;
}

}  // namespace talus
