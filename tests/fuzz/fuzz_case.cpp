// Bytes as a case file: a case or faults, nothing else.

#include "case/load.hpp"
#include "support/json.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    talus::load_case(talus::parse_json(std::string(reinterpret_cast<const char*>(data), size), "case.json"),
                     TALUS_SOURCE_DIR "/schemas/examples/good");
  } catch (const talus::ConfigError&) {
  } catch (const talus::IoError&) {
  }
  return 0;
}
