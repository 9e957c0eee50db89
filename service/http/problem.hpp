#pragma once
// RFC 9457 problem documents: from every reason to refuse to a status, in one table.

#include "http/message.hpp"
#include "support/refusal.hpp"

namespace talus::service {

/// The answer to a refused request: {type, title, status, detail, errors}.
/// @param accept  the client's Accept header: problem+json only for clients that ask for it
Answer problem(const Refusal& refusal, const std::string& accept);

/// The answer to any exception; what it was is told only where a client can do something about it.
Answer problem(std::exception_ptr thrown, const std::string& accept);

/// The same by status, for what the HTTP library finds wrong itself.
Answer problem(int status, const std::string& accept);

const char* status_text(int status);

}  // namespace talus::service
