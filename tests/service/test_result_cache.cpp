#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "jobs/result_cache.hpp"

namespace talus::service {
namespace {

constexpr std::chrono::hours year{24 * 365};  ///< longer than this machine has been up
using std::chrono::milliseconds;

struct ResultCacheTest : testing::Test {
  ResultCache cache;
  std::atomic<int> made{0};

  Json get(const std::string& key, std::int64_t version, milliseconds max_age = {}) {
    return cache.get(key, version, max_age, [&] { return Json(++made); });
  }
};

TEST_F(ResultCacheTest, OneVersionIsComputedOnce) {
  EXPECT_EQ(get("a", 0), 1);
  EXPECT_EQ(get("a", 0), 1);
  EXPECT_EQ(get("b", 0), 2);
  EXPECT_EQ(get("a", 1), 3);
}

TEST_F(ResultCacheTest, AYoungResultOfAnEarlierVersionIsReturned) {
  EXPECT_EQ(get("a", 0, year), 1);
  EXPECT_EQ(get("a", 1, year), 1);
  EXPECT_EQ(get("a", 1, milliseconds(0)), 2);
}

TEST_F(ResultCacheTest, ConcurrentRequestsComputeItOnce) {
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i)
    threads.emplace_back([&] {
      const Json answer = cache.get("a", 7, {}, [&] {
        std::this_thread::sleep_for(milliseconds(20));
        return Json(++made);
      });
      EXPECT_EQ(answer, 1);
    });
  for (std::thread& thread : threads) thread.join();
}

TEST_F(ResultCacheTest, AfterAnExceptionTheNextRequestTriesAgain) {
  EXPECT_THROW(cache.get("a", 0, year, []() -> Json { throw std::runtime_error("x"); }), std::runtime_error);
  EXPECT_EQ(get("a", 0, year), 1);
}

TEST_F(ResultCacheTest, HoldsAtMost64Results) {
  for (int i = 0; i < 64; ++i) get(std::to_string(i), 0);
  EXPECT_EQ(get("0", 0), 1);
  EXPECT_EQ(get("64", 0), 65);
  EXPECT_EQ(get("0", 0), 66);
  EXPECT_EQ(get("64", 0), 65);
}

}  // namespace
}  // namespace talus::service
