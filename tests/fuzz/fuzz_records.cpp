// Bytes as the records of a study: a table, a result, a failure record, and the summary of what was read.

#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "study/publish.hpp"
#include "study/record.hpp"
#include "study/summary.hpp"
#include "support/files.hpp"
#include "support/json.hpp"

using namespace talus;

namespace {

void check(bool holds) {
  if (!holds) std::abort();
}

/// A file in memory.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view content) : file_(::memfd_create("records", MFD_CLOEXEC)) {
    check(::write(file_.get(), content.data(), content.size()) == static_cast<ssize_t>(content.size()));
  }
  std::string path() const { return "/proc/self/fd/" + std::to_string(file_.get()); }

 private:
  FileDescriptor file_;
};

void check_record(const Record& record) {
  visit_numbers(record, [](const char*, const char*, auto value) {
    check(!(std::abs(static_cast<double>(value)) > largest_number));
  });
}

Plan plan() {
  Plan plan{.title = "t", .of = {"0123456789abcdef", "family", 2.0}, .version = "0.1.0", .seed = 7, .study = {}};
  plan.study.realizations = 4;
  return plan;
}

/// Every table that is read is summarised, with a bounded histogram, and gives the same text again.
void read_as_table(const MemoryFile& file) {
  const std::vector<Record> records = read_csv(file.path(), "index");
  for (const Record& record : records) check_record(record);
  const StudySummary summary = summary_of(plan(), records, records);
  const Json study = summary.json();
  for (const auto& [key, quantity] : study.at("quantities").items()) {
    check(quantity.at("histogram").at("counts").size() <= 1002);
    check(quantity.at("exceedance").size() <= 1003);
  }
  distribution(plan(), measure_table[0], summary.sample(measure_table[0]), {.count = 20});
}

void read_as_result(const MemoryFile& file) {
  const StudyIdentity identity{.seed = 7, .case_hash = "0123456789abcdef"};
  for (const RunKind kind : {RunKind::realization, RunKind::replicate})
    if (const auto record = read_result(file.path(), {.kind = kind, .index = 1}, identity)) check_record(*record);
}

template <class Read>
void unless_refused(const Read& read) {
  try {
    read();
  } catch (const IoError&) {
  } catch (const ConfigError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const MemoryFile file(bytes);
  unless_refused([&] { read_as_table(file); });
  unless_refused([&] { read_as_result(file); });
  read_failure(file.path());
  unless_refused([&] {
    const Json document = parse_json(bytes, "bytes");
    if (!document.is_object() || document.empty() || document.contains("checksum")) return;
    read_as_result(MemoryFile(with_checksum(document)));
  });
  return 0;
}
