#include <gtest/gtest.h>

#include "support/error.hpp"

namespace talus {
namespace {

TEST(ConfigError, ListsEveryFaultOnALineOfItsOwn) {
  const ConfigError error(std::vector<Fault>{{"/a/b", "is missing"}, {"", "is not JSON"}});
  EXPECT_STREQ(error.what(), "/a/b: is missing\nis not JSON");
  ASSERT_EQ(error.faults.size(), 2u);
  EXPECT_EQ(error.faults[0].pointer, "/a/b");
}

TEST(DivergedError, SaysWhereAndWhen) {
  const DivergedError error("not finite", 12, 0.25, 7);
  EXPECT_EQ(error.step, 12);
  EXPECT_EQ(error.time, 0.25);
  EXPECT_EQ(error.particle, 7);
}

}  // namespace
}  // namespace talus
