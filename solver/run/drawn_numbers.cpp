#include "run/drawn_numbers.hpp"

#include "run/friction_field.hpp"
#include "run/property_draw.hpp"

namespace talus {
namespace {

/// @param modes  of a field
std::int64_t ordered(const FieldSpec& spec, std::size_t modes) {
  return spec.sampler == FieldSampler::karhunen_loeve ? static_cast<std::int64_t>(modes) : 0;
}

DrawnNumbers of_block(const PropertyBlock& block, const PropertyFields& fields, const Case& problem) {
  const PropertySpec& property = fields.laws().spec(block.property);
  DrawnNumbers draws{.name = std::string(name_of(property.property).key), .key = block.key, .count = 1};
  if (block.layer) draws.name += " of " + problem.model.materials[*block.layer].name;
  if (property.in_space()) draws.count = ordered(*problem.field, fields.modes());
  return draws;
}

}  // namespace

std::vector<DrawnNumbers> drawn_numbers(const Case& problem) {
  const std::optional<FieldSpec>& field = problem.field;
  if (!field || !field->random()) return {};
  std::vector<DrawnNumbers> draws;
  if (field->properties.empty()) {
    draws.push_back({.name = std::string(name_of(Property::friction).key)});
    draws.back().count = ordered(*field, make_field(problem.model, *field).modes());
    return draws;
  }
  const PropertyFields fields = property_fields(problem.model, *field);
  for (const PropertyBlock& block : fields.blocks()) draws.push_back(of_block(block, fields, problem));
  return draws;
}

void add_missing_draws(Plan& plan, const LoadedCase& loaded) {
  if (plan.draws.empty() && plan.study.sampling == Sampling::monte_carlo && plan.of.hash == loaded.hash)
    plan.draws = drawn_numbers(loaded.value);
}

}  // namespace talus
