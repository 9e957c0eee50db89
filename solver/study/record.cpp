#include "study/record.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "support/digest.hpp"
#include "support/files.hpp"
#include "support/json.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_result_bytes = std::size_t{1} << 20;

constexpr std::string_view invalid = "invalid result: ";

/// Verdict and objections of a result; a result without them was not assessed.
void read_quality(const Json& json, Record& record) {
  const auto found = json.find("quality");
  if (found == json.end()) return;
  Quality quality;
  for (const Json& reason : found->at("reasons"))
    quality.reasons.push_back({.check = reason.at("check"), .message = reason.at("message")});
  const std::optional<Verdict> verdict = verdict_of(found->at("verdict").get<std::string>());
  if (!verdict) throw IoError("unknown verdict");
  record.verdict = *verdict;
  record.objections = objections_text(quality);
}

/// The targets of a result, or those that the queue keeps.
TargetOutcome target_of(const Json& json) {
  TargetOutcome target;
  target.of.name = json.at("name");
  const auto kind = std::ranges::find(target_kind_words, json.at("kind").get<std::string>());
  if (kind == target_kind_words.end()) throw IoError("unknown kind of target");
  target.of.kind = static_cast<TargetKind>(kind - target_kind_words.begin());
  json.at(arrives_key).get_to(target.arrives);
  json.at(open_key).get_to(target.open);
  for (const TargetNumber& number : target_numbers) {
    if (!has_number(target.of.kind, number)) continue;
    if (const Json& value = json.at(number.key); !value.is_null() || !number.optional)
      value.get_to(target.*number.member);
    if (std::abs(target.*number.member) > largest_number) throw IoError("a number that no run has");
  }
  return target;
}

constexpr const char* snapshots_ending = ".vtkhdf";

/// FNV-1a of a file's content. @throws IoError
std::string content_hash(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::vector<char> block(std::size_t{1} << 20);
  std::uint64_t hash = fnv1a64_start;
  do {
    in.read(block.data(), static_cast<std::streamsize>(block.size()));
    hash = fnv1a64({block.data(), static_cast<std::size_t>(in.gcount())}, hash);
  } while (in);
  if (!in.eof()) throw IoError(file.string() + " cannot be read");
  return hex_digits(hash);
}

/// Puts a second name on a file, or a copy where the file system has no links; by rename.
void link_or_copy(const fs::path& from, const fs::path& to) {
  const fs::path temporary = to.parent_path() / (to.filename().string() + ".tmp-profile");
  fs::remove(temporary);
  std::error_code error;
  fs::create_hard_link(from, temporary, error);
  if (error) fs::copy_file(from, temporary);
  fs::rename(temporary, to);
}

}  // namespace

bool Record::is_lower_bound(const Measure& measure) const {
  return (" " + lower_bounds + " ").find(" " + std::string(measure.key) + " ") != std::string::npos;
}

bool is_later(std::string_view key) {
  const auto later = [&](const auto& of) { return of.later && of.key == key; };
  return std::ranges::any_of(covariate_table, later) || std::ranges::any_of(measure_table, later);
}

bool is_optional(std::string_view key) {
  const Measure* measure = find_measure(key);
  return measure && measure->optional;
}

bool may_be_missing(std::string_view key) {
  return is_later(key) || (find_measure(key) && key != measure_table[0].key);
}

std::vector<TargetOutcome> read_outcomes(const Json& list) {
  std::vector<TargetOutcome> targets;
  for (const Json& target : list) targets.push_back(target_of(target));
  return targets;
}

Json outcomes_json(const std::vector<TargetOutcome>& targets) {
  Json list = Json::array();
  for (const TargetOutcome& target : targets) {
    Json& json = list.emplace_back(Json{{"name", target.of.name}, {"kind", word(target.of.kind)}});
    json[arrives_key] = target.arrives;
    json[open_key] = target.open;
    for (const TargetNumber& number : target_numbers)
      if (has_number(target.of.kind, number))
        json[number.key] = std::isnan(target.*number.member) ? Json() : Json(target.*number.member);
  }
  return list;
}

std::string reason_of_invalid(const std::string& objections) { return std::string(invalid) + objections; }

Record failed_record(std::int64_t index, std::string reason) {
  Record record{.index = index, .reason = std::move(reason)};
  if (record.reason.starts_with(invalid)) {
    record.verdict = Verdict::invalid;
    record.objections = record.reason.substr(invalid.size());
  }
  return record;
}

