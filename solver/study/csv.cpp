#include "study/csv.hpp"

#include <charconv>
#include <cmath>
#include <cstdint>

#include "io/files.hpp"
#include "math/error.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_csv_bytes = std::size_t{1} << 30;
constexpr std::size_t columns = 2 + measure_columns.size() + 6;

std::string header(const std::string& index_name) {
  std::string line = index_name + ",status";
  for (const MeasureColumn& column : measure_columns) line += std::string(",") + column.key;
  return line + ",mean_friction_angle_deg,captured_variance,steps,wall_clock_s,digest,reason";
}

std::string number(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

/// A field in quotes, on one line.
std::string quoted(const std::string& text) {
  if (text.empty()) return {};
  std::string field = "\"";
  for (char c : text) field += c == '"' ? "\"\"" : c == '\n' || c == '\r' ? " " : std::string(1, c);
  return field + '"';
}

std::string line(const Record& record) {
  std::string text = std::to_string(record.index) + (record.done ? ",done" : ",failed");
  if (!record.done) return text + std::string(measure_columns.size() + 5, ',') + ',' + quoted(record.reason);
  for (const MeasureColumn& column : measure_columns) text += ',' + number(record.measures.*column.member);
  return text + ',' + number(record.mean_phi_deg) + ',' + number(record.captured_variance) + ',' +
         std::to_string(record.steps) + ',' + number(record.wall_clock) + ',' + record.digest + ',';
}

/// The fields of one line; an unclosed quote gives a field too few, which the caller reports.
std::vector<std::string> fields(const std::string& text) {
  std::vector<std::string> all(1);
  bool inside = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"' && inside && i + 1 < text.size() && text[i + 1] == '"') {
      all.back() += text[++i];
    } else if (c == '"') {
      inside = !inside;
    } else if (c == ',' && !inside) {
      all.emplace_back();
    } else {
      all.back() += c;
    }
  }
  if (inside) all.clear();
  return all;
}

/// The fields of one line as values, from left to right.
class Fields {
 public:
  Fields(std::vector<std::string> all, std::string place) : all_(std::move(all)), place_(std::move(place)) {
    if (all_.size() != columns)
      fail("has " + std::to_string(all_.size()) + " fields instead of " + std::to_string(columns));
  }
  std::string text() { return all_[next_++]; }
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
  std::vector<std::string> all_;
  std::string place_;
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
  for (const MeasureColumn& column : measure_columns) r.measures.*column.member = fields.number<double>();
  r.mean_phi_deg = fields.number<double>();
  r.captured_variance = fields.number<double>();
  r.steps = fields.number<std::int64_t>();
  r.wall_clock = fields.number<double>();
  r.digest = fields.text();
  return r;
}

}  // namespace

std::string to_csv(const std::vector<Record>& records, const std::string& index_name) {
  std::string text = header(index_name) + '\n';
  for (const Record& r : records) text += line(r) + '\n';
  return text;
}

std::vector<Record> read_csv(const fs::path& path, const std::string& index_name) {
  const std::string text = read_file(path, max_csv_bytes);
  std::vector<Record> records;
  std::size_t start = 0;
  for (int number = 1; start < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    std::string row = text.substr(start, end - start);
    if (row.ends_with('\r')) row.pop_back();
    start = end + 1;
    const std::string place = path.string() + ":" + std::to_string(number);
    if (number == 1) {
      if (row != header(index_name))
        throw IoError(place + " is not the header of a table of Talus: expected " + header(index_name));
      continue;
    }
    if (row.empty()) continue;
    records.push_back(record(Fields(fields(row), place)));
    if (records.size() > 1 && records.back().index <= records[records.size() - 2].index)
      throw IoError(place + " has the " + index_name + " " + std::to_string(records.back().index) +
                    " out of order, or twice");
  }
  if (start == 0) throw IoError(path.string() + " is empty");
  return records;
}

}  // namespace talus
