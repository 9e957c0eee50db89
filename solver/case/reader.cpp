#include "case/reader.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "case/schema.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

const Json empty_object = Json::object();
constexpr std::size_t most_written_out = 100;  ///< values of an array or an object in a message

/// Characters of UTF-8 text.
std::size_t characters(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

/// A whole number without a decimal point.
Json plain(double x) { return x == std::floor(x) && std::abs(x) < 1e18 ? Json(static_cast<std::int64_t>(x)) : Json(x); }

/// "Unit: Pa; range: >= 0 and < 10; "
std::string facts_of(const Quantity& q, std::string_view range_words) {
  const std::string range =
      (q.lo_open ? "> " : ">= ") + plain(q.lo).dump() + " and " + (q.hi_open ? "< " : "<= ") + plain(q.hi).dump();
  return "Unit: " + std::string(q.unit.empty() ? "-" : q.unit) +
         "; range: " + (range_words.empty() ? range : std::string(range_words)) + "; ";
}

std::string in_words(const Json& fallback) {
  if (!fallback.is_string()) return fallback.dump();
  return fallback == "" ? "empty" : fallback.get<std::string>();
}

}  // namespace

std::string Quantity::describe() const {
  return (unit.empty() ? "" : "unit " + std::string(unit) + ", ") + "allowed " + (lo_open ? "> " : ">= ") +
         to_text(lo) + " and " + (hi_open ? "< " : "<= ") + to_text(hi);
}

