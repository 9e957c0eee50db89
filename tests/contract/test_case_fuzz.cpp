// Files cut short, with bytes replaced and with values swapped: the reader answers with faults or a case, nothing else.

#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "case/load.hpp"
#include "schema_check.hpp"
#include "support/json.hpp"

namespace talus {
namespace {

using test::slurp;
using test::source;

enum class Answer { sound, faults };

Answer answer(const std::string& text) {
  try {
    load_case(parse_json(text, "case.json"), source("schemas/examples/good"));
    return Answer::sound;
  } catch (const ConfigError& e) {
    EXPECT_FALSE(e.faults.empty());
    return Answer::faults;
  }
}

TEST(CaseFuzz, NoBeginningOfACaseIsACase) {
  for (const char* name : {"full", "surfaces"}) {
    std::string text = slurp(source(std::string("schemas/examples/good/case-") + name + ".json"));
    text.resize(text.find_last_of('}') + 1);
    ASSERT_EQ(answer(text), Answer::sound);
    for (std::size_t length = 0; length < text.size(); ++length)
      EXPECT_EQ(answer(text.substr(0, length)), Answer::faults) << length;
  }
}

TEST(CaseFuzz, ReplacedBytesAreAnswered) {
  const std::string text = slurp(source("schemas/examples/good/case-full.json"));
  std::mt19937 random(1);
  const std::string bytes = "{}[],:\"-0e9.x\\\xff\x00n";
  for (std::size_t k = 0; k < text.size(); ++k) {
    std::string spoilt = text;
    spoilt[k] = bytes[random() % bytes.size()];
    EXPECT_NO_THROW(answer(spoilt)) << k;
  }
}

TEST(CaseFuzz, SwappedValuesAreAnswered) {
  const auto document = nlohmann::ordered_json::parse(slurp(source("schemas/examples/good/case-full.json")));
  const nlohmann::ordered_json flat = document.flatten();
  std::vector<std::string> pointers;
  for (const auto& [pointer, value] : flat.items()) pointers.push_back(pointer);
  std::mt19937 random(2);
  for (int trial = 0; trial < 2000; ++trial) {
    auto changed = document;
    for (int n = 0; n < 3; ++n)
      changed[nlohmann::ordered_json::json_pointer(pointers[random() % pointers.size()])] =
          flat[pointers[random() % pointers.size()]];
    EXPECT_NO_THROW(answer(changed.dump())) << changed.dump();
  }
}

TEST(CaseFuzz, SpoiltCsvIsAnswered) {
  const std::string text = slurp(source("schemas/examples/good/case-bed.csv"));
  const auto directory = std::filesystem::path(testing::TempDir());
  auto document = nlohmann::ordered_json::parse(slurp(source("schemas/examples/good/case-minimal.json")));
  document["terrain"] = {{"bed_csv", "talus-fuzz.csv"}};
  std::mt19937 random(3);
  const std::string bytes = ",;\t\n\r#-0e9.xn\"\xff";
  for (std::size_t k = 0; k <= text.size(); ++k) {
    std::string spoilt = k % 2 == 0 ? text.substr(0, k) : text;
    if (k < spoilt.size()) spoilt[k] = bytes[random() % bytes.size()];
    std::ofstream(directory / "talus-fuzz.csv", std::ios::binary) << spoilt;
    try {
      load_case(document, directory);
    } catch (const ConfigError& e) {
      EXPECT_FALSE(e.faults.empty());
    }
  }
  std::filesystem::remove(directory / "talus-fuzz.csv");
}

}  // namespace
}  // namespace talus
