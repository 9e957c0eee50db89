// Bytes from a socket: the guard's judgement, then the body as JSON, then as the inputs of both processes.

#include <cstdlib>

#include "http/guard.hpp"
#include "http/hosts.hpp"
#include "jobs/inputs.hpp"

using namespace talus::service;
using talus::Json;

namespace {

void check(bool holds) {
  if (!holds) std::abort();
}

/// What handlers see of a head: nothing that ends a line of another header or of the log.
void check_request(const Incoming& request) {
  check(!request.method.empty() && request.method.find_first_of(" \r\n") == std::string::npos);
  check(request.path.starts_with('/') || request.path == "*");
  for (const auto& [name, value] : request.headers) {
    check(name != "range" && name != "transfer-encoding" && name != "content-length");
    for (const char c : value) check(c == '\t' || (static_cast<unsigned char>(c) >= 32 && c != 127));
  }
}

/// A name that is accepted is one of ours.
void check_host(Head head) {
  const Incoming& request = head.request;
  const bool named = !request.header("host").empty();
  try {
    Hosts(Config{}).check(head, "192.0.2.7");
  } catch (const Refusal&) {
    return;
  }
  const std::string host = request.header("host");
  const std::string name = host.starts_with('[') ? host.substr(0, host.find(']') + 1) : host.substr(0, host.find(':'));
  check(!named || name == "localhost" || name == "127.0.0.1" || name == "[::1]" || name == "192.0.2.7");
}

void read_body(std::string_view body) {
  try {
    const Json json = parse_body(body);
    if (!json.is_object() || !json.contains("inputs") || !json.at("inputs").is_object()) return;
    talus::Faults outputs;
    read_outputs(json, {"s", "x"}, outputs);
    try {
      read_echo_inputs(json.at("inputs"));
    } catch (const Refusal&) {
    }
    read_study_inputs(json.at("inputs"));
  } catch (const Refusal&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto end = head_end(bytes);
  if (!end) {
    read_body(bytes);
    return 0;
  }
  try {
    const Head head = judge(bytes.substr(0, *end), {});
    check_request(head.request);
    check_host(head);
  } catch (const Refusal&) {
  }
  read_body(bytes.substr(*end));
  return 0;
}
