#include "base/log.hpp"

#include <unistd.h>

#include "base/clock.hpp"

namespace talus::service {

void log_line(const char* level, const std::string& event, const Json& fields) {
  Json line = {{"time", utc_text(system_now())}, {"level", level}, {"event", event}};
  line.update(fields);
  const std::string text = dump(line) + "\n";
  // One write, so that lines of several threads do not mix; a log that cannot be written stops nothing.
  [[maybe_unused]] const ssize_t ignored = ::write(STDERR_FILENO, text.data(), text.size());
}

}  // namespace talus::service
