// Times as text and back.

#include <gtest/gtest.h>

#include "base/clock.hpp"

namespace talus::service {
namespace {

TEST(Clock, TextAndBack) {
  for (const Milliseconds time : {Milliseconds{0}, Milliseconds{1'769'860'800'123}, Milliseconds{951'827'696'000}})
    EXPECT_EQ(utc_time(utc_text(time)), time);
  EXPECT_EQ(utc_text(1'769'860'800'123), "2026-01-31T12:00:00.123Z");
}

TEST(Clock, DatesOfHttp) {
  EXPECT_EQ(http_date(784'111'777'999), "Sun, 06 Nov 1994 08:49:37 GMT");  // RFC 9110 5.6.7
}

TEST(Clock, EveryFormOfRfc3339) {
  const Milliseconds noon = 1'769'860'800'000;
  EXPECT_EQ(utc_time("2026-01-31T12:00:00Z"), noon);
  EXPECT_EQ(utc_time("2026-01-31t12:00:00z"), noon);
  EXPECT_EQ(utc_time("2026-01-31T13:30:00+01:30"), noon);
  EXPECT_EQ(utc_time("2026-01-31T07:00:00-05:00"), noon);
  EXPECT_EQ(utc_time("2026-01-31T12:00:00.5Z"), noon + 500);
  EXPECT_EQ(utc_time("2026-01-31T12:00:00.1239Z"), noon + 123);
  EXPECT_EQ(utc_time("2024-02-29T00:00:00Z"), 1'709'164'800'000);
}

TEST(Clock, WhatIsNoTime) {
  for (const char* text :
       {"", "2026-01-31", "2026-01-31T12:00:00", "2026-01-31 12:00:00Z", "2026-02-29T00:00:00Z", "2026-13-01T00:00:00Z",
        "2026-01-31T24:00:00Z", "2026-01-31T12:60:00Z", "2026-01-31T12:00:61Z", "2026-01-31T12:00:00.Z",
        "2026-01-31T12:00:00+24:00", "2026-01-31T12:00:00Zx", "-026-01-31T12:00:00Z", "2026-01-31T12:00:00+1:00"})
    EXPECT_FALSE(utc_time(text)) << text;
}

}  // namespace
}  // namespace talus::service
