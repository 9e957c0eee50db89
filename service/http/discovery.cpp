// Landing page, conformance classes, processes, OpenAPI.

#include "http/lookup.hpp"
#include "http/service.hpp"

namespace talus::service {
namespace {

constexpr const char* openapi_type = "application/vnd.oai.openapi+json;version=3.0";

Json landing(const Exchange& exchange) {
  return {{"title", "Talus"},
          {"description", "Run-out distance of a landslide and its uncertainty: Monte Carlo studies with SPH."},
          {"links",
           {link(exchange, "/", "self", "This document"),
            link(exchange, "/api", "service-desc", "The API as OpenAPI 3.0", openapi_type),
            link(exchange, "/conformance", "http://www.opengis.net/def/rel/ogc/1.0/conformance", "Conformance classes"),
            link(exchange, "/processes", "http://www.opengis.net/def/rel/ogc/1.0/processes", "Processes"),
            link(exchange, "/jobs", "http://www.opengis.net/def/rel/ogc/1.0/job-list", "Jobs")}}};
}

Json conformance() {
  Json classes = Json::array();
  for (const char* name : {"core", "json", "oas30", "job-list", "dismiss", "ogc-process-description"})
    classes.push_back(std::string("http://www.opengis.net/spec/ogcapi-processes-1/1.0/conf/") + name);
  return {{"conformsTo", classes}};
}

Json links_of(const Exchange& exchange, const std::string& name) {
  const std::string path = "/processes/" + name;
  return {link(exchange, path, "self", "Process description"),
          link(exchange, path + "/execution", "http://www.opengis.net/def/rel/ogc/1.0/execute", "Execution endpoint")};
}

Json processes(const Exchange& exchange) {
  const Incoming& request = exchange.request;
  const std::int64_t limit = whole_number(request, "limit", 1, 10'000).value_or(10);
  const std::int64_t first = whole_number(request, "offset", 0, 10'000).value_or(0);
  Json list = Json::array(),
       links = Json::array({link(exchange, "/processes" + query_text(request), "self", "Processes")});
  std::int64_t i = 0;
  for (const auto& [name, text] : process_texts()) {
    if (i++ < first) continue;
    if (i > first + limit) {
      const std::string next = query_text(request, {{"offset", std::to_string(first + limit)}});
      links.push_back(link(exchange, "/processes" + next, "next", "The next processes"));
      break;
    }
    Json summary = Json::parse(text);
    summary.erase("inputs");
    summary.erase("outputs");
    summary["links"] = links_of(exchange, name);
    list.push_back(std::move(summary));
  }
  return {{"processes", list}, {"links", links}};
}

Json process(const Exchange& exchange) {
  for (const auto& [name, text] : process_texts()) {
    if (name != exchange.captured[0]) continue;
    Json description = Json::parse(text);
    description["links"] = links_of(exchange, name);
    return description;
  }
  throw Refusal(reason::no_such_process, "there is no process with this ID; GET /processes lists them");
}

}  // namespace

Routes discovery_routes() {
  return {{"GET", "/", Role::read, [](Exchange& e) { return json_answer(landing(e)); }},
          {"GET", "/conformance", Role::read, [](Exchange&) { return json_answer(conformance()); }},
          {"GET", "/processes", Role::read, [](Exchange& e) { return json_answer(processes(e)); }},
          {"GET", "/processes/{}", Role::read, [](Exchange& e) { return json_answer(process(e)); }},
          {"GET", "/api", Role::read, [](Exchange&) { return Answer{.type = openapi_type, .body = openapi_text()}; }}};
}

}  // namespace talus::service
