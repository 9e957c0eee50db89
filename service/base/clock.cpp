#include "base/clock.hpp"

#include <chrono>
#include <ctime>
#include <regex>

namespace talus::service {
namespace {

/// @param format  of strftime
std::string formatted(Milliseconds time, const char* format) {
  const auto seconds = static_cast<std::time_t>(time / 1000);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char text[48];
  return {text, std::strftime(text, sizeof text, format, &parts)};
}

}  // namespace

Milliseconds system_now() {
  using namespace std::chrono;
  return duration_cast<milliseconds>(system_clock::now().time_since_epoch()).count();
}

std::string utc_text(Milliseconds time) {
  return formatted(time, "%Y-%m-%dT%H:%M:%S.") + std::to_string(1000 + time % 1000).substr(1) + "Z";
}

std::string http_date(Milliseconds time) { return formatted(time, "%a, %d %b %Y %H:%M:%S GMT"); }

std::optional<Milliseconds> utc_time(const std::string& text) {
  using namespace std::chrono;
  static const std::regex date_time(
      R"((\d{4})-(\d\d)-(\d\d)[Tt](\d\d):(\d\d):(\d\d)(?:\.(\d{1,3})\d*)?(?:[Zz]|([+-])(\d\d):(\d\d)))");
  std::smatch parts;
  if (!std::regex_match(text, parts, date_time)) return std::nullopt;
  const auto part = [&](std::size_t i) { return parts[i].matched ? std::stoi(parts[i]) : 0; };
  const int h = part(4), min = part(5), s = part(6), ms = std::stoi((parts[7].str() + "000").substr(0, 3));
  const int offset = (parts[8] == "-" ? -1 : 1) * (60 * part(9) + part(10));  // [min]
  const year_month_day date{year(part(1)), month(static_cast<unsigned>(part(2))), day(static_cast<unsigned>(part(3)))};
  if (!date.ok() || h > 23 || min > 59 || s > 60 || part(9) > 23 || part(10) > 59) return std::nullopt;
  const auto time =
      sys_days(date).time_since_epoch() + hours(h) + minutes(min - offset) + seconds(s) + milliseconds(ms);
  return duration_cast<milliseconds>(time).count();
}

}  // namespace talus::service
