#include <gtest/gtest.h>

#include "cli/xi_file.hpp"
#include "support/error.hpp"
#include "support/files.hpp"
#include "temporary_directory.hpp"

namespace talus::cli {
namespace {

std::vector<double> xi_of(const std::string& content) {
  const test::TemporaryDirectory directory;
  write_file_atomically(directory / "xi.txt", content);
  return read_xi(directory / "xi.txt");
}

std::string fault_of(const std::string& content) {
  try {
    xi_of(content);
  } catch (const ConfigError& e) {
    const std::string text = e.what();
    return text.substr(text.find("xi.txt"));
  }
  return {};
}

using Numbers = std::vector<double>;

TEST(XiFile, OneNumberALine) {
  EXPECT_EQ(xi_of("-1.9941\n-0.2451\n2.0280\n"), (Numbers{-1.9941, -0.2451, 2.028}));
  EXPECT_EQ(xi_of("1e-3\r\n+2\r\n\r\n# a remark\n  3  "), (Numbers{1e-3, 2, 3}));
}

TEST(XiFile, ColumnXiOrTheLastOne) {
  EXPECT_EQ(xi_of("mode,xi,note\n1,0.5,7\n2,-0.5,8\n"), (Numbers{0.5, -0.5}));
  EXPECT_EQ(xi_of("1,0.5\n2,-0.5\n"), (Numbers{0.5, -0.5}));
  EXPECT_EQ(xi_of("\"mode\",\"coefficient\"\n1,0.25\n"), (Numbers{0.25}));
}

TEST(XiFile, FaultsNameFileAndLine) {
  EXPECT_EQ(fault_of("1\n\ntwo\n"), "xi.txt:3: \"two\" is not a finite number");
  EXPECT_EQ(fault_of("nan\n"), "xi.txt:1: \"nan\" is not a finite number");
  EXPECT_EQ(fault_of("1e999\n"), "xi.txt:1: \"1e999\" is not a finite number");
  EXPECT_EQ(fault_of("mode,xi\n1\n"), "xi.txt:2: has no column xi");
  EXPECT_EQ(fault_of("# nothing\n"), "xi.txt: holds no number");
  EXPECT_EQ(fault_of("xi\nxi\n"), "xi.txt:2: \"xi\" is not a finite number");
  EXPECT_THROW(read_xi("/nonexistent/xi.txt"), IoError);
}

}  // namespace
}  // namespace talus::cli
