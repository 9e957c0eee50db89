// UM-Bridge 1.0 (https://um-bridge-benchmarks.readthedocs.io): the solver as a function for any client of uncertainty
// quantification. A model is a case in --models; its input is the coefficients of its random field [xi_1..xi_M],
// of all its random properties in their order, and, if config.parameters names some, a second vector of their values;
// its output is the five measures of the front.
//
// The protocol prescribes the order of the checks: model, feature, inputs. Errors are {"error": {"type", "message"}},
// with status 400 where the request is wrong; InvalidOutput with 500 where the run failed, and with 503, 504 or 507
// where it could not be carried out now. Evaluations wait for one another; one ends when its client leaves.

#include <algorithm>

#include "http/service.hpp"
#include "support/files.hpp"

namespace talus::service {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_case_bytes = std::size_t{64} << 20;

struct Parameter {
  const char* name;
  const char* pointer;
};
constexpr Parameter parameters[] = {{"particle_spacing_m", "/particle_spacing_m"},
                                    {"end_s", "/time/end_s"},
                                    {"density_kg_m3", "/material/density_kg_m3"},
                                    {"cohesion_Pa", "/material/cohesion_Pa"},
                                    {"viscosity_Pa_s", "/material/viscosity_Pa_s"},
                                    {"log_mean", "/random_field/log_mean"},
                                    {"log_stdev", "/random_field/log_stdev"},
                                    {"friction_mean_tan_phi", "/random_field/properties/friction/mean_tan_phi"},
                                    {"friction_cov", "/random_field/properties/friction/cov"},
                                    {"cohesion_mean_kPa", "/random_field/properties/cohesion/mean_kPa"},
                                    {"cohesion_cov", "/random_field/properties/cohesion/cov"},
                                    {"unit_weight_mean_kN_m3", "/random_field/properties/unit_weight/mean_kN_m3"},
                                    {"unit_weight_cov", "/random_field/properties/unit_weight/cov"},
                                    {"viscosity_mean_Pa_s", "/random_field/properties/viscosity/mean_Pa_s"},
                                    {"viscosity_cov", "/random_field/properties/viscosity/cov"}};

struct ProtocolError {
  const char* type;
  std::string message;
};
[[noreturn]] void invalid(const std::string& message) { throw ProtocolError{"InvalidInput", message}; }

std::vector<std::string> models(const Config& config) {
  std::vector<std::string> names;
  if (config.models.empty()) return names;
  for (const auto& entry : fs::directory_iterator(config.models))
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// The case of the model that a request names.
Json model_of(const Json& body, const Config& config) {
  const std::string name = body.is_object() && body.contains("name") && body.at("name").is_string()
                               ? body.at("name").get<std::string>()
                               : std::string();
  const std::vector<std::string> known = models(config);
  if (std::find(known.begin(), known.end(), name) == known.end())
    throw ProtocolError{"ModelNotFound", "Model '" + name + "' is not served here"};
  return read_json(config.models / (name + ".json"), max_case_bytes);
}

/// The parameters that config names.
std::vector<const Parameter*> wanted(const Json& body) {
  std::vector<const Parameter*> all;
  if (!body.contains("config") || body.at("config").is_null()) return all;
  const Json& config = body.at("config");
  if (!config.is_object()) invalid("config must be an object");
  for (const auto& [key, value] : config.items())
    if (key != "parameters") invalid("config." + key + " is not a known key; the only one is parameters");
  if (!config.contains("parameters")) return all;
  if (!config.at("parameters").is_array()) invalid("config.parameters must be an array of names");
  for (const Json& name : config.at("parameters")) {
    const auto at =
        std::find_if(std::begin(parameters), std::end(parameters), [&](const Parameter& p) { return name == p.name; });
    if (at == std::end(parameters)) invalid("config.parameters: " + dump(name) + " is not a known parameter");
    if (std::find(all.begin(), all.end(), at) != all.end())
      invalid(std::string("config.parameters names ") + at->name + " twice");
    all.push_back(at);
  }
  return all;
}

/// The sizes of the input vectors.
Json sizes(const Exchange& exchange, const Json& body, const Json& document) {
  Json all = {exchange.service.jobs.field_terms(document, exchange.caller())};
  if (const std::size_t named = wanted(body).size(); named > 0) all.push_back(named);
  return all;
}

Json evaluate(const Exchange& exchange, const Json& body, const Json& model) {
  Json document = model;
  const auto expected = sizes(exchange, body, document).get<std::vector<std::size_t>>();
  if (!body.contains("input") || !body.at("input").is_array()) invalid("input must be an array of arrays of numbers");
  const Json& input = body.at("input");
  if (input.size() != expected.size())
    invalid("input has " + std::to_string(input.size()) + " vectors, the model takes " +
            std::to_string(expected.size()));
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (!input[i].is_array() || input[i].size() != expected[i])
      invalid("input vector " + std::to_string(i) + " must have " + std::to_string(expected[i]) + " numbers");
    for (const Json& value : input[i])
      if (!value.is_number()) invalid("input vector " + std::to_string(i) + " contains something that is not a number");
  }
  if (expected[0] > 0) document["random_field"]["xi"] = input[0];
  const std::vector<const Parameter*> names = wanted(body);
  for (std::size_t i = 0; i < names.size(); ++i) document[Json::json_pointer(names[i]->pointer)] = input[1][i];
  document.erase("study");
  const Json result = exchange.service.jobs.evaluate(document, exchange.caller());
  Json front = Json::array();
  for (const Measure& measure : measure_table)
    if (!measure.optional) front.push_back(result.at(measure.key));
  return {{"output", Json::array({front})}};
}

Answer error_answer(const ProtocolError& e, int status = 400) {
  return json_answer({{"error", {{"type", e.type}, {"message", e.message}}}}, status);
}

/// An exception as an error of the protocol, with the status and the headers of the problem that it is elsewhere.
Answer no_output(std::exception_ptr thrown) {
  Answer as_problem = problem(thrown, "");
  Answer answer = error_answer({"InvalidOutput", Json::parse(as_problem.body).at("detail")}, as_problem.status);
  answer.headers = std::move(as_problem.headers);
  return answer;
}

using Feature = Json (*)(const Exchange& exchange, const Json& body, const Json& document);

/// The answer of a feature to a request, with errors as the protocol words them.
template <Feature feature>
Answer answer_of(Exchange& exchange) try {
  const Json body = parse_body(exchange.request.body);
  return json_answer(feature(exchange, body, model_of(body, exchange.service.config)));
} catch (const ProtocolError& e) {
  return error_answer(e);
} catch (const Refusal& e) {
  if (e.reason != reason::bad_request && e.reason != reason::quota) return no_output(std::current_exception());
  std::string message = e.what();
  for (const Fault& fault : e.faults)
    if (fault.message != e.what()) message += "; " + (fault.pointer.empty() ? "" : fault.pointer + " ") + fault.message;
  return error_answer({"InvalidInput", message});
} catch (...) {
  return no_output(std::current_exception());
}

Json model_info(const Exchange&, const Json&, const Json&) {
  return {{"support", {{"Evaluate", true}, {"Gradient", false}, {"ApplyJacobian", false}, {"ApplyHessian", false}}}};
}
Json input_sizes(const Exchange& exchange, const Json& body, const Json& document) {
  return {{"inputSizes", sizes(exchange, body, document)}};
}
/// A measure that a run may not have is no output: the protocol has numbers only.
Json output_sizes(const Exchange&, const Json&, const Json&) {
  return {{"outputSizes", {std::ranges::count(measure_table, false, &Measure::optional)}}};
}
Json unsupported(const Exchange& exchange, const Json&, const Json&) {
  throw ProtocolError{"UnsupportedFeature", exchange.request.path.substr(1) + " is not supported by this model"};
}

}  // namespace

Routes umbridge_routes() {
  return {{"GET", "/Info", Role::read,
           [](Exchange& e) {
             return json_answer({{"protocolVersion", 1.0}, {"models", models(e.service.config)}});
           }},
          {"POST", "/ModelInfo", Role::read, answer_of<model_info>},
          {"POST", "/InputSizes", Role::read, answer_of<input_sizes>, Lane::production},
          {"POST", "/OutputSizes", Role::read, answer_of<output_sizes>},
          {"POST", "/Evaluate", Role::submit, answer_of<evaluate>, Lane::waiting},
          {"POST", "/Gradient", Role::read, answer_of<unsupported>},
          {"POST", "/ApplyJacobian", Role::read, answer_of<unsupported>},
          {"POST", "/ApplyHessian", Role::read, answer_of<unsupported>}};
}

}  // namespace talus::service
