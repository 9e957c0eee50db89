#include "study/compare.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "statistics/paired.hpp"
#include "support/measures.hpp"

namespace talus {
namespace {

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(); }
Json interval_json(const std::optional<Interval>& of) { return of ? Json({or_null(of->lo), or_null(of->hi)}) : Json(); }

/// Two records of one realization, both done.
using Pair = std::pair<const Record*, const Record*>;

/// The pairs of two tables in order of index.
std::vector<Pair> pairs_of(const Tables& a, const Tables& b) {
  std::vector<Pair> pairs;
  auto of_b = b.runs.begin();
  for (const Record& of_a : a.runs) {
    while (of_b != b.runs.end() && of_b->index < of_a.index) ++of_b;
    if (of_b != b.runs.end() && of_b->index == of_a.index && of_a.done && of_b->done) pairs.emplace_back(&of_a, &*of_b);
  }
  return pairs;
}

/// A number of a record, NaN where it has none.
using Value = std::function<double(const Record&)>;

/// The comparison of one number over the pairs that have it in both.
Json number_json(const std::vector<Pair>& pairs, const Value& value_in_a, const Value& value_in_b) {
  std::vector<double> a, b;
  for (const auto& [of_a, of_b] : pairs) {
    const double in_a = value_in_a(*of_a), in_b = value_in_b(*of_b);
    if (std::isnan(in_a) || std::isnan(in_b)) continue;
    a.push_back(in_a);
    b.push_back(in_b);
  }
  const PairedDifference d = paired_difference(a, b);
  return {{"pairs", d.n},
          {"mean_a", or_null(moments(a).mean)},
          {"mean_b", or_null(moments(b).mean)},
          {"difference", or_null(d.mean)},
          {"difference_ci95", interval_json(d.ci95)},
          {"difference_stdev", or_null(d.stdev)},
          {"correlation", or_null(d.correlation)},
          {"worth_unpaired_runs", or_null(d.worth_runs)}};
}

Json hits_json(const std::vector<Pair>& pairs, std::size_t in_a, std::size_t in_b) {
  std::vector<std::pair<bool, bool>> hits;
  std::int64_t undecided = 0;
  for (const auto& [of_a, of_b] : pairs) {
    const TargetOutcome &a = of_a->targets[in_a], &b = of_b->targets[in_b];
    if ((a.open && !a.arrives) || (b.open && !b.arrives))
      ++undecided;
    else
      hits.emplace_back(a.arrives, b.arrives);
  }
  const PairedHits h = paired_hits(hits);
  return {{"pairs", h.n},
          {"undecided", undecided},
          {"k_a", h.both + h.only_a},
          {"k_b", h.both + h.only_b},
          {"only_a", h.only_a},
          {"only_b", h.only_b},
          {"difference", h.difference},
          {"difference_ci95", interval_json(h.ci95)},
          {"mcnemar_p", h.p_value}};
}

std::optional<std::size_t> place_of(const std::vector<TargetName>& targets, const std::string& name) {
  const auto at = std::ranges::find(targets, name, &TargetName::name);
  return at == targets.end() ? std::nullopt : std::optional(static_cast<std::size_t>(at - targets.begin()));
}

/// A target that both studies have, perhaps as an observed place in one and as a structure in the other.
Json target_json(const std::vector<Pair>& pairs, const std::string& name, std::size_t in_a, std::size_t in_b,
                 bool structure_in_both) {
  Json json = {{"name", name}, {"reached", hits_json(pairs, in_a, in_b)}};
  for (const TargetNumber& number : target_numbers) {
    if (number.structures_only && !structure_in_both) continue;
    const auto of = [&number](std::size_t target) {
      return [&number, target](const Record& record) { return record.targets[target].*number.member; };
    };
    json["numbers"][number.key] = number_json(pairs, of(in_a), of(in_b));
  }
  return json;
}

bool has_independent_layers(const Json& field) {
  const Json properties = field.value("properties", Json::object());
  return std::ranges::any_of(properties, [](const Json& of) { return of.value("layers", "") == "independent"; });
}

/// "upper, lower": the materials of a resolved case in the order that numbers their draws.
std::string layer_names(const Json& document) {
  const Json none = Json::object();
  std::string names = document.value("material", none).value("name", "");
  for (const Json& outline : document.value("slide", none).value("outlines", Json::array()))
    if (outline.contains("material")) names += ", " + outline["material"].value("name", std::string());
  return names;
}

void check_draws(const Tables& a, const Tables& b, const Json& case_a, const Json& case_b) {
  std::vector<Fault> faults;
  const auto differ = [&](const std::string& what, const std::string& of_a, const std::string& of_b) {
    if (of_a != of_b)
      faults.push_back({"", "the studies cannot be paired, since their draws differ: " + what + " is " + of_a +
                                " in the first and " + of_b + " in the second"});
  };
  differ("the seed", std::to_string(a.plan.seed), std::to_string(b.plan.seed));
  const auto hypercube = [](const Plan& plan) {
    return plan.study.sampling == Sampling::latin_hypercube
               ? "a Latin hypercube of " + std::to_string(plan.study.realizations) + " in " +
                     std::to_string(plan.study.stratified_modes) + " modes"
               : std::string("Monte Carlo");
  };
  differ("study.sampling", hypercube(a.plan), hypercube(b.plan));
  const Json none = Json::object();
  const Json field_a = case_a.value("random_field", none), field_b = case_b.value("random_field", none);
  const auto refuse = [&](const std::string& key) {
    faults.push_back({key, "differs: the studies cannot be paired, since their draws differ"});
  };
  for (const std::string& key : differences(field_a, field_b)) refuse("/random_field" + key);
  if (!field_a.contains("domain_m"))
    for (const std::string& key : differences(case_a.value("slide", none), case_b.value("slide", none)))
      if (key.find("/outline_m") != std::string::npos || key.find("_surface_m") != std::string::npos)
        refuse("/slide" + key);
  if (field_a.value("nugget", 0.0) > 0.0)  // drawn at the places of the particles
    for (const char* key : {"particle_spacing_m", "particle_placement", "particle_lattice"})
      if (case_a.value(key, none) != case_b.value(key, none)) refuse("/" + std::string(key));
  if (has_independent_layers(field_a) && layer_names(case_a) != layer_names(case_b))
    faults.push_back({"/slide/outlines",
                      "differs: the studies cannot be paired, since each layer has draws of its own, and the layers "
                      "are " +
                          layer_names(case_a) + " in the first and " + layer_names(case_b) + " in the second"});
  if (!faults.empty()) throw ConfigError(std::move(faults));
}

}  // namespace

