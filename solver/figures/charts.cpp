#include "figures/charts.hpp"

namespace talus::figures {

std::string count_text(const StudyFiles& study) {
  if (study.done == study.planned) return std::to_string(study.done) + " realizations";
  std::string text = std::to_string(study.done) + " of " + std::to_string(study.planned) + " realizations done";
  if (study.failed > 0) text += ", " + std::to_string(study.failed) + " failed";
  return text;
}

std::string interval_text(const std::optional<double>& value, const std::optional<Interval>& interval) {
  if (!value) return "unknown";
  std::string text = fixed(*value, 2);
  if (interval && interval->lo && interval->hi)
    text += " [" + fixed(*interval->lo, 2) + ", " + fixed(*interval->hi, 2) + "]";
  return text + " m";
}

Stamps chart_stamps(const StudyFiles& study, std::string subtitle) {
  return {study.title, std::move(subtitle), study.source + "  ·  " + count_text(study)};
}

}  // namespace talus::figures
