#include "study/csv.hpp"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

#include "support/csv.hpp"
#include "support/error.hpp"
#include "support/files.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_csv_bytes = std::size_t{1} << 30;
constexpr std::size_t columns = 2 + measure_table.size() + 6;

/// The fields of one line as values, from left to right.
class Fields {
 public:
  Fields(const std::vector<std::string>& all, const std::string& place) : all_(all), place_(place) {
    if (all_.size() != columns)
      fail("has " + std::to_string(all_.size()) + " fields instead of " + std::to_string(columns));
  }
  std::string text() { return all_[next_++]; }
  /// NaN where the field is empty: the run was recorded before the measure existed.
  double measure() {
    if (!all_[next_].empty()) return number<double>();
    ++next_;
    return std::numeric_limits<double>::quiet_NaN();
  }
  template <class T>
  T number() {
    const std::string& field = all_[next_++];
    T value{};
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(static_cast<double>(value)))
      fail("field " + std::to_string(next_) + ": \"" + field + "\" is not a number");
    return value;
  }
  [[noreturn]] void fail(const std::string& why) const { throw IoError(place_ + " " + why); }

 private:
  const std::vector<std::string>& all_;
  const std::string& place_;
  std::size_t next_ = 0;
};

Record record(Fields fields) {
  Record r;
  r.index = fields.number<std::int64_t>();
  const std::string status = fields.text();
  if (status != "done" && status != "failed")
    fields.fail("has the status \"" + status + "\", which is neither done nor failed");
  r.done = status == "done";
  if (!r.done) {
    for (std::size_t i = 2; i + 1 < columns; ++i) fields.text();
    r.reason = fields.text();
    return r;
  }
  for (const Measure& measure : measure_table) r.measures.*measure.member = fields.measure();
  r.mean_phi_deg = fields.number<double>();
  r.captured_variance = fields.number<double>();
  r.steps = fields.number<std::int64_t>();
  r.wall_clock = fields.number<double>();
  r.digest = fields.text();
  return r;
}

}  // namespace

std::string csv_header(const std::string& index_name) {
  std::string line = index_name + ",status";
  for (const Measure& measure : measure_table) line += std::string(",") + measure.key;
  return line + ",mean_friction_angle_deg,captured_variance,steps,wall_clock_s,digest,reason\n";
}

std::string csv_line(const Record& record) {
  std::string text = std::to_string(record.index) + (record.done ? ",done" : ",failed");
  if (!record.done) return text + std::string(measure_table.size() + 5, ',') + ',' + csv_quoted(record.reason) + '\n';
  for (const Measure& measure : measure_table) {
    const double value = record.measures.*measure.member;
    text += ',' + (std::isnan(value) ? "" : to_text(value));
  }
  return text + ',' + to_text(record.mean_phi_deg) + ',' + to_text(record.captured_variance) + ',' +
         std::to_string(record.steps) + ',' + to_text(record.wall_clock) + ',' + record.digest + ",\n";
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
    records.push_back(record(Fields(rows.fields(), place())));
    if (records.size() > 1 && records.back().index <= records[records.size() - 2].index)
      throw IoError(place() + " has the " + index_name + " " + std::to_string(records.back().index) +
                    " out of order, or twice");
  }
  return records;
}

}  // namespace talus