std::vector<std::string> differences(const Json& a, const Json& b) {
  if (a == b) return {};
  const bool objects = a.is_object() && b.is_object(), lists = a.is_array() && b.is_array() && a.size() == b.size();
  if (!objects && !lists) return {""};
  std::vector<std::string> all;
  const auto add = [&](const std::string& key, const Json* in_a, const Json* in_b) {
    if (in_a == nullptr || in_b == nullptr)
      all.push_back("/" + key);
    else
      for (const std::string& below : differences(*in_a, *in_b)) all.push_back("/" + key + below);
  };
  if (lists) {
    for (std::size_t k = 0; k < a.size(); ++k) add(std::to_string(k), &a[k], &b[k]);
    return all;
  }
  for (const auto& [key, value] : a.items()) add(key, &value, b.contains(key) ? &b.at(key) : nullptr);
  for (const auto& [key, value] : b.items())
    if (!a.contains(key)) add(key, nullptr, &value);
  return all;
}

Json comparison(const Tables& a, const Tables& b, const Json& case_a, const Json& case_b) {
  check_draws(a, b, case_a, case_b);
  const std::vector<Pair> pairs = pairs_of(a, b);
  Json json = {{"title_a", a.plan.title}, {"title_b", b.plan.title}, {"seed", a.plan.seed}};
  const auto failed = [](const Tables& of) { return std::ranges::count(of.runs, false, &Record::done); };
  json["pairs"] = pairs.size();
  json["failed_a"] = failed(a);
  json["failed_b"] = failed(b);
  json["case_differences"] = differences(case_a, case_b);
  for (const Measure* measure : reading_order()) {
    const auto value = [measure](const Record& record) { return record.measures.*measure->member; };
    json["quantities"][measure->key] = number_json(pairs, value, value);
  }
  for (std::size_t in_a = 0; in_a < a.plan.targets.size(); ++in_a) {
    const TargetName& target = a.plan.targets[in_a];
    if (const std::optional<std::size_t> in_b = place_of(b.plan.targets, target.name))
      json["targets"].push_back(
          target_json(pairs, target.name, in_a, *in_b,
                      target.kind == TargetKind::structure && b.plan.targets[*in_b].kind == TargetKind::structure));
  }
  return json;
}

