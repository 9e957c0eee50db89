#include "case/field_data.hpp"

#include <algorithm>
#include <cmath>

#include "case/data_table.hpp"
#include "case/vertices.hpp"
#include "math/angle.hpp"
#include "random_field/conditioning.hpp"
#include "support/csv.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

constexpr double most_errors_apart = 5.0;  ///< of data at one point, in joint standard errors

/// A row of numbers as written: x, y, value and error.
using Row = std::array<double, 4>;

void add(FieldData& data, const Row& row, std::string place, Property property) {
  const auto converted = [&](double number) {
    return property == Property::friction ? radians(number) : number * name_of(property).factor;
  };
  data.values.push_back({{row[0], row[1]}, converted(row[2]), converted(row[3]), property});
  data.places.push_back(std::move(place));
  data.rows.push_back(row);
}

const Quantity& quantity(std::size_t column, const Measured& what) {
  return column < 2 ? coordinate : column == 2 ? what.value : what.error;
}

/// "> 0 and <= 89"
std::string range_of(const Quantity& q) {
  return (q.lo_open ? "> " : ">= ") + to_text(q.lo) + " and " + (q.hi_open ? "< " : "<= ") + to_text(q.hi);
}

void read_inline(const Json& value, const std::string& pointer, Faults& faults, FieldData& data, const Measured& what) {
  if (!value.is_array() || value.empty() || value.size() > most_data) {
    faults.add(pointer, value.is_array() ? "has " + std::to_string(value.size()) + " data, 1 to " +
                                               std::to_string(most_data) + " are allowed"
                                         : quote(value) + " is not a list of [x, y, value, error]");
    return;
  }
  const std::string unit(what.value.unit);
  for (std::size_t k = 0; k < value.size(); ++k) {
    const Json& row = value[k];
    const std::string place = pointer_to(pointer, k);
    if (!row.is_array() || row.size() != 4) {
      faults.add(place, quote(row) + " is not [x, y, value, error] in m, m, " + unit + ", " + unit +
                            "; the error of an exact value is 0");
      continue;
    }
    Row numbers{};
    bool whole = true;
    for (std::size_t c = 0; c < 4; ++c) {
      const auto number = read_number(row[c], quantity(c, what), pointer_to(place, c), faults);
      whole = whole && number.has_value();
      numbers[c] = number.value_or(0.0);
    }
    if (whole) add(data, numbers, place, what.property);
  }
}

void read_table(const std::string& text, const std::string& name, Faults& faults, FieldData& data,
                const Measured& what) {
  constexpr const char* columns[] = {"x", "y", "value", "standard error"};
  LineFaults found(name);
  const std::string content = decoded(text);
  const DataTable table = read_data_table(content, most_data + 1, what.property, found);
  data.forms = {name + ": " + table.form + ", " + std::to_string(table.rows.size()) + " data"};
  for (const DataRow& row : table.rows) {
    Row numbers{};
    bool whole = true;
    for (std::size_t c = 0; c < 4; ++c) {
      if (c == 3 && row.cells[c].empty()) continue;  // no column of errors: exact
      const std::optional<double> number = to_number(row.cells[c]);
      whole = whole && number && quantity(c, what).allows(*number);
      if (!number)
        found.add("number", row.line, std::string(columns[c]) + " " + in_quotes(row.cells[c]) + " is not a number");
      else if (!quantity(c, what).allows(*number))
        found.add("range", row.line,
                  std::string(columns[c]) + " " + shorten(row.cells[c]) + " is out of range; " +
                      quantity(c, what).describe());
      numbers[c] = number.value_or(0.0) + 0.0;  // -0 becomes 0
    }
    if (whole) add(data, numbers, name + ":" + std::to_string(row.line), what.property);
  }
  found.report(faults);
  if (table.rows.size() > most_data) faults.add(name, "has more than " + std::to_string(most_data) + " data");
}

void declare_data(ObjectReader& in, const Measured& what) {
  const std::string unit(what.value.unit);
  const Quantity widest{"", coordinate.lo, std::max(coordinate.hi, what.value.hi)};
  const Json row = {{"type", "array"}, {"minItems", 4}, {"maxItems", 4}, {"items", number_schema(widest)}};
  const std::string sentence =
      "Measured " + what.words +
      ", [[x, y, value, standard error], ...], from boreholes and soundings inside the rectangle of the field. Every "
      "realization meets them within their errors (error 0: exactly); mean and coefficient of variation are those of "
      "the soil before the data are known.";
  in.declare("data", {{"type", "array"}, {"minItems", 1}, {"maxItems", most_data}, {"items", row}},
             {sentence, "site investigation", "none"},
             "Unit: m, m, " + unit + ", " + unit + "; range: value " + range_of(what.value) + ", error " +
                 range_of(what.error) + ", 1 to 1,000 data; ");
  in.declare(
      "data_csv", {{"type", "string"}, {"minLength", 1}, {"pattern", csv_name_pattern}},
      {"The same as a CSV file beside the case or in a directory below it: columns x, y, value and error, in the "
       "forms that surveys have. Without a column of errors the values are exact.",
       "site investigation"},
      "");
}

}  // namespace

void FieldData::append(const FieldData& other) {
  values.insert(values.end(), other.values.begin(), other.values.end());
  places.insert(places.end(), other.places.begin(), other.places.end());
  forms.insert(forms.end(), other.forms.begin(), other.forms.end());
}

FieldData read_field_data(ObjectReader& in, const std::filesystem::path& directory, const Measured& what) {
  declare_data(in, what);
  in.exclude("data_csv", "data");
  const Json* list = in.find("data");
  const Json* csv = in.find("data_csv");
  if ((list == nullptr) == (csv == nullptr)) return {};
  const std::size_t before = in.faults().size();
  FieldData data;
  if (list != nullptr)
    read_inline(*list, in.pointer("data"), in.faults(), data, what);
  else if (const auto text = csv_text(*csv, in.pointer("data_csv"), directory, in.faults()))
    read_table(*text, csv->get<std::string>(), in.faults(), data, what);
  if (in.faults().size() != before) return {};
  in.record("data", data.rows);
  return data;
}

std::string in_words(double value, Property property) {
  if (property == Property::friction) return rounded(degrees(value)) + " deg";
  return rounded(value / name_of(property).factor) + " " + std::string(name_of(property).unit);
}

void check_field_data(const FieldData& data, Box domain, Faults& faults) {
  for (std::size_t k = 0; k < data.values.size(); ++k) {
    const FieldDatum& datum = data.values[k];
    if (datum.x.x < domain.lo.x || datum.x.x > domain.hi.x || datum.x.y < domain.lo.y || datum.x.y > domain.hi.y)
      faults.add(data.places[k], to_text(datum.x) + " lies outside the rectangle of the field, " + to_text(domain.lo) +
                                     " to " + to_text(domain.hi) +
                                     "; random_field.domain_m sets a larger one, or leave the datum out");
    for (std::size_t j = 0; j < k; ++j) {
      const FieldDatum& other = data.values[j];
      if (other.property != datum.property || norm(other.x - datum.x) >= same_point) continue;
      if (std::abs(other.value - datum.value) > most_errors_apart * std::hypot(other.error, datum.error))
        faults.add(data.places[k], in_words(datum.value, datum.property) + " contradicts " + data.places[j] + ", " +
                                       in_words(other.value, other.property) + " at the same point: more than " +
                                       rounded(most_errors_apart) +
                                       " joint standard errors apart; give larger errors or remove one");
    }
  }
}

}  // namespace talus
