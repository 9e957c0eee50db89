#include "case/reader.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "case/schema.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

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

std::string quote(const Json& value) { return shorten(value.dump(-1, ' ', false, Json::error_handler_t::replace)); }

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

const Json& ObjectReader::empty_object() {
  static const Json empty = Json::object();
  return empty;
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

void ObjectReader::declare(std::string_view key, Json schema, const KeyText& text, const std::string& facts) {
  declare(key, std::move(schema), text, facts, nullptr, false);
}

void ObjectReader::declare(std::string_view key, Json schema, const KeyText& text, const std::string& facts,
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

std::optional<double> ObjectReader::read_number(std::string_view key, const Quantity& q) {
  const Json* value = find(key);
  return value == nullptr ? std::nullopt : talus::read_number(*value, q, pointer(key), faults_);
}

std::optional<double> ObjectReader::read_whole(std::string_view key, const Quantity& q) {
  const std::optional<double> x = read_number(key, q);
  if (!x || *x == std::floor(*x)) return x;
  fault(key, to_text(*x) + " is not a whole number; " + q.describe());
  return {};
}

void ObjectReader::number(std::string_view key, double& value, const Quantity& q, const KeyText& text) {
  if (describing_) declare(key, number_schema(q), text, facts_of(q, text.range_words), value, false);
  value = read_number(key, q).value_or(value);
  record(key, value);
}

void ObjectReader::required_number(std::string_view key, double& value, const Quantity& q, const KeyText& text) {
  if (describing_) declare(key, number_schema(q), text, facts_of(q, text.range_words), nullptr, true);
  if (find(key) == nullptr && default_words_.empty()) fault(key, "is missing; " + q.describe());
  value = read_number(key, q).value_or(value);
  record(key, value);
}

void ObjectReader::optional_number(std::string_view key, std::optional<double>& value, const Quantity& q,
                                   const KeyText& text) {
  if (describing_) declare(key, number_schema(q), text, facts_of(q, text.range_words));
  if (const std::optional<double> x = read_number(key, q)) {
    value = x;
    record(key, *x);
  }
}

std::optional<std::int64_t> ObjectReader::read_integer(std::string_view key, std::optional<std::int64_t> fallback,
                                                       const Quantity& q, const KeyText& text) {
  if (describing_)
    declare(key, number_schema(q, "integer"), text, facts_of(q, text.range_words), fallback ? Json(*fallback) : Json(),
            false);
  if (const std::optional<double> x = read_whole(key, q)) fallback = static_cast<std::int64_t>(*x);
  if (fallback) record(key, *fallback);
  return fallback;
}

void ObjectReader::flag(std::string_view key, bool& value, const KeyText& text) {
  if (describing_) declare(key, {{"type", "boolean"}}, text, "", value, false);
  const Json* given = find(key);
  if (given != nullptr && !given->is_boolean()) fault(key, quote(*given) + " is neither true nor false");
  if (given != nullptr && given->is_boolean()) value = given->get<bool>();
  record(key, value);
}

void ObjectReader::string(std::string_view key, std::string& value, Size length, const KeyText& text) {
  read_string(key, value, length, text, false);
}

void ObjectReader::required_string(std::string_view key, std::string& value, Size length, const KeyText& text) {
  read_string(key, value, length, text, true);
}

void ObjectReader::read_string(std::string_view key, std::string& value, Size length, const KeyText& text,
                               bool required) {
  const std::string range = std::to_string(length.least) + " to " + std::to_string(length.most) + " characters";
  if (describing_) {
    Json schema = {{"type", "string"}};
    if (length.least > 0) schema["minLength"] = length.least;
    schema["maxLength"] = length.most;
    declare(key, std::move(schema), text, range + "; ", value, required);
  }
  const Json* given = find(key);
  if (given == nullptr && required) fault(key, "is missing; a string of " + range);
  if (given != nullptr) {
    const std::string* s = given->get_ptr<const std::string*>();
    if (s == nullptr || characters(*s) < length.least || characters(*s) > length.most)
      fault(key, quote(*given) + " is not a string of " + range);
    else
      value = *s;
  }
  record(key, value);
}

void ObjectReader::numbers(std::string_view key, std::vector<double>& values, const Quantity& q, Size length,
                           const KeyText& text) {
  if (describing_) {
    Json schema = {{"type", "array"}};
    if (length.least > 0) schema["minItems"] = length.least;
    schema["maxItems"] = length.most;
    schema["items"] = number_schema(q);
    declare(key, std::move(schema), text, facts_of(q, text.range_words), Json::array(), length.least > 0);
  }
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
  if (describing_)
    declare(key, {{"type", "string"}, {"enum", std::vector<std::string>(words.begin(), words.end())}}, text, "",
            words[fallback], false);
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

ObjectReader ObjectReader::enter(std::string_view key, Absent absent) {
  if (describing_) return describing(faults_);
  if (const Json* value = find(key)) return {*value, pointer(key), faults_};
  if (value_ != nullptr && absent == Absent::defaults) return {empty_object(), pointer(key), faults_};
  fault(key, "is missing; an object");
  return {pointer(key), faults_, false};
}

void ObjectReader::leave(std::string_view key, std::string_view sentence, Absent absent, ObjectReader& child) {
  record(key, child.finish());
  if (!describing_) return;
  Json schema = {{"description", sentence}};
  schema.update(child.schema_);
  schema_["properties"][std::string(key)] = std::move(schema);
  if (absent == Absent::fault) schema_["required"].push_back(key);
}

void ObjectReader::leave_switchable(std::string_view key, const KeyText& text, bool on, ObjectReader& child) {
  if (on) record(key, child.finish());
  if (!describing_) return;
  child.schema_["type"] = {"boolean", "object"};
  declare(key, child.schema_, text, "", false, false);
}

const Json* ObjectReader::list_of_objects(std::string_view key, Size length) {
  const Json* list = find(key);
  if (list == nullptr || (list->is_array() && list->size() >= length.least && list->size() <= length.most)) return list;
  fault(key, (list->is_array() ? "has " + std::to_string(list->size()) + " entries" : quote(*list) + " is not a list") +
                 "; give " + std::to_string(length.least) + " to " + std::to_string(length.most) + " " +
                 std::string(key));
  return nullptr;
}

void ObjectReader::describe_objects(std::string_view key, Size length, const KeyText& text, std::string_view each,
                                    ObjectReader& child) {
  Json items = {{"description", each}};
  items.update(child.schema_);
  declare(key, {{"type", "array"}, {"minItems", length.least}, {"maxItems", length.most}, {"items", std::move(items)}},
          text, std::to_string(length.least) + " to " + std::to_string(length.most) + "; ");
}

void ObjectReader::exclude(std::string_view key, std::string_view other) {
  if (describing_) schema_["not"]["anyOf"].push_back({{"required", {key, other}}});
  if (find(key) != nullptr && find(other) != nullptr)
    fault(key, "is given beside " + std::string(other) + "; give one of the two");
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
        const std::string elsewhere = key_elsewhere(key);
        faults_.add(pointer(key),
                    "is not a known key" + (elsewhere.empty() ? suggestion(key, known_) : " (" + elsewhere + "?)"));
      }
  return std::move(resolved_);
}

}  // namespace talus
