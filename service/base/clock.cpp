#include "base/clock.hpp"

#include <chrono>
#include <cstdio>
#include <ctime>

namespace talus::service {
namespace {

/// What is left of a text to be read.
struct Reader {
  std::string_view rest;
  bool good = true;

  /// Takes exactly `n` digits.
  int digits(std::size_t n) {
    int value = 0;
    for (std::size_t i = 0; i < n; ++i) {
      good = good && i < rest.size() && rest[i] >= '0' && rest[i] <= '9';
      if (good) value = 10 * value + (rest[i] - '0');
    }
    if (good) rest.remove_prefix(n);
    return value;
  }
  /// Takes one character, which must be among `any`.
  char one_of(std::string_view any) {
    good = good && !rest.empty() && any.find(rest.front()) != std::string_view::npos;
    if (!good) return 0;
    const char taken = rest.front();
    rest.remove_prefix(1);
    return taken;
  }
};

}  // namespace

Milliseconds system_now() {
  using namespace std::chrono;
  return duration_cast<milliseconds>(system_clock::now().time_since_epoch()).count();
}

std::string utc_text(Milliseconds time) {
  const auto seconds = static_cast<std::time_t>(time / 1000);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char day[32], text[48];
  std::strftime(day, sizeof day, "%Y-%m-%dT%H:%M:%S", &parts);
  std::snprintf(text, sizeof text, "%s.%03dZ", day, static_cast<int>(time % 1000));
  return text;
}

std::string http_date(Milliseconds time) {
  const auto seconds = static_cast<std::time_t>(time / 1000);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char text[48];
  std::strftime(text, sizeof text, "%a, %d %b %Y %H:%M:%S GMT", &parts);
  return text;
}

std::optional<Milliseconds> utc_time(std::string_view text) {
  using namespace std::chrono;
  Reader reader{text};
  const int y = reader.digits(4);
  reader.one_of("-");
  const int mon = reader.digits(2);
  reader.one_of("-");
  const int d = reader.digits(2);
  reader.one_of("Tt");
  const int h = reader.digits(2);
  reader.one_of(":");
  const int min = reader.digits(2);
  reader.one_of(":");
  const int s = reader.digits(2);
  int ms = 0;
  if (reader.good && reader.rest.starts_with('.')) {
    reader.rest.remove_prefix(1);
    for (int place = 100; place == 100 || (!reader.rest.empty() && reader.rest[0] >= '0' && reader.rest[0] <= '9');
         place /= 10)
      ms += place * reader.digits(1);
  }
  const char sign = reader.one_of("Zz+-");
  int offset = 0;  // [min]
  if (sign == '+' || sign == '-') {
    const int hours = reader.digits(2);
    reader.one_of(":");
    const int minutes = reader.digits(2);
    reader.good = reader.good && hours < 24 && minutes < 60;
    offset = (sign == '+' ? 1 : -1) * (60 * hours + minutes);
  }
  const year_month_day day{year(y), month(static_cast<unsigned>(mon)), std::chrono::day(static_cast<unsigned>(d))};
  if (!reader.good || !reader.rest.empty() || !day.ok() || h > 23 || min > 59 || s > 60) return std::nullopt;
  const auto time = sys_days(day).time_since_epoch() + hours(h) + minutes(min - offset) + seconds(s) + milliseconds(ms);
  return duration_cast<milliseconds>(time).count();
}

}  // namespace talus::service
