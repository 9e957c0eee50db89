#pragma once
// RFC 9457 problem documents: one table from reason of refusal to status.

#include "base/refusal.hpp"
#include "http/message.hpp"

namespace talus::service {

/// The answer to a refused request: {type, title, status, detail, errors}.
/// @param accept  the client's Accept header: problem+json only for clients that ask for it
Answer problem(const Refusal& refusal, const std::string& accept);

/// The answer to any exception; details are given only where a client can act on them.
Answer problem(std::exception_ptr thrown, const std::string& accept);

/// The same by status, for errors detected by the guard or the HTTP library.
/// @param detail  empty: the title of the status
Answer problem(int status, const std::string& accept, const std::string& detail = {});

const char* status_text(int status);

}  // namespace talus::service
