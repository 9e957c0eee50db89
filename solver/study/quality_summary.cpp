#include "study/quality_summary.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "support/text.hpp"

namespace talus {
namespace {

constexpr const char* noise_check = "noise_near_spread";

/// The message of the noise check; nothing where noise is small or unknown.
std::optional<std::string> noise_objection(const SampleMoments& runout, const SampleMoments& noise) {
  if (!runout.stdev || !noise.stdev || *noise.stdev <= most_noise * *runout.stdev) return std::nullopt;
  return "the farthest particle has a standard deviation of " + rounded(*runout.stdev) + " m, its numerical noise " +
         rounded(*noise.stdev) + " m, more than a third of it";
}

}  // namespace

void QualityCounts::add(const Record& record) {
  switch (record.verdict) {
    case Verdict::not_assessed:
      not_assessed += record.done ? 1 : 0;
      return;
    case Verdict::sound:
      ++sound;
      return;
    case Verdict::doubtful:
      ++doubtful;
      return;
    case Verdict::invalid:
      ++invalid;
      return;
  }
}

Json QualityCounts::json() const {
  return {{"sound", sound}, {"doubtful", doubtful}, {"invalid", invalid}, {"not_assessed", not_assessed}};
}

void QualitySummary::add(const Record& record) {
  counts_.add(record);
  for (Objection& objection : objections_in(record.objections)) {
    Objections& all = objections_[objection.check];
    if (all.runs++ == 0) all.example = std::move(objection.message);
  }
}

Json QualitySummary::json(const SampleMoments& runout, const SampleMoments& noise) const {
  Json reasons = Json::array();
  for (const auto& [check, of] : objections_)
    reasons.push_back({{"check", check}, {"runs", of.runs}, {"example", of.example}});
  std::stable_sort(reasons.begin(), reasons.end(), [](const Json& a, const Json& b) { return a["runs"] > b["runs"]; });
  const std::optional<std::string> noisy = noise_objection(runout, noise);
  if (noisy) reasons.push_back({{"check", noise_check}, {"runs", runout.n}, {"example", *noisy}});
  const bool assessed = counts_.sound + counts_.doubtful + counts_.invalid > 0;
  const bool objected = counts_.doubtful + counts_.invalid > 0 || noisy;
  Json json = {{"verdict", word(objected ? Verdict::doubtful : assessed ? Verdict::sound : Verdict::not_assessed)}};
  json.update(counts_.json());
  json["reasons"] = std::move(reasons);
  return json;
}

std::string quality_line(const Json& quality) {
  const auto append = [](std::string& list, const std::string& item) { list += (list.empty() ? "" : ", ") + item; };
  std::int64_t runs = 0;
  for (const char* verdict : verdict_words) runs += quality.at(verdict).get<std::int64_t>();
  std::string verdicts, why;
  for (const Verdict verdict : {Verdict::doubtful, Verdict::invalid, Verdict::not_assessed}) {
    const auto count = quality.at(word(verdict)).get<std::int64_t>();
    if (count == 0) continue;
    const std::string of_all = verdicts.empty() ? " of " + std::to_string(runs) + " runs " : " ";
    append(verdicts, std::to_string(count) + of_all + words_of_check(word(verdict)));
  }
  for (const Json& reason : quality.at("reasons")) {
    const auto check = reason.at("check").get<std::string>();
    const bool of_study = check == noise_check;
    if (of_study) append(verdicts, "study doubtful");
    append(why, of_study ? reason.at("example").get<std::string>()
                         : words_of_check(check) + " (" + std::to_string(reason.at("runs").get<std::int64_t>()) + ")");
  }
  return why.empty() ? verdicts : verdicts + ": " + why;
}

}  // namespace talus