namespace {

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

std::string number_text(const Json& value, const char* pattern = "%.4g") {
  return value.is_number() ? format(pattern, value.get<double>()) : "-";
}
std::string interval_text(const Json& of) {
  return of.is_array() ? "[" + number_text(of[0]) + ", " + number_text(of[1]) + "]" : "-";
}

std::string line_of(const std::string& name, const Json& of) {
  return format("%-36s %10s %10s %10s  %-22s %6s %9s\n", name.c_str(), number_text(of.at("mean_a")).c_str(),
                number_text(of.at("mean_b")).c_str(), number_text(of.at("difference")).c_str(),
                interval_text(of.at("difference_ci95")).c_str(), number_text(of.at("correlation"), "%.2f").c_str(),
                number_text(of.at("worth_unpaired_runs"), "%.0f").c_str());
}

std::string reached_text(const std::string& name, const Json& of) {
  std::string text = format("%s reached: %lld and %lld of %lld, difference %+.3f, 95 %% %s, McNemar's exact p = %.2g",
                            name.c_str(), of.at("k_a").get<long long>(), of.at("k_b").get<long long>(),
                            of.at("pairs").get<long long>(), of.at("difference").get<double>(),
                            interval_text(of.at("difference_ci95")).c_str(), of.at("mcnemar_p").get<double>());
  if (const auto undecided = of.at("undecided").get<long long>(); undecided > 0)
    text += format("; %lld undecided pairs left out", undecided);
  return text + "\n";
}

}  // namespace

std::string comparison_text(const Json& comparison) {
  std::string text = "A: " + comparison.at("title_a").get<std::string>() +
                     "\nB: " + comparison.at("title_b").get<std::string>() + "\n" +
                     format("%lld pairs on the same draws, seed %s; failed: %lld in A, %lld in B\n",
                            comparison.at("pairs").get<long long>(), comparison.at("seed").dump().c_str(),
                            comparison.at("failed_a").get<long long>(), comparison.at("failed_b").get<long long>());
  for (const Json& key : comparison.at("case_differences")) text += "differs: " + key.get<std::string>() + "\n";
  text += format("\n%-36s %10s %10s %10s  %-22s %6s %9s\n", "", "mean of A", "mean of B", "B - A", "95 % interval",
                 "corr.", "worth");
  for (const auto& [key, of] : comparison.at("quantities").items()) text += line_of(key, of);
  for (const Json& target : comparison.value("targets", Json::array())) {
    const std::string name = target.at("name");
    text += "\n" + reached_text(name, target.at("reached"));
    for (const auto& [key, of] : target.at("numbers").items()) text += line_of(name + "." + key, of);
  }
  return text + "\nworth: runs of each study that would give as narrow an interval with draws of their own\n";
}

}  // namespace talus
