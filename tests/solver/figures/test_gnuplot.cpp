#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <string>

#include "figures/sheet.hpp"
#include "reading.hpp"
#include "support/error.hpp"
#include "temporary_directory.hpp"

namespace talus::figures {
namespace {

TEST(Gnuplot, GivesThePictureAndTheWarnings) {
  const GnuplotOutput output = run_gnuplot("set print '-'\nprint 6*7\nset print\nprint 'aside'\n");
  EXPECT_EQ(output.picture, "42\n");
  EXPECT_EQ(output.warnings, "aside\n");
}

TEST(Gnuplot, AnErrorCarriesItsMessage) {
  try {
    run_gnuplot("plot no_such_function(x)\n");
    FAIL() << "no error";
  } catch (const IoError& e) {
    EXPECT_TRUE(test::contains(e.what(), "undefined")) << e.what();
  }
}

// An environment variable set for as long as the object lives.
class Environment {
 public:
  Environment(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    ::setenv(name, value.c_str(), 1);
  }
  ~Environment() { before_ ? ::setenv(name_, before_->c_str(), 1) : ::unsetenv(name_); }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

TEST(Gnuplot, ReadsNoStartUpFile) {
  const test::TemporaryDirectory home;
  write_file_atomically(home / ".gnuplot", "from_start_up_file = 1\n");
  const Environment moved("HOME", home.path().string());
  EXPECT_EQ(run_gnuplot("set print '-'\nprint exists('from_start_up_file')\n").picture, "0\n");
}

TEST(Gnuplot, LargeInputAndOutputDoNotBlock) {
  std::string script = "set print '-'\n";
  for (int i = 0; i < 50000; ++i) script += "print 'line " + std::to_string(i) + "'\n";
  EXPECT_GT(run_gnuplot(script).picture.size(), 500'000u);
}

TEST(Gnuplot, MissingProgramSaysWhatToInstall) {
  const Environment nowhere("PATH", "/nonexistent");
  try {
    run_gnuplot("plot x\n");
    FAIL() << "no error";
  } catch (const IoError& e) {
    EXPECT_TRUE(test::contains(e.what(), "install gnuplot-nox")) << e.what();
  }
}

}  // namespace
}  // namespace talus::figures
