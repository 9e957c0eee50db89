#include <gtest/gtest.h>

#include "case/vertices.hpp"

namespace talus {
namespace {

std::string complaint(const std::string& csv) {
  Faults faults;
  read_csv(csv, "f.csv", faults);
  return faults.empty() ? "" : ConfigError(faults.all()).what();
}

TEST(ReadCsv, TakesTheUsualForms) {
  const std::vector<Vec2> expected = {{0, 1.5}, {2, -3}};
  for (const char* text : {"0,1.5\n2,-3\n", "x,y\n0,1.5\n2,-3", "x;y\r\n0;1.5\r\n\r\n2;-3\r\n",
                           "\xEF\xBB\xBFx\ty\n# remark\n0\t1.5\n 2 \t -3 ", "\"x\",\"y\"\n\"0\",+1.5\n2e0,-0.3e1\n"}) {
    Faults faults;
    EXPECT_EQ(read_csv(text, "f.csv", faults).points, expected) << text;
    EXPECT_TRUE(faults.empty());
  }
}

TEST(ReadCsv, NamesFileAndLine) {
  EXPECT_EQ(complaint("x,y\n\n0,a\n"), "f.csv:3: \"a\" is not a number");
  EXPECT_EQ(complaint("0,1\n1,2,3\n4\n"),
            "f.csv:2: has 3 columns, expected 2: x, y in metres\nf.csv:3: has 1 columns, expected 2: x, y in metres");
  EXPECT_EQ(complaint("0;1\n1,5;2\n"), "f.csv:2: \"1,5\" is not a number; write a decimal point");
  EXPECT_EQ(complaint("0,1\ninf,2\n").substr(0, 8), "f.csv:2:");
  EXPECT_EQ(complaint("0,1\n1,nan\n").substr(0, 8), "f.csv:2:");
  EXPECT_EQ(complaint("0,1\n1,1e7\n"), "f.csv:2: 1e7 is out of range; unit m, allowed >= -1e+06 and <= 1e+06");
  EXPECT_EQ(complaint("0,1\nx,y\n"), "f.csv:2: \"x\" is not a number") << "only the first line can be a header";
}

TEST(ReadCsv, KnowsTheLineOfEachVertex) {
  Faults faults;
  const Vertices v = read_csv("x,y\n\n0,1\n# remark\n2,3\n", "f.csv", faults);
  EXPECT_EQ(v.location(0), "f.csv:3");
  EXPECT_EQ(v.location(1), "f.csv:5");
}

TEST(ReadCsv, StopsAtItsLimit) {
  std::string text;
  for (std::size_t k = 0; k <= most_vertices; ++k) text += "0,0\n";
  EXPECT_EQ(complaint(text), "f.csv: has more than 20000 vertices");
}

TEST(ReadVertices, TakesPlainNamesOnly) {
  for (const char* name : {"../case.csv", "/etc/passwd", "a/b.csv", "..", ".", ".hidden", "", "a\\b.csv"}) {
    Faults faults;
    const Json document = {{"bed_csv", name}};
    ObjectReader in(document, "/terrain", faults);
    read_vertices(in, "bed", {2, most_vertices}, "/", {"The bed."});
    ASSERT_EQ(faults.size(), 1u) << name;
    EXPECT_NE(faults.all()[0].message.find("is not the plain name of a CSV file"), std::string::npos) << name;
  }
}

}  // namespace
}  // namespace talus
