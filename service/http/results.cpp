#include "http/results.hpp"

#include "base/digest.hpp"

namespace talus::service {
namespace {

/// An object can only stand in a results document as a qualified value.
Json document_of(const Json& values) {
  Json document = Json::object();
  for (const auto& [name, value] : values.items())
    document[name] = value.is_object() ? Json({{"value", value}, {"mediaType", "application/json"}}) : value;
  return document;
}

Answer raw_answer(const Json& value) {
  if (value.is_string()) return {.type = "text/plain", .body = value.get<std::string>()};
  return json_answer(value);
}

bool accepts_multipart(const std::string& accept) {
  return accept.empty() || accept.find("*/*") != std::string::npos || accept.find("multipart/") != std::string::npos;
}

/// RFC 2387; each part bears the name of its output as Content-ID (OGC 18-062r2, process-execute-sync-raw-value-multi).
Answer multipart_answer(const Json& values) {
  const std::string boundary = sha256(dump(values)).substr(0, 32);
  std::string body, first_type;
  for (const auto& [name, value] : values.items()) {
    const Answer part = raw_answer(value);
    if (first_type.empty()) first_type = part.type;
    body += "--" + boundary + "\r\nContent-Type: " + part.type + "\r\nContent-ID: " + name + "\r\n\r\n" + part.body +
            "\r\n";
  }
  return {.type = "multipart/related; boundary=" + boundary + "; type=\"" + first_type + "\"",
          .body = body + "--" + boundary + "--\r\n"};
}

}  // namespace

Answer results_answer(const Json& values, bool raw, const Incoming& request) {
  if (raw && values.size() == 1) return raw_answer(values.begin().value());
  if (raw && values.size() > 1 && accepts_multipart(request.header("accept"))) return multipart_answer(values);
  return json_answer(document_of(values));
}

Json echo_results(const Json& inputs, const std::vector<std::string>& outputs) {
  Json results = Json::object();
  for (const std::string& name : outputs)
    if (inputs.contains(name)) results[name] = inputs.at(name);
  return results;
}

}  // namespace talus::service
