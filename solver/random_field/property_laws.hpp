#pragma once
// How the random properties of a soil are distributed together, in each of its materials.

#include <span>
#include <string>
#include <vector>

#include "random_field/correlation_matrix.hpp"
#include "random_field/field_spec.hpp"
#include "random_field/marginal.hpp"
#include "support/error.hpp"

namespace talus {

/// A material as the random field sees it.
struct FieldMaterial {
  std::string name;
  PropertyValues values{};  ///< what it says without a random field
  bool used = true;         ///< some soil is made of it
  bool undrained = false;   ///< its cohesion is the undrained strength, and it has no friction

  /// Whether a property is random, or constant, in this material.
  bool takes(const PropertySpec& p) const {
    return p.applies_to(name) && !(undrained && p.property == Property::friction);
  }
};

/// A measured value of a random property, in the units of PropertyValues.
struct PropertyDatum {
  std::size_t property = 0;  ///< place in FieldSpec::properties
  std::size_t material = 0;  ///< that it was measured in
  Vec2 x;                    ///< where [m]
  double value = 0.0;
  double error = 0.0;  ///< its standard error, >= 0; 0: exact
};

/// Where the properties of a case are faulty: "/random_field/properties/cohesion".
std::string property_pointer(Property p);

/// Marginals and correlations of FieldSpec::properties in every material. Immutable.
class PropertyLaws {
 public:
  /// @throws ConfigError with every fault: a distribution that does not exist, a property without a material, a matrix
  ///         of correlations that is not positive definite (the nearest valid one is named) or that the distributions
  ///         cannot reach
  PropertyLaws(const FieldSpec& spec, std::span<const FieldMaterial> materials);

  std::size_t size() const { return specs_.size(); }  ///< number of properties
  const PropertySpec& spec(std::size_t k) const { return specs_[k]; }
  /// Whether the k-th property is random, or constant, in this material.
  bool applies(std::size_t k, std::size_t material) const { return applies_[material * size() + k]; }
  /// Distribution of the k-th property; it applies there.
  const Marginal& marginal(std::size_t k, std::size_t material) const { return marginals_[material * size() + k]; }
  /// Why no realization could meet a datum, for a fault; empty where they can.
  std::string unmet(const PropertyDatum& datum) const;
  /// Row k of the lower triangle L with Z = L W: correlated standard normal numbers from independent ones.
  std::span<const double> mixing(std::size_t k, std::size_t material) const {
    return std::span(factors_[material]).subspan(k * size(), size());
  }

 private:
  void make_marginals(std::span<const FieldMaterial> materials, std::vector<Fault>& faults);
  void check_pairs(const FieldSpec& spec, std::vector<Fault>& faults) const;
  void make_factors(const CorrelationMatrix& wanted, std::span<const FieldMaterial> materials,
                    std::vector<Fault>& faults);
  std::string listed(const CorrelationMatrix& matrix) const;

  std::vector<PropertySpec> specs_;
  std::vector<char> applies_;                 ///< [material][property]
  std::vector<Marginal> marginals_;           ///< the same
  std::vector<std::vector<double>> factors_;  ///< [material], row-major
};

}  // namespace talus
