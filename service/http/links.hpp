#pragma once

#include "http/message.hpp"
#include "queue/records.hpp"

namespace talus::service {

/// An absolute link.
Json link(const Exchange& exchange, const std::string& path, const std::string& rel, const std::string& title,
          const std::string& type = "application/json");

/// statusInfo of OGC API - Processes: what has no value is left out.
Json status_info(const Job& job, const Exchange& exchange);

}  // namespace talus::service
