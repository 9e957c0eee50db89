// Files cut short, with bytes replaced and with values swapped: the reader answers with faults or a case, nothing else.

#include <gtest/gtest.h>

#include <random>

#include "case/load.hpp"
#include "case/vertices.hpp"
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
  std::vector<std::string> texts = {slurp(source("schemas/examples/good/case-bed.csv"))};
  for (const auto& seed : test::files("tests/fuzz/fuzz_case-seeds", "csv-", "")) texts.push_back(slurp(seed));
  ASSERT_GT(texts.size(), 5u);
  std::mt19937 random(3);
  const std::string bytes(",;\t\n\r# -0e9.xn\"\xff\xfe\0", 19);
  for (const std::string& text : texts)
    for (std::size_t k = 0; k <= 20 * text.size(); ++k) {
      std::string spoilt = k % 2 == 0 ? text.substr(0, k / 20) : text;
      for (int n = 0; n < 3 && !spoilt.empty(); ++n) spoilt[random() % spoilt.size()] = bytes[random() % bytes.size()];
      Faults faults;
      const Vertices read = read_csv(spoilt, "f.csv", faults);
      EXPECT_TRUE(!read.empty() || !faults.empty()) << spoilt;
      EXPECT_EQ(read.points.size(), read.lines.size());
      for (const Vec2& v : read.points) EXPECT_TRUE(coordinate.allows(v.x) && coordinate.allows(v.y)) << spoilt;
    }
}

}  // namespace
}  // namespace talus