std::optional<Record> read_result(const fs::path& file, const RunKey& key, const StudyIdentity& of) {
  if (!fs::exists(file)) return std::nullopt;
  const auto read = [&](const Json& json) -> std::optional<Record> {
    Record record{.index = key.index, .done = true};
    visit_numbers(record, [&](const char* name, const char* object, auto& value) {
      const Json& place = object ? json.at(object) : json;
      if (may_be_missing(name) && (!place.contains(name) || (is_optional(name) && place.at(name).is_null())))
        value = std::numeric_limits<std::remove_reference_t<decltype(value)>>::quiet_NaN();
      else
        place.at(name).get_to(value);
      if (std::abs(static_cast<double>(value)) > largest_number) throw IoError("a number that no run has");
    });
    json.at("digest").get_to(record.digest);
    for (const Json& measure : json.value("lower_bounds", Json::array()))
      record.lower_bounds += (record.lower_bounds.empty() ? "" : " ") + measure.get<std::string>();
    record.targets = read_outcomes(json.value("targets", Json::array()));
    const bool interrupted = json.at("ending") == "interrupted";
    const auto hash = json.at("provenance").at("case_hash").get<std::string>();
    const bool earlier = std::ranges::find(of.earlier, hash) != of.earlier.end();
    const Json& from = json.at("provenance");
    if (from.at("seed") != of.seed || (hash != of.case_hash && !earlier) ||
        from.at("realization") != key.drawn_realization() || from.at("perturbation").is_null() == key.is_replicate())
      throw ForeignResult(
          file.string() +
          " is of another run or study (seed, case hash, realization or perturbation differ); remove it");
    const bool too_short = earlier && !json.at("at_rest").get<bool>();
    if (interrupted || too_short) return std::nullopt;
    read_quality(json, record);
    if (record.verdict == Verdict::invalid) return failed_record(record.index, reason_of_invalid(record.objections));
    return record;
  };
  try {
    return read_json(file, max_result_bytes, "the result of a run", read);
  } catch (const ForeignResult&) {
    throw;
  } catch (const IoError&) {
    return std::nullopt;
  }
}

void write_failure(const StudyPaths& paths, const RunKey& key, const Failure& failure, std::int64_t attempts,
                   std::uint64_t seed) {
  const Json json = {{"job", run_name(key)},
                     {"reason", failure.reason},
                     {"exit_code", failure.exit_code ? Json(*failure.exit_code) : Json()},
                     {"signal", failure.signal ? Json(*failure.signal) : Json()},
                     {"attempts", attempts},
                     {"log_tail", failure.log_tail},
                     {"rerun", replay_command(key, seed, paths.resolved_case().string())}};
  write_file_atomically(paths.failure(key), with_checksum(json));
}

std::optional<std::string> read_failure(const fs::path& file) try {
  return read_json(file, max_result_bytes, "a failure record",
                   [](const Json& json) { return json.at("reason").get<std::string>(); });
} catch (const IoError&) {
  return std::nullopt;
}

void keep_profiles(const StudyPaths& paths, const RunKey& key, double influence_zone, bool farthest) {
  const fs::path snapshots = paths.work(key) / "snapshots.vtkhdf";
  if (key.is_replicate() || !fs::exists(snapshots)) return;
  const auto keep = [&](const std::string& profile) {
    const fs::path place = paths.profiles() / profile;
    link_or_copy(snapshots, fs::path(place).concat(snapshots_ending));
    write_file_atomically(fs::path(place).concat(".json"), with_checksum({{"realization", key.index},
                                                                          {"influence_zone_m", influence_zone},
                                                                          {"snapshots", content_hash(snapshots)}}));
  };
  if (key.index == 0) keep(first_profile);
  if (farthest) keep(farthest_profile);
}

bool is_damaged_profile(const StudyPaths& paths, const std::string& profile) try {
  const fs::path place = paths.profiles() / profile, about = fs::path(place).concat(".json");
  if (!fs::exists(about)) return false;
  const auto hash = read_json(about, max_result_bytes, "the description of a profile", [](const Json& json) {
    return json.value("snapshots", std::string());  // of an earlier version without
  });
  return !hash.empty() && hash != content_hash(fs::path(place).concat(snapshots_ending));
} catch (const IoError&) {
  return true;
}

std::vector<std::int64_t> damaged_profiles(const StudyPaths& paths, std::optional<std::int64_t> farthest) {
  std::vector<std::int64_t> damaged;
  if (is_damaged_profile(paths, first_profile)) damaged.push_back(0);
  if (farthest && farthest != 0 && is_damaged_profile(paths, farthest_profile)) damaged.push_back(*farthest);
  return damaged;
}

}  // namespace talus
