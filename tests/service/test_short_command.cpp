#include <gtest/gtest.h>
#include <signal.h>

#include "process/short_command.hpp"
#include "temporary_directory.hpp"

namespace talus::service {
namespace {

TEST(ShortCommand, IsKilledAfterItsLimit) {
  const test::TemporaryDirectory directory;
  const auto begin = std::chrono::steady_clock::now();
  const CommandOutput outcome = run_to_end({.arguments = {"/bin/sh", "-c", "echo begun; sleep 100"}}, directory.path(),
                                           std::chrono::milliseconds(200));
  EXPECT_TRUE(outcome.timed_out);
  EXPECT_EQ(outcome.end.signal, SIGKILL);
  EXPECT_EQ(outcome.out, "begun\n");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
}

}  // namespace
}  // namespace talus::service
