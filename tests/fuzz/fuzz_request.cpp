// Bytes from a socket: the guard's judgement, then the body as JSON, then as the inputs of both processes.

#include <cstdlib>

#include "http/guard.hpp"
#include "jobs/inputs.hpp"

using namespace talus::service;
using talus::Json;

namespace {

void check(bool holds) {
  if (!holds) std::abort();
}

/// What is handed on must be one head, without anything that the library must not see.
void check_rewritten(const Head& head) {
  const std::string& text = head.rewritten;
  check(head_end(text) == text.size());
  check(text.find('\0') == std::string::npos);
  for (const char* forbidden :
       {"\nRange:", "\nrange:", "\nTransfer-", "\ntransfer-", "\nContent-Type:", "\ncontent-type:", "%0d", "%0A"})
    check(text.substr(text.find("\r\n")).find(forbidden) == std::string::npos);
  if (text.find("\r\nhost: ") == std::string::npos) return;  // HTTP/1.0 may come without, what is handed on is 1.1
  try {
    check(judge(text, {}).body == head.body);
  } catch (const BadRequest&) {
    check(false);
  }
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
    check_rewritten(judge(bytes.substr(0, *end), {}));
  } catch (const BadRequest&) {
  }
  read_body(bytes.substr(*end));
  return 0;
}
