// Extensions of a job that is a study: its current histogram, its realizations, retry and extend.

#include <algorithm>

#include "http/lookup.hpp"
#include "http/text.hpp"
#include "support/text.hpp"

namespace talus::service {
namespace {

constexpr int max_bins = 1000, max_edges = 1001;
constexpr std::int64_t most_realizations = 1'000'000'000;

std::vector<double> edges_of(const Incoming& request) {
  std::vector<double> edges;
  const auto text = request.parameter("edges");
  if (!text) return edges;
  for (const std::string& part : split(*text, ',')) {
    const std::optional<double> value = to_number(part);
    if (!value) bad_parameter("edges", "must be numbers separated by commas");
    edges.push_back(*value);
  }
  const bool grow = std::adjacent_find(edges.begin(), edges.end(), std::greater_equal<>()) == edges.end();
  if (edges.size() < 2 || edges.size() > max_edges || !grow)
    bad_parameter("edges", "must be 2 to 1001 increasing numbers");
  return edges;
}

/// From every bin to the runs in it.
Json bins_of(const Json& distribution, const Exchange& exchange, const Job& job) {
  const Json& histogram = distribution.at("histogram");
  const Json &edges = histogram.at("edges"), &counts = histogram.at("counts");
  Json bins = Json::array();
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const bool last = i + 1 == counts.size();
    const std::string query = "?quantity=" + distribution.at("quantity").get<std::string>() +
                              "&min=" + edges[i].dump() + (last ? "&max=" : "&below=") + edges[i + 1].dump();
    bins.push_back({{"from", edges[i]},
                    {"to", edges[i + 1]},
                    {"count", counts[i]},
                    {"href", exchange.base + "/jobs/" + job.id + "/realizations" + query}});
  }
  return bins;
}

Answer exceedance(Exchange& exchange) {
  only_parameters(exchange.request, {"quantity", "x"});
  const Job job = study_of(exchange);
  const auto name = exchange.request.parameter("quantity");
  const auto text = exchange.request.parameter("x");
  const std::optional<double> x = text ? to_number(*text) : std::nullopt;
  if (text && !x) bad_parameter("x", "must be a number");
  const std::string asked = Json::parse(job.inputs).at("quantity");
  return json_answer(exchange.service.jobs.exceedance(job, name.value_or(asked), x));
}

Answer histogram(Exchange& exchange) {
  const Incoming& request = exchange.request;
  const Job job = study_of(exchange);
  only_parameters(request, {"quantity", "bins", "edges"});
  const std::string name = request.parameter("quantity").value_or(Json::parse(job.inputs).at("quantity"));
  const Measure& quantity = quantity_of(name, "?quantity");
  const auto bins = whole_number(request, "bins", 1, max_bins);
  const std::vector<double> edges = edges_of(request);
  if (bins && !edges.empty()) bad_parameter("bins", "cannot be combined with edges");
  Json answer = exchange.service.jobs.distribution(
      job, quantity, {.count = static_cast<std::size_t>(bins.value_or(0)), .edges = edges});
  answer["partial"] = !ended(job.state);
  answer["bins"] = bins_of(answer, exchange, job);
  return json_answer(answer);
}

std::string path_of(const Job& job, std::int64_t index) {
  return "/jobs/" + job.id + "/realizations/" + std::to_string(index);
}

Json brief(const Run& run, const Exchange& exchange, const Job& job) {
  Json json = {{"index", run.key.index}, {"state", word(run.state)}};
  if (run.result) {
    for (const Measure& measure : measure_table) json["measures"][measure.key] = run.result->measures.*measure.member;
    json["digest"] = run.result->digest;
    json["lower_bounds"] = Json::array();
    for (const Measure& measure : measure_table)
      if (run.result->is_lower_bound(measure)) json["lower_bounds"].push_back(measure.key);
  }
  if (run.failure) json["reason"] = run.failure->reason;
  if (run.result || run.failure) {
    const Record record = run.result ? *run.result : failed_record(run.key.index, run.failure->reason);
    json["verdict"] = word(record.verdict);
    if (!record.objections.empty()) json["verdict_reasons"] = record.objections;
  }
  json["href"] = exchange.base + path_of(job, run.key.index);
  return json;
}

Answer list_realizations(Exchange& exchange) {
  const Incoming& request = exchange.request;
  const Job job = study_of(exchange);
  only_parameters(request, {"state", "quantity", "min", "below", "max", "after", "limit"});
  RunFilter filter;
  if (const auto name = request.parameter("state")) {
    filter.state = run_state(*name);
    if (!filter.state) bad_parameter("state", "must be queued, leased, done or failed");
  }
  filter.measure = &quantity_of(request.parameter("quantity").value_or(measure_table[0].key), "?quantity");
  filter.least = real_number(request, "min");
  filter.below = real_number(request, "below");
  filter.most = real_number(request, "max");
  filter.after = whole_number(request, "after", -1, most_realizations).value_or(-1);
  const int limit = page_limit(request);
  filter.limit = limit + 1;  // one more, to see whether there is a next page
  std::vector<Run> runs = exchange.service.store.runs(job.number, filter);
  const bool more = runs.size() > static_cast<std::size_t>(limit);
  if (more) runs.resize(static_cast<std::size_t>(limit));
  Json all = Json::array(), links = Json::array();
  for (const Run& run : runs) all.push_back(brief(run, exchange, job));
  if (more) links.push_back(next_link(exchange, "after", runs.back().key.index));
  return json_answer({{"realizations", all}, {"links", links}});
}

Run run_of(const Exchange& exchange, const Job& job) {
  const std::int64_t index = to_whole(exchange.captured.at(1)).value_or(-1);
  const std::optional<Run> run = exchange.service.store.run(job.number, realization(index));
  if (!run) throw Refusal(reason::not_found, "the study has no such realization");
  return *run;
}

Answer one(Exchange& exchange) {
  const Job job = study_of(exchange);
  const Run run = run_of(exchange, job);
  Json json = brief(run, exchange, job);
  json["seed"] = job.seed;
  json["case_hash"] = job.case_hash;
  json["attempt"] = run.attempt;
  json["command"] = replay_command(run.key, static_cast<std::uint64_t>(job.seed), "case.resolved.json");
  if (run.result) {
    json["mean_friction_angle_deg"] = run.result->mean_phi_deg;
    json["steps"] = run.result->steps;
    json["wall_clock_s"] = run.result->wall_clock;
  }
  if (run.failure) {
    if (run.failure->exit_code) json["exit_code"] = *run.failure->exit_code;
    if (run.failure->signal) json["signal"] = *run.failure->signal;
    json["log_tail"] = run.failure->log_tail;
  }
  const std::string path = path_of(job, run.key.index);
  json["links"] = {link(exchange, path, "self", "This realization"),
                   link(exchange, path + "/field", "related", "Friction angles before failure"),
                   link(exchange, path + "/profile", "related", "Profile at the end of the run")};
  return json_answer(json);
}

/// ?format=json|svg, else what the client accepts, else JSON.
bool wants_svg(const Incoming& request) {
  only_parameters(request, {"format"});
  const auto format = request.parameter("format");
  if (!format) return request.header("accept").find("image/svg+xml") != std::string::npos;
  if (*format != "json" && *format != "svg") bad_parameter("format", "must be json or svg");
  return *format == "svg";
}

/// A file that `make` makes of one run, as SVG or JSON.
Answer picture(Exchange& exchange, std::string (Jobs::*make)(const Job&, std::int64_t, bool, const Caller&),
               bool needs_result) {
  const Job job = study_of(exchange);
  const Run run = run_of(exchange, job);
  const bool svg = wants_svg(exchange.request);
  if (needs_result && !run.result) throw Refusal(reason::result_not_ready, "this realization has no result yet");
  return {.type = svg ? "image/svg+xml" : "application/json",
          .body = (exchange.service.jobs.*make)(job, run.key.index, svg, exchange.caller())};
}

Answer field(Exchange& exchange) { return picture(exchange, &Jobs::field, false); }
Answer profile(Exchange& exchange) { return picture(exchange, &Jobs::profile, true); }

Answer retry(Exchange& exchange) {
  if (auto again = stored_answer(exchange)) return *again;
  const Job job = study_of(exchange);
  exchange.service.jobs.retry(job, response_to_store(exchange, 200));
  return changed(exchange, *exchange.service.store.job(job.id));
}

Answer extend(Exchange& exchange) {
  if (auto again = stored_answer(exchange)) return *again;
  const Job job = study_of(exchange);
  const Json body = parse_body(exchange.request.body);
  const bool good = body.is_object() && body.contains("realizations") && body.at("realizations").is_number_integer() &&
                    body.at("realizations") >= 1 && body.at("realizations") <= most_realizations;
  if (!good || body.size() != 1)
    throw Refusal(reason::bad_request, "the request body is invalid",
                  {{"/realizations", "must be the number of realizations to add, at least 1, and the only member"}});
  if (!exchange.service.jobs.extend(job, body.at("realizations").get<std::int64_t>(), response_to_store(exchange, 200)))
    if (auto again = stored_answer(exchange)) return *again;
  return changed(exchange, study_of(exchange));  // dismissed meanwhile: 410
}

}  // namespace

Routes realization_routes() {
  return {{"GET", "/jobs/{}/histogram", Role::read, histogram},
          {"GET", "/jobs/{}/exceedance", Role::read, exceedance},
          {"GET", "/jobs/{}/realizations", Role::read, list_realizations},
          {"GET", "/jobs/{}/realizations/{}", Role::read, one},
          {"GET", "/jobs/{}/realizations/{}/field", Role::read, field, Lane::waiting},
          {"GET", "/jobs/{}/realizations/{}/profile", Role::read, profile, Lane::waiting},
          {"POST", "/jobs/{}/retry", Role::submit, retry, Lane::production},
          {"POST", "/jobs/{}/extend", Role::submit, extend, Lane::production}};
}

}  // namespace talus::service
