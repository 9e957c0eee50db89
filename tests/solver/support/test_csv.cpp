#include <gtest/gtest.h>

#include "support/csv.hpp"

namespace talus {
namespace {

using Row = std::vector<std::string>;

/// All rows of a text.
std::vector<Row> rows(std::string_view text, CsvStyle style = CsvStyle::strict) {
  std::vector<Row> all;
  for (CsvRows csv(text, style); csv.next();) all.push_back(csv.fields());
  return all;
}

TEST(CsvRows, SplitsAtCommasOutsideOfQuotationMarks) {
  EXPECT_EQ(rows("a,,\"b,c\"\r\n\"d \"\"e\"\"\",f\n"), (std::vector<Row>{{"a", "", "b,c"}, {"d \"e\"", "f"}}));
  EXPECT_EQ(rows("1,2\n\n3,4"), (std::vector<Row>{{"1", "2"}, {"3", "4"}}));
  EXPECT_EQ(rows(" a ;b,#c"), (std::vector<Row>{{" a ;b", "#c"}}));
  EXPECT_TRUE(rows("").empty());
}

TEST(CsvRows, GivesNoFieldsWhereAQuotationMarkIsNotClosed) {
  EXPECT_EQ(rows("\"a,b\nc,d\n"), (std::vector<Row>{{}, {"c", "d"}}));
}

TEST(CsvRows, TakesWhatPeopleWrite) {
  const auto by_hand = [](std::string_view text) { return rows(text, CsvStyle::by_hand); };
  EXPECT_EQ(by_hand("\xEF\xBB\xBFx; y\n# note\n  \n 1 ;\t2\r\n"), (std::vector<Row>{{"x", "y"}, {"1", "2"}}));
  EXPECT_EQ(by_hand("1,5;2,5"), (std::vector<Row>{{"1,5", "2,5"}}));
  EXPECT_EQ(by_hand("1\t2"), (std::vector<Row>{{"1", "2"}}));
}

TEST(CsvRows, CountsLinesThatItSkips) {
  CsvRows csv("a\n\n# b\nc\n", CsvStyle::by_hand);
  ASSERT_TRUE(csv.next());
  EXPECT_EQ(csv.line(), 1);
  ASSERT_TRUE(csv.next());
  EXPECT_EQ(csv.line(), 4);
  EXPECT_EQ(csv.text(), "c");
  EXPECT_FALSE(csv.next());
}

TEST(SplitFields, TakesRunsOfBlanksAsOneSeparator) {
  EXPECT_EQ(split_fields("1  2\t 3", ' '), (Row{"1", "2", "3"}));
  EXPECT_EQ(split_fields("a b;;c", ';'), (Row{"a b", "", "c"}));
}

TEST(Decoded, ReadsEveryEncoding) {
  using namespace std::string_view_literals;
  const std::string umlaut = "a\xC3\xB6", face = "\xF0\x9F\x98\x80";  // o with two dots; U+1F600
  EXPECT_EQ(decoded(umlaut), umlaut);
  EXPECT_EQ(decoded("\xEF\xBB\xBF" + umlaut), umlaut);
  EXPECT_EQ(decoded("a\xF6"), umlaut) << "Latin-1";
  EXPECT_EQ(decoded("\xFF\xFE"
                    "a\0\xF6\0"sv),
            umlaut);
  EXPECT_EQ(decoded("\xFE\xFF\0a\0\xF6"sv), umlaut);
  EXPECT_EQ(decoded("a\0\xF6\0"sv), umlaut) << "no mark";
  EXPECT_EQ(decoded("\xFE\xFF\xD8\x3D\xDE\x00"sv), face);
  EXPECT_EQ(decoded("\xFE\xFF\xD8\x3D\0a"sv),
            "\xEF\xBF\xBD"
            "a")
      << "half a pair";
  EXPECT_EQ(decoded("\xFF\xFE"
                    "a\0b"sv),
            "a")
      << "half a character at the end";
  EXPECT_EQ(decoded(""), "");
}

TEST(CsvQuoted, ReadsBackOnOneLine) {
  EXPECT_EQ(csv_quoted("say \"a\", b\nc"), "\"say \"\"a\"\", b c\"");
  EXPECT_EQ(rows(csv_quoted("say \"a\", b")), (std::vector<Row>{{"say \"a\", b"}}));
  EXPECT_EQ(csv_quoted(""), "");
}

}  // namespace
}  // namespace talus
