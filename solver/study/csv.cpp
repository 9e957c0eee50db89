#include "study/csv.hpp"

#include <charconv>
#include <cmath>

#include "support/csv.hpp"
#include "support/error.hpp"
#include "support/files.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_csv_bytes = std::size_t{1} << 30;
constexpr std::size_t numbers = measure_table.size() + covariate_table.size();
constexpr std::size_t columns = 2 + numbers + 2;  ///< index and status; digest and reason

/// The number of a field; `fail` is told what is wrong with it.
template <class Number, class Fail>
void read_number(const std::string& field, Number& value, const Fail& fail) {
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(static_cast<double>(value)))
    fail(in_quotes(field) + " is not a number");
}

Record record(const std::vector<std::string>& fields, const std::string& place) {
  const auto fail = [&](const std::string& why) { throw IoError(place + " " + why); };
  if (fields.size() != columns)
    fail("has " + std::to_string(fields.size()) + " fields instead of " + std::to_string(columns));
  std::size_t at = 0;
  const auto fail_at = [&](const std::string& why) { fail("field " + std::to_string(at + 1) + ": " + why); };
  Record r;
  read_number(fields[0], r.index, fail_at);
  r.done = fields[1] == "done";
  if (!r.done && fields[1] != "failed") fail("has the status \"" + fields[1] + "\", which is neither done nor failed");
  r.reason = fields.back();
  if (!r.done) return r;
  at = 2;
  visit_numbers(r, [&](const char*, const std::string&, auto& value) {
    read_number(fields[at], value, fail_at);
    ++at;
  });
  r.digest = fields[at];
  return r;
}

}  // namespace

std::string csv_header(const std::string& index_name) {
  std::string line = index_name + ",status";
  const Record any;
  visit_numbers(any, [&](const char* key, const std::string&, auto) { line += std::string(",") + key; });
  return line + ",digest,reason\n";
}

std::string csv_line(const Record& record) {
  std::string line = std::to_string(record.index) + (record.done ? ",done" : ",failed");
  if (!record.done) return line + std::string(numbers + 2, ',') + csv_quoted(record.reason) + '\n';
  visit_numbers(record, [&](const char*, const std::string&, auto value) { line += ',' + to_text(value); });
  return line + ',' + record.digest + ",\n";
}

std::string to_csv(const std::vector<Record>& records, const std::string& index_name) {
  std::string text = csv_header(index_name);
  for (const Record& r : records) text += csv_line(r);
  return text;
}

std::vector<Record> read_csv(const fs::path& path, const std::string& index_name) {
  const std::string text = read_file(path, max_csv_bytes);
  CsvRows rows(text);
  if (!rows.next()) throw IoError(path.string() + " is empty");
  const auto place = [&] { return path.string() + ":" + std::to_string(rows.line()); };
  const std::string header = csv_header(index_name);
  if (std::string(rows.text()) + "\n" != header)
    throw IoError(place() + " is not the header of a table of Talus: expected " + header.substr(0, header.size() - 1));
  std::vector<Record> records;
  while (rows.next()) {
    records.push_back(record(rows.fields(), place()));
    if (records.size() > 1 && records.back().index <= records[records.size() - 2].index)
      throw IoError(place() + " has the " + index_name + " " + std::to_string(records.back().index) +
                    " out of order, or twice");
  }
  return records;
}

}  // namespace talus
