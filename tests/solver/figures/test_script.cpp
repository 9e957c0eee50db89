#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "figures/sheet.hpp"
#include "reading.hpp"

namespace talus::figures {
namespace {

TEST(Script, NumbersReadBackAndWhatIsNotFiniteIsNaN) {
  EXPECT_EQ(number(0.1), "0.1");
  EXPECT_EQ(number(-1234567.0), "-1234567");
  EXPECT_EQ(number(1e300), "1e+300");
  EXPECT_EQ(number(std::numeric_limits<double>::infinity()), "NaN");
  EXPECT_EQ(number(std::numeric_limits<double>::quiet_NaN()), "NaN");
}

TEST(Script, DataIsOneRowALine) {
  Script script;
  script.data("a", std::vector<std::array<double, 2>>{{1, 2.5}, {3, -4}});
  EXPECT_EQ(script.text(), "$a << END_OF_DATA\n1 2.5\n3 -4\nEND_OF_DATA\n");
  Script points;
  points.data("b", std::array{Vec2{1, 2}});
  EXPECT_EQ(points.text(), "$b << END_OF_DATA\n1 2\nEND_OF_DATA\n");
}

TEST(Script, ShortenedCountsCharactersNotBytes) {
  EXPECT_EQ(shortened("abc", 3), "abc");
  EXPECT_EQ(shortened("abcd", 3), "ab…");
  EXPECT_EQ(shortened("äöüß", 4), "äöüß");
  EXPECT_EQ(shortened("äöüß", 3), "äö…");
}

// gnuplot itself is the oracle: what it prints is what it understood.
std::string as_gnuplot_reads(const std::string& text) {
  return run_gnuplot("set print '-'\nprint " + literal(text) + "\n").picture;
}

TEST(Literal, GnuplotReadsBackWhatWasWritten) {
  for (const std::string text :
       {"plain", "", "a \"quoted\" word", "back\\slash at the end\\", "`id`", "$(id)", "@macro", "{/:Bold x}_a^b",
        "# no comment", "; plot 1", "%s %d", "END_OF_DATA", "ΔÄ·±", "system('id')", "\"", "{{{", "]]>"}) {
    std::string expected = text;
    for (std::size_t at; (at = expected.find('\'')) != std::string::npos;) expected.replace(at, 1, "\u2019");
    EXPECT_EQ(as_gnuplot_reads(text), expected + "\n");
  }
}

TEST(Literal, QuotesAndControlCharactersCannotEndTheString) {
  EXPECT_EQ(literal("'"), "'\u2019'");
  EXPECT_EQ(literal("a\nplot 1\r\t\x7f"), "'a plot 1   '");
  EXPECT_EQ(as_gnuplot_reads("'.system('echo broken').'"), "\u2019.system(\u2019echo broken\u2019).\u2019\n");
}

TEST(Axis, AxesNameWhatWasTakenOffTheCoordinates) {
  EXPECT_EQ(axis_label("x", 0.0), "x (m)");
  EXPECT_EQ(axis_label("x", 2'683'000.0), "x - 2683000 (m)");
  EXPECT_EQ(axis_label("y", -55.25), "y + 55.25 (m)");
}

}  // namespace
}  // namespace talus::figures
