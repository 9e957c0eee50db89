// Bytes as a case file and as a CSV file beside it: a case, vertices or faults, nothing else.

#include "case/load.hpp"
#include "case/vertices.hpp"
#include "support/json.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  talus::Faults faults;
  talus::read_csv({reinterpret_cast<const char*>(data), size}, "bed.csv", faults);
  try {
    talus::load_case(talus::parse_json(std::string(reinterpret_cast<const char*>(data), size), "case.json"),
                     TALUS_SOURCE_DIR "/schemas/examples/good");
  } catch (const talus::ConfigError&) {
  } catch (const talus::IoError&) {
  }
  return 0;
}
