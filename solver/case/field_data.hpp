#pragma once
// The measured values that a random field is conditioned on.

#include <filesystem>
#include <string>
#include <vector>

#include "case/reader.hpp"
#include "random_field/field_spec.hpp"

namespace talus {

/// Most data of one field: the kriging system of 1,000 takes a second.
inline constexpr std::size_t most_data = 1'000;

/// What a list of data holds.
struct Measured {
  Property property = Property::friction;
  std::string words;      ///< "friction angles"
  Quantity value, error;  ///< ranges in the unit of the list
};
inline const Measured measured_angles{
    Property::friction, "friction angles", {"deg", 0.0, 89.0, true}, {"deg", 0.0, 45.0}};

/// Data, and where each is written.
struct FieldData {
  std::vector<FieldDatum> values;
  std::vector<std::string> places = {};  ///< JSON pointer, or file and line
  Json rows = Json::array();             ///< [[x, y, value, error], ...] as written
  std::vector<std::string> forms = {};   ///< CSV only: the file, and columns, separator and decimals as they were read

  void append(const FieldData& other);
};

/// Declares and reads `data` or `data_csv`, whichever is there. Records them as `data`.
/// @param directory  where CSV files lie
/// @return no data when there was a fault, or neither key
FieldData read_field_data(ObjectReader& in, const std::filesystem::path& directory, const Measured& what);

/// "12 kPa", "31.5 deg": a value of a property as a case gives it, of the number that FieldDatum holds.
std::string in_words(double value, Property property);

/// Data lie in the rectangle of the field, and those on one property at one point agree: within 5 joint standard
/// errors.
void check_field_data(const FieldData& data, Box domain, Faults& faults);

}  // namespace talus
