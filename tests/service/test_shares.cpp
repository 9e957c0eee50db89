#include <gtest/gtest.h>

#include <thread>

#include "base/refusal.hpp"
#include "base/shares.hpp"

namespace talus::service {
namespace {

constexpr std::chrono::milliseconds immediately{0};
constexpr std::chrono::hours an_hour{1};

struct SharesTest : testing::Test {
  Shares shares{"things", 4, 3, 1};

  /// Why `amount` is refused to a subject now; "" when it is given, and given back.
  std::string why(const std::string& subject, std::int64_t amount) {
    try {
      shares.take({subject}, amount, immediately);
    } catch (const Refusal& e) {
      EXPECT_EQ(e.reason, reason::unavailable);
      EXPECT_EQ(e.retry_after, 5);
      return e.what();
    }
    return "";
  }
};

TEST_F(SharesTest, NobodyGetsMoreThanItsShareAndAllNotMoreThanThereIs) {
  const auto two = shares.take({"a"}, 2, immediately);
  EXPECT_EQ(why("a", 1), "");
  EXPECT_EQ(why("a", 2), "too many things at once");
  EXPECT_EQ(why("b", 2), "");
  EXPECT_EQ(why("b", 3), "too many things at once");
  const auto more = shares.take({"b"}, 2, immediately);
  EXPECT_EQ(why("c", 1), "too many things at once");
}

TEST_F(SharesTest, MoreThanAShareCountsAsAShare) {
  EXPECT_EQ(why("a", 1000), "");
  const auto whole = shares.take({"a"}, 1000, immediately);
  EXPECT_EQ(why("b", 1), "");
  EXPECT_EQ(why("b", 2), "too many things at once");
}

TEST_F(SharesTest, AShareThatIsReturnedGoesToWhoWaits) {
  auto held = std::make_unique<Shares::Share>(shares.take({"a"}, 3, immediately));
  std::thread waiting([&] { shares.take({"a"}, 1, an_hour); });
  held.reset();
  waiting.join();
  EXPECT_EQ(why("a", 3), "");
}

TEST_F(SharesTest, WhoLeavesGetsNothing) {
  const auto held = shares.take({"a"}, 3, immediately);
  std::stop_source leaving;
  std::thread waiting([&] { EXPECT_THROW(shares.take({"a", leaving.get_token()}, 1, an_hour), Refusal); });
  leaving.request_stop();
  waiting.join();
}

TEST_F(SharesTest, FewOfOneSubjectMayWait) {
  Shares none("things", 1, 1, 0);
  const auto place = none.take({"a"}, 1, immediately);
  EXPECT_THROW(none.take({"a"}, 1, an_hour), Refusal);  // not even for a moment
}

}  // namespace
}  // namespace talus::service