std::string quote(const Json& value) {
  if (value.size() > most_written_out)
    return (value.is_array() ? "an array of " : "an object of ") + std::to_string(value.size()) + " values";
  return shorten(value.dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::optional<double> read_number(const Json& value, const Quantity& q, const std::string& pointer, Faults& faults) {
  if (!value.is_number()) {
    faults.add(pointer, quote(value) + " is not a number; " + q.describe());
    return {};
  }
  const double x = value.get<double>() + 0.0;  // -0 becomes 0
  if (std::isfinite(x) && q.allows(x)) return x;
  faults.add(pointer, (std::isfinite(x) ? quote(value) + " is out of range; " : "is not finite; ") + q.describe());
  return {};
}

Json number_schema(const Quantity& q, std::string_view type) {
  return {{"type", type},
          {q.lo_open ? "exclusiveMinimum" : "minimum", plain(q.lo)},
          {q.hi_open ? "exclusiveMaximum" : "maximum", plain(q.hi)}};
}

ObjectReader::ObjectReader(const Json& value, std::string pointer, Faults& faults)
    : value_(&value), pointer_(std::move(pointer)), faults_(faults) {
  if (value.is_object()) return;
  fault("", quote(value) + " is not an object");
  value_ = nullptr;
}

ObjectReader ObjectReader::describing(Faults& ignored) {
  ObjectReader reader("", ignored, true);
  reader.schema_ = {{"type", "object"}, {"additionalProperties", false}};
  return reader;
}

const Json* ObjectReader::find(std::string_view key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
  if (value_ == nullptr) return nullptr;
  const auto at = value_->find(std::string(key));
  return at == value_->end() ? nullptr : &*at;
}

void ObjectReader::fault(std::string_view key, std::string message) {
  if (value_ != nullptr) faults_.add(key.empty() ? pointer_ : pointer(key), std::move(message));
}

void ObjectReader::declare(std::string_view key, const Json& schema, const KeyText& text, const std::string& facts,
                           const Json& fallback, bool required) {
  if (!describing_) return;
  std::string details = facts;
  if (!default_words_.empty())
    details += "default: " + std::string(default_words_) + "; ";
  else if (required)
    details += "required; ";
  else if (!text.default_words.empty())
    details += "default: " + std::string(text.default_words) + "; ";
  else if (!fallback.is_null())
    details += "default: " + in_words(fallback) + "; ";
  details += "source: " + std::string(text.source) + ".";
  details[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(details[0])));
  Json described = {{"description", std::string(text.sentence) + " " + details}};
  described.update(schema);
  if (default_words_.empty() && !required && text.default_words.empty() && !fallback.is_null())
    described["default"] = fallback;
  if (default_words_.empty() && required) schema_["required"].push_back(key);
  schema_["properties"][std::string(key)] = std::move(described);
}

/// @param type  of JSON Schema: "number" or "integer"
std::optional<double> ObjectReader::read_number(std::string_view key, const Quantity& q, const KeyText& text,
                                                std::string_view type, const Json& fallback, bool required) {
  declare(key, number_schema(q, type), text, facts_of(q, text.range_words), fallback, required);
  const Json* value = find(key);
  if (value == nullptr && required && default_words_.empty()) fault(key, "is missing; " + q.describe());
  if (value == nullptr) return {};
  const std::optional<double> x = talus::read_number(*value, q, pointer(key), faults_);
  if (!x || type == "number" || *x == std::floor(*x)) return x;
  fault(key, to_text(*x) + " is not a whole number; " + q.describe());
  return {};
}

void ObjectReader::number(std::string_view key, double& value, const Quantity& q, const KeyText& text) {
  value = read_number(key, q, text, "number", value).value_or(value);
  record(key, value);
}

void ObjectReader::required_number(std::string_view key, double& value, const Quantity& q, const KeyText& text) {
  value = read_number(key, q, text, "number", nullptr, true).value_or(value);
  record(key, value);
}

void ObjectReader::number_in_either(std::string_view key, double& value, const Quantity& q, const KeyText& text,
                                    bool required, const OtherUnit& other) {
  const auto given = read_number(key, q, text, "number", required ? Json(nullptr) : Json(value));
  const auto converted = read_number(other.key, other.q, other.text);
  if (required && default_words_.empty()) {
    one_form({{{key}}, {{other.key}}});
    if (find(key) == nullptr && find(other.key) == nullptr)
      fault(key, "is missing (or " + std::string(other.key) + "); " + q.describe());
    if (find(key) != nullptr && find(other.key) != nullptr)
      fault(other.key, "is given beside " + std::string(key) + "; give one of the two");
  } else {
    exclude(other.key, key);
  }
  value = given ? *given : converted ? *converted * other.factor : value;
  record(key, value);
}

void ObjectReader::optional_number_in_either(std::string_view key, std::optional<double>& value, const Quantity& q,
                                             const KeyText& text, const OtherUnit& other) {
  const auto given = read_number(key, q, text), converted = read_number(other.key, other.q, other.text);
  exclude(other.key, key);
  if (given) value = given;
  if (!given && converted) value = *converted * other.factor;
  if (given || converted) record(key, *value);
}

void ObjectReader::optional_number(std::string_view key, std::optional<double>& value, const Quantity& q,
                                   const KeyText& text) {
  if (const auto read = read_number(key, q, text)) record(key, value.emplace(*read));
}

void ObjectReader::flag(std::string_view key, bool& value, const KeyText& text) {
  declare(key, {{"type", "boolean"}}, text, "", value);
  const Json* given = find(key);
  if (given != nullptr && !given->is_boolean()) fault(key, quote(*given) + " is neither true nor false");
  if (given != nullptr && given->is_boolean()) value = given->get<bool>();
  record(key, value);
}

void ObjectReader::string(std::string_view key, std::string& value, Size length, const KeyText& text) {
  const auto fits = [&](const std::string& s) {
    const std::size_t n = characters(s);
    return n >= length.least && n <= length.most;
  };
  const bool required = !fits(value);
  const std::string range = std::to_string(length.least) + " to " + std::to_string(length.most) + " characters";
  Json schema = {{"type", "string"}};
  if (length.least > 0) schema["minLength"] = length.least;
  schema["maxLength"] = length.most;
  declare(key, schema, text, range + "; ", value, required);
  const Json* given = find(key);
  const std::string* s = given == nullptr ? nullptr : given->get_ptr<const std::string*>();
  if (s != nullptr && fits(*s))
    value = *s;
  else if (given != nullptr)
    fault(key, quote(*given) + " is not a string of " + range);
  else if (required)
    fault(key, "is missing; a string of " + range);
  record(key, value);
}

void ObjectReader::numbers(std::string_view key, std::vector<double>& values, const Quantity& q, Size length,
                           const KeyText& text) {
  Json schema = {{"type", "array"}};
  if (length.least > 0) schema["minItems"] = length.least;
  schema["maxItems"] = length.most;
  schema["items"] = number_schema(q);
  declare(key, schema, text, facts_of(q, text.range_words), Json::array(), length.least > 0);
  const Json* list = find(key);
  const auto has = [&](const char* limit, std::size_t count) {
    fault(key, "has " + std::to_string(list->size()) + " numbers, at " + limit + " " + std::to_string(count) +
                   (*limit == 'm' ? " are allowed" : " are needed"));
  };
  if (list == nullptr) {
    if (length.least > 0) fault(key, "is missing; a list of " + std::to_string(length.least) + " numbers");
  } else if (!list->is_array()) {
    fault(key, quote(*list) + " is not a list of numbers; each " + q.describe());
  } else if (list->size() > length.most) {
    has("most", length.most);
  } else if (list->size() < length.least) {
    has("least", length.least);
  } else {
    for (std::size_t k = 0; k < list->size(); ++k)
      if (const auto x = talus::read_number((*list)[k], q, pointer_to(pointer(key), k), faults_)) values.push_back(*x);
  }
  record(key, values);
}

std::size_t ObjectReader::pick(std::string_view key, std::span<const std::string> words, std::size_t fallback,
                               const KeyText& text) {
  declare(key, {{"type", "string"}, {"enum", std::vector<std::string>(words.begin(), words.end())}}, text, "",
          words[fallback]);
  if (const Json* value = find(key)) {
    const std::string* word = value->get_ptr<const std::string*>();
    const auto at = word == nullptr ? words.end() : std::find(words.begin(), words.end(), *word);
    if (at != words.end()) {
      fallback = static_cast<std::size_t>(at - words.begin());
    } else {
      std::string list;
      for (const std::string& k : words) list += (list.empty() ? "" : ", ") + k;
      const std::string near = word == nullptr ? "" : nearest_name(*word, words);
      fault(key, quote(*value) + " is not one of " + list + (near.empty() ? "" : " (" + near + "?)"));
    }
  }
  record(key, words[fallback]);
  return fallback;
}

/// The reader of a member object; `value` is null where it is absent.
ObjectReader ObjectReader::child_at(std::string_view key, const Json* value, Absent absent) {
  if (describing_) return describing(faults_);
  if (value != nullptr) return {*value, pointer(key), faults_};
  if (value_ != nullptr && absent == Absent::defaults) return {empty_object, pointer(key), faults_};
  fault(key, "is missing; an object");
  return {pointer(key), faults_, false};
}

void ObjectReader::object(std::string_view key, std::string_view sentence, Absent absent, const Read& read) {
  const Json* value = find(key);
  if (value == nullptr && absent == Absent::skip && !describing_) return;
  ObjectReader child = child_at(key, value, absent);
  read(child);
  record(key, child.finish());
  if (!describing_) return;
  Json schema = {{"description", sentence}};
  schema.update(child.schema_);
  schema_["properties"][std::string(key)] = std::move(schema);
  if (absent == Absent::fault) schema_["required"].push_back(key);
}

bool ObjectReader::switchable(std::string_view key, const KeyText& text, const Read& read) {
  const Json* value = find(key);
  const bool on = value != nullptr && *value != false;
  record(key, false);
  if (!on && !describing_) return false;
  ObjectReader child = child_at(key, on && *value == true ? &empty_object : value, Absent::skip);
  read(child);
  if (on) record(key, child.finish());
  child.schema_["type"] = {"boolean", "object"};
  declare(key, child.schema_, text, "", false);
  return on;
}

void ObjectReader::objects(std::string_view key, Size length, const KeyText& text, std::string_view each,
                           const Read& read) {
  const std::string range = std::to_string(length.least) + " to " + std::to_string(length.most);
  const Json* list = find(key);
  Json resolved = Json::array();
  if (list != nullptr && list->is_array() && list->size() >= length.least && list->size() <= length.most) {
    for (std::size_t k = 0; k < list->size(); ++k) {
      ObjectReader child((*list)[k], pointer_to(pointer(key), k), faults_);
      read(child);
      resolved.push_back(child.finish());
    }
  } else if (list != nullptr) {
    fault(key,
          (list->is_array() ? "has " + std::to_string(list->size()) + " entries" : quote(*list) + " is not a list") +
              "; give " + range + " " + std::string(key));
  }
  record(key, std::move(resolved));
  if (!describing_) return;
  ObjectReader child = describing(faults_);
  read(child);
  Json items = {{"description", each}};
  items.update(child.schema_);
  declare(key, {{"type", "array"}, {"minItems", length.least}, {"maxItems", length.most}, {"items", std::move(items)}},
          text, range + "; ");
}

void ObjectReader::exclude(std::string_view key, std::string_view other) {
  if (describing_) schema_["not"]["anyOf"].push_back({{"required", {key, other}}});
  if (find(key) != nullptr && find(other) != nullptr)
    fault(key, "is given beside " + std::string(other) + "; give one of the two");
}

void ObjectReader::limit_by_choice(std::string_view key, double value, std::string_view choice,
                                   std::initializer_list<LimitOfWord> limits, std::string_view why) {
  for (const LimitOfWord& limit : limits) {
    const bool is_default = &limit == limits.begin();
    if (describing_) {
      Json beyond = {{"properties", {{choice, {{"enum", {limit.word}}}}, {key, {{"exclusiveMinimum", limit.most}}}}}};
      beyond["required"].push_back(key);
      if (!is_default) beyond["required"].push_back(choice);
      schema_["not"]["anyOf"].push_back(std::move(beyond));
    } else if (value > limit.most && resolved_[std::string(choice)] == limit.word) {
      fault(key, to_text(value) + " is too large for " + std::string(choice) + " \"" + std::string(limit.word) +
                     "\": allowed > 0 and <= " + to_text(limit.most) + "; " + std::string(why));
    }
  }
}

void ObjectReader::one_form(std::initializer_list<Form> forms) {
  if (!describing_) return;
  Json one = Json::array();
  for (const Form& form : forms) {
    const auto belongs = [&](std::string_view key) {
      return std::ranges::count(form.required, key) + std::ranges::count(form.allowed, key) > 0;
    };
    Json strange = Json::array();
    for (const Form& other : forms)
      for (const auto& keys : {other.required, other.allowed})
        for (const std::string_view key : keys)
          if (const Json rule = {{"required", {key}}}; !belongs(key) && std::ranges::count(strange, rule) == 0)
            strange.push_back(rule);
    one.push_back({{"required", form.required}, {"not", {{"anyOf", std::move(strange)}}}});
  }
  schema_["allOf"].push_back({{"oneOf", std::move(one)}});
}

Json ObjectReader::finish() {
  if (value_ != nullptr)
    for (const auto& [key, value] : value_->items())
      if (std::find(known_.begin(), known_.end(), key) == known_.end()) {
        const std::string path = path_of_key(key);
        faults_.add(pointer(key), "is not a known key" + (path.empty() ? suggestion(key, known_) : " (" + path + "?)"));
      }
  return std::move(resolved_);
}

}  // namespace talus
