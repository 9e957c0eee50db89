#include "http/lookup.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/digest.hpp"
#include "http/links.hpp"

namespace talus::service {
namespace {

constexpr std::size_t max_key = 200;

template <class Number>
std::optional<Number> parsed(const std::string& text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

/// RFC 3986 2.1; a comma may stand for itself in a query.
std::string percent_encoded(const std::string& text) {
  constexpr const char* digits = "0123456789ABCDEF";
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                       std::string_view("-._~,").find(c) != std::string_view::npos;
    if (plain)
      out += c;
    else
      out += {'%', digits[byte >> 4], digits[byte & 15]};
  }
  return out;
}

std::string key_of(const Exchange& exchange) {
  const std::string key = exchange.request.header("idempotency-key");
  if (key.size() > max_key)
    throw Refusal(Reason::bad_request, "Idempotency-Key is longer than " + std::to_string(max_key) + " characters");
  return key;
}

std::string fingerprint(const Incoming& request) {
  return sha256(request.method + "\n" + request.path + "\n" + request.header("prefer") + "\n" + request.body);
}

}  // namespace

void bad_parameter(const std::string& name, const std::string& why) {
  throw Refusal(Reason::bad_request, "a query parameter is invalid", {{"?" + name, why}});
}

Job job_of(const Exchange& exchange, Service& service) {
  std::optional<Job> job = service.store.job(exchange.captured.at(0));
  if (!job || job->subject != exchange.subject) throw Refusal(Reason::no_such_job, "there is no job with this ID");
  return *job;
}

Job study_of(const Exchange& exchange, Service& service) {
  Job job = job_of(exchange, service);
  if (job.process != "influence-zone") throw Refusal(Reason::not_found, "jobs of this process have no realizations");
  if (job.state == JobState::dismissed)
    throw Refusal(Reason::job_dismissed, "the job was dismissed and its files were removed");
  return job;
}

std::optional<std::int64_t> whole_number(const Incoming& request, const std::string& name, std::int64_t least,
                                         std::int64_t most) {
  const auto text = request.parameter(name);
  if (!text) return std::nullopt;
  const auto value = parsed<std::int64_t>(*text);
  if (!value || *value < least || *value > most)
    bad_parameter(name, "must be a whole number from " + std::to_string(least) + " to " + std::to_string(most));
  return value;
}

std::optional<double> real_number(const Incoming& request, const std::string& name) {
  const auto text = request.parameter(name);
  if (!text) return std::nullopt;
  const auto value = parsed<double>(*text);
  if (!value || !std::isfinite(*value)) bad_parameter(name, "must be a number");
  return value;
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

std::vector<std::string> comma_list(const std::string& text) {
  std::vector<std::string> all;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find(',', start), text.size());
    all.push_back(text.substr(start, end - start));
    start = end + 1;
  }
  return all;
}

std::optional<Answer> told_before(const Exchange& exchange, Service& service) {
  const std::string key = key_of(exchange);
  if (key.empty()) return std::nullopt;
  const auto kept = service.store.remembered(exchange.subject, key);
  if (!kept) return std::nullopt;
  if (kept->body_hash != fingerprint(exchange.request))
    throw Refusal(Reason::unprocessable, "this Idempotency-Key was already used for a different request");
  Answer answer{.status = kept->status, .body = kept->body};
  if (!kept->location.empty()) answer.headers.emplace_back("Location", kept->location);
  return answer;
}

Store::Answer keeping(const Exchange& exchange, int status, bool with_location) {
  const std::string key = key_of(exchange);
  if (key.empty()) return {};
  return [&exchange, status, with_location, key](const Job& job) {
    const Answer answer = changed(exchange, job, status, with_location);
    return Remembered{.subject = exchange.subject,
                      .key = key,
                      .body_hash = fingerprint(exchange.request),
                      .status = status,
                      .location = with_location ? exchange.base + "/jobs/" + job.id : "",
                      .body = answer.body};
  };
}

Answer changed(const Exchange& exchange, const Job& job, int status, bool with_location) {
  Answer answer = json_answer(status_info(job, exchange), status);
  if (with_location) answer.headers.emplace_back("Location", exchange.base + "/jobs/" + job.id);
  return answer;
}

}  // namespace talus::service
