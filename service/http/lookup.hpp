#pragma once
// What handlers share: the job of a path, query parameters, links, status documents, and Idempotency-Keys.

#include "http/service.hpp"

namespace talus::service {

/// The job named in the path, if it belongs to the caller; jobs of others do not exist.
/// @throws Refusal no_such_job
Job job_of(const Exchange& exchange);

/// The same, of a study, not dismissed.
Job study_of(const Exchange& exchange);

/// An absolute link.
Json link(const Exchange& exchange, const std::string& path, const std::string& rel, const std::string& title,
          const std::string& type = "application/json");

/// The statusInfo of OGC API - Processes; members without a value are left out.
Json status_info(const Job& job, const Exchange& exchange);

/// The parameter `limit` of a list: entries of a page, 100 without it, at most 1000. @throws Refusal bad_request
int page_limit(const Incoming& request);

/// @throws Refusal bad_request, always: what is wrong with a query parameter
[[noreturn]] void bad_parameter(const std::string& name, const std::string& why);

/// A whole number in the query. @throws Refusal bad_request
std::optional<std::int64_t> whole_number(const Incoming& request, const std::string& name, std::int64_t least,
                                         std::int64_t most);
std::optional<double> real_number(const Incoming& request, const std::string& name);

/// Rejects unknown parameters. @throws Refusal bad_request
void only_parameters(const Incoming& request, std::initializer_list<const char*> known);

/// The query of a request, as in "?a=b&c=d", with one parameter replaced; empty without parameters.
std::string query_text(const Incoming& request, const std::optional<std::pair<std::string, std::string>>& set = {});

/// The stored answer to an earlier request with this Idempotency-Key, if any.
/// @throws Refusal unprocessable if that request was different
std::optional<Answer> stored_answer(const Exchange& exchange);

/// Makes what is stored of the answer to a change; empty without an Idempotency-Key.
Store::Response response_to_store(const Exchange& exchange, int status);

/// The answer to a change of a job; with status 201 it names the job's Location.
Answer changed(const Exchange& exchange, const Job& job, int status = 200);

}  // namespace talus::service
