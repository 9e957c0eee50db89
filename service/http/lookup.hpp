#pragma once
// What many handlers begin with.

#include "http/service.hpp"

namespace talus::service {

/// The job named in the path, if it is the caller's; other people's do not exist.
/// @throws Refusal no_such_job
Job job_of(const Exchange& exchange, Service& service);

/// The same, of a study, not dismissed.
Job study_of(const Exchange& exchange, Service& service);

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

/// What the client must be told again for a request with this Idempotency-Key, if it has been made before.
/// @throws Refusal unprocessable when it was another request
std::optional<Answer> told_before(const Exchange& exchange, Service& service);

/// Makes what is kept of an answer under the Idempotency-Key; empty where there is no key.
Store::Answer keeping(const Exchange& exchange, int status, bool with_location);

/// The answer to a change: as kept, or made now.
Answer changed(const Exchange& exchange, const Job& job, int status, bool with_location);

}  // namespace talus::service
