#include "http/lookup.hpp"

#include <algorithm>
#include <cstdio>

#include "base/digest.hpp"
#include "http/text.hpp"
#include "support/text.hpp"

namespace talus::service {
namespace {

constexpr std::size_t max_key = 200;

/// RFC 3986 2.1; a comma may stand for itself in a query.
std::string percent_encoded(const std::string& text) {
  std::string out;
  for (const char c : text) {
    char code[4] = {c};
    if (!consists_of_letters_digits(code, "-._~,"))
      std::snprintf(code, sizeof code, "%%%02X", static_cast<unsigned>(static_cast<unsigned char>(c)));
    out += code;
  }
  return out;
}

std::string key_of(const Exchange& exchange) {
  const std::string key = exchange.request.header("idempotency-key");
  if (key.size() > max_key)
    throw Refusal(reason::bad_request, "Idempotency-Key is longer than " + std::to_string(max_key) + " characters");
  return key;
}

std::string fingerprint(const Incoming& request) {
  return sha256(request.method + "\n" + request.path + "\n" + request.header("prefer") + "\n" + request.body);
}

std::int64_t progress(const Job& job) {
  if (job.state == JobState::successful) return 100;
  const std::int64_t all = job.planned + job.replicates, made = job.done + job.failed + job.replicates_ended;
  return all > 0 ? std::min<std::int64_t>(99, 100 * made / all) : 0;
}

std::string message(const Job& job) {
  if (ended(job.state)) return job.message;
  if (job.state == JobState::accepted) return "waiting";
  if (job.planned == 0) return "running";
  std::string text = std::to_string(job.done) + " of " + std::to_string(job.planned) + " realizations done";
  if (job.failed > 0) text += ", " + std::to_string(job.failed) + " failed";
  if (!job.message.empty()) text += "; " + job.message;
  return text;
}

Json links(const Job& job, const Exchange& exchange) {
  const std::string path = "/jobs/" + job.id;
  Json all = Json::array({link(exchange, path, "self", "This job")});  // a bare {link} is an object for some compilers
  if (!ended(job.state)) all.push_back(link(exchange, path, "monitor", "Progress events"));
  if (job.state == JobState::successful)
    all.push_back(link(exchange, path + "/results", "http://www.opengis.net/def/rel/ogc/1.0/results", "Results"));
  if (job.planned == 0 || job.state == JobState::dismissed) return all;
  all.push_back(link(exchange, path + "/histogram", "related", "Histogram of the realizations done so far"));
  all.push_back(link(exchange, path + "/exceedance", "related", "Probability that a quantity is beyond x"));
  all.push_back(link(exchange, path + "/realizations", "related", "Realizations"));
  all.push_back(link(exchange, path + "/events", "related", "Events", event_stream));
  return all;
}

}  // namespace

void bad_parameter(const std::string& name, const std::string& why) {
  throw Refusal(reason::bad_request, "a query parameter is invalid", {{"?" + name, why}});
}

Job job_of(const Exchange& exchange) {
  std::optional<Job> job = exchange.service.store.job(exchange.captured.at(0));
  if (!job || job->subject != exchange.subject) throw Refusal(reason::no_such_job, "there is no job with this ID");
  return *job;
}

Job study_of(const Exchange& exchange) {
  Job job = job_of(exchange);
  if (job.process != "influence-zone") throw Refusal(reason::not_found, "jobs of this process have no realizations");
  if (job.state == JobState::dismissed)
    throw Refusal(reason::job_dismissed, "the job was dismissed and its files were removed");
  return job;
}

std::optional<std::int64_t> whole_number(const Incoming& request, const std::string& name, std::int64_t least,
                                         std::int64_t most) {
  const auto text = request.parameter(name);
  if (!text) return std::nullopt;
  const std::optional<std::int64_t> value = to_whole(*text);
  if (!value || *value < least || *value > most)
    bad_parameter(name, "must be a whole number from " + std::to_string(least) + " to " + std::to_string(most));
  return value;
}

std::optional<double> real_number(const Incoming& request, const std::string& name) {
  const auto text = request.parameter(name);
  if (!text) return std::nullopt;
  const std::optional<double> value = to_number(*text);
  if (!value) bad_parameter(name, "must be a number");
  return value;
}

int page_limit(const Incoming& request) {
  return static_cast<int>(std::min<std::int64_t>(1000, whole_number(request, "limit", 1, 1'000'000).value_or(100)));
}

void only_parameters(const Incoming& request, std::initializer_list<const char*> known) {
  for (const auto& [name, value] : request.query)
    if (std::find(known.begin(), known.end(), name) == known.end())
      bad_parameter(name, "is not a parameter of this request");
}

std::string query_text(const Incoming& request, const std::optional<std::pair<std::string, std::string>>& set) {
  std::string text;
  const auto add = [&text](const std::string& name, const std::string& value) {
    text += (text.empty() ? "?" : "&") + name + "=" + percent_encoded(value);
  };
  for (const auto& [name, value] : request.query)
    if (!set || name != set->first) add(percent_encoded(name), value);
  if (set) add(set->first, set->second);
  return text;
}

std::optional<Answer> stored_answer(const Exchange& exchange) {
  const std::string key = key_of(exchange);
  if (key.empty()) return std::nullopt;
  const auto stored = exchange.service.store.stored_response(exchange.subject, key);
  if (!stored) return std::nullopt;
  if (stored->body_hash != fingerprint(exchange.request))
    throw Refusal(reason::unprocessable, "this Idempotency-Key was already used for a different request");
  Answer answer{.status = stored->status, .body = stored->body};
  if (!stored->location.empty()) answer.headers.emplace_back("Location", stored->location);
  return answer;
}

Store::Response response_to_store(const Exchange& exchange, int status) {
  const std::string key = key_of(exchange);
  if (key.empty()) return {};
  return [&exchange, status, key](const Job& job) {
    const Answer answer = changed(exchange, job, status);
    return StoredResponse{.subject = exchange.subject,
                          .key = key,
                          .body_hash = fingerprint(exchange.request),
                          .status = status,
                          .location = answer.headers.empty() ? "" : answer.headers.front().second,
                          .body = answer.body};
  };
}

Answer changed(const Exchange& exchange, const Job& job, int status) {
  Answer answer = json_answer(status_info(job, exchange), status);
  if (status == 201) answer.headers.emplace_back("Location", exchange.base + "/jobs/" + job.id);
  return answer;
}

Json link(const Exchange& exchange, const std::string& path, const std::string& rel, const std::string& title,
          const std::string& type) {
  return {{"href", exchange.base + path}, {"rel", rel}, {"type", type}, {"title", title}};
}

Json next_link(const Exchange& exchange, const std::string& name, std::int64_t value) {
  const Incoming& request = exchange.request;
  return link(exchange, request.path + query_text(request, {{name, std::to_string(value)}}), "next", "The next page");
}

Json status_info(const Job& job, const Exchange& exchange) {
  Json info = {{"jobID", job.id},
               {"processID", job.process},
               {"type", "process"},
               {"status", word(job.state)},
               {"message", message(job)},
               {"created", utc_text(job.created)},
               {"updated", utc_text(job.updated)},
               {"progress", progress(job)}};
  if (job.started) info["started"] = utc_text(*job.started);
  if (!ended(job.state)) {
    const std::string trouble = exchange.service.scheduler.trouble();  // cannot be recorded on a full disk
    if (!trouble.empty()) info["message"] = trouble;
    if (!trouble.empty() || !job.message.empty()) info["waits"] = trouble.empty() ? job.message : trouble;
  }
  if (job.finished) info["finished"] = utc_text(*job.finished);
  if (job.planned > 0) {
    info["title"] = job.title;
    info["seed"] = job.seed;
    info["realizations"] = {{"planned", job.planned}, {"done", job.done}, {"failed", job.failed}};
    info["quality"] = job.quality.json();
  }
  info["links"] = links(job, exchange);
  return info;
}

}  // namespace talus::service
