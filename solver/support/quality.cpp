#include "support/quality.hpp"

namespace talus {
namespace {

constexpr std::string_view between_reasons = "; ", after_check = ": ";

}  // namespace

std::string verdict_lines(const Quality& quality) {
  std::string text;
  for (const Verdict verdict : {Verdict::invalid, Verdict::doubtful})
    for (const QualityReason& reason : quality.reasons)
      if (reason.verdict == verdict) text += std::string(word(verdict)) + ": " + reason.message + "\n";
  return text;
}

std::string objections_text(const Quality& quality) {
  std::string text;
  for (const QualityReason& reason : quality.reasons) {
    if (!text.empty()) text += between_reasons;
    text += reason.check;
    text += after_check;
    text += reason.message;
  }
  return text;
}

std::vector<Objection> objections_in(std::string_view text) {
  std::vector<Objection> all;
  while (!text.empty()) {
    const std::size_t end = text.find(between_reasons);
    const std::string_view one = text.substr(0, end);
    const std::size_t colon = one.find(after_check);
    all.push_back({.check = std::string(one.substr(0, colon)),
                   .message = colon == std::string_view::npos ? "" : std::string(one.substr(colon + 2))});
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + between_reasons.size());
  }
  return all;
}

std::string words_of_check(std::string check) {
  std::ranges::replace(check, '_', ' ');
  return check;
}

}  // namespace talus
