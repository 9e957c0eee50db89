#pragma once
// Lookups and checks shared by handlers.

#include "http/service.hpp"

namespace talus::service {

/// The job named in the path, if it belongs to the caller; jobs of others do not exist.
/// @throws Refusal no_such_job
Job job_of(const Exchange& exchange, Service& service);

/// The same, of a study, not dismissed.
Job study_of(const Exchange& exchange, Service& service);

// How many entries a page of a list holds.
inline constexpr int default_limit = 100, max_limit = 1000;

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

/// "a,b" as its parts.
std::vector<std::string> comma_list(const std::string& text);

/// The stored answer to an earlier request with this Idempotency-Key, if any.
/// @throws Refusal unprocessable if that request was different
std::optional<Answer> told_before(const Exchange& exchange, Service& service);

/// What to store of an answer under the Idempotency-Key; empty without a key.
Store::Answer keeping(const Exchange& exchange, int status, bool with_location);

/// The answer to a change: the stored one, or a new one.
Answer changed(const Exchange& exchange, const Job& job, int status, bool with_location);

}  // namespace talus::service
