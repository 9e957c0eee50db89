#include "case/reader.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "case/words.hpp"

namespace talus {
namespace {

const Json nothing = Json::object();

/// Characters of UTF-8 text.
std::size_t characters(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
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

ObjectReader::ObjectReader(const Json& value, std::string pointer, Faults& faults)
    : value_(&value), pointer_(std::move(pointer)), faults_(faults) {
  if (value.is_object()) return;
  fault("", quote(value) + " is not an object");
  value_ = nullptr;
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

void ObjectReader::record(std::string_view key, Json value) { resolved_[std::string(key)] = std::move(value); }

std::optional<double> ObjectReader::read(std::string_view key, const Quantity& q) {
  const Json* value = find(key);
  return value == nullptr ? std::nullopt : read_number(*value, q, pointer(key), faults_);
}

std::optional<double> ObjectReader::read_whole(std::string_view key, const Quantity& q) {
  const std::optional<double> x = read(key, q);
  if (!x || *x == std::floor(*x)) return x;
  fault(key, to_text(*x) + " is not a whole number; " + q.describe());
  return {};
}

double ObjectReader::number(std::string_view key, const Quantity& q, std::optional<double> standard) {
  if (auto x = read(key, q)) standard = x;
  if (!standard && value_ != nullptr && !value_->contains(key)) fault(key, "is missing; " + q.describe());
  record(key, standard.value_or(q.lo));
  return standard.value_or(q.lo);
}

std::optional<double> ObjectReader::maybe_number(std::string_view key, const Quantity& q) {
  const std::optional<double> x = read(key, q);
  if (x) record(key, *x);
  return x;
}

std::int64_t ObjectReader::integer(std::string_view key, const Quantity& q, std::int64_t standard) {
  if (auto x = read_whole(key, q)) standard = static_cast<std::int64_t>(*x);
  record(key, standard);
  return standard;
}

std::optional<std::int64_t> ObjectReader::maybe_integer(std::string_view key, const Quantity& q) {
  const std::optional<double> x = read_whole(key, q);
  if (!x) return {};
  record(key, static_cast<std::int64_t>(*x));
  return static_cast<std::int64_t>(*x);
}

bool ObjectReader::flag(std::string_view key, bool standard) {
  const Json* value = find(key);
  if (value != nullptr && !value->is_boolean()) fault(key, quote(*value) + " is neither true nor false");
  if (value != nullptr && value->is_boolean()) standard = value->get<bool>();
  record(key, standard);
  return standard;
}

std::string ObjectReader::text(std::string_view key, std::size_t least, std::size_t most,
                               std::optional<std::string> standard) {
  const std::string wanted = "a string of " + std::to_string(least) + " to " + std::to_string(most) + " characters";
  const Json* value = find(key);
  if (value == nullptr && !standard) fault(key, "is missing; " + wanted);
  if (value != nullptr) {
    const std::string* s = value->get_ptr<const std::string*>();
    if (s == nullptr || characters(*s) < least || characters(*s) > most)
      fault(key, quote(*value) + " is not " + wanted);
    else
      standard = *s;
  }
  record(key, standard.value_or(""));
  return standard.value_or("");
}

std::vector<double> ObjectReader::numbers(std::string_view key, const Quantity& q, std::size_t most) {
  std::vector<double> all;
  const Json* value = find(key);
  if (value != nullptr && !value->is_array())
    fault(key, quote(*value) + " is not a list of numbers; each " + q.describe());
  if (value != nullptr && value->is_array() && value->size() > most)
    fault(key, "has " + std::to_string(value->size()) + " numbers, at most " + std::to_string(most) + " are allowed");
  else if (value != nullptr && value->is_array())
    for (std::size_t k = 0; k < value->size(); ++k)
      if (const auto x = read_number((*value)[k], q, pointer_to(pointer(key), k), faults_)) all.push_back(*x);
  record(key, all);
  return all;
}

std::size_t ObjectReader::pick(std::string_view key, std::span<const std::string> known, std::size_t standard) {
  if (const Json* value = find(key)) {
    const std::string* name = value->get_ptr<const std::string*>();
    const auto at = name == nullptr ? known.end() : std::find(known.begin(), known.end(), *name);
    if (at != known.end()) {
      standard = static_cast<std::size_t>(at - known.begin());
    } else {
      std::string list;
      for (const std::string& k : known) list += (list.empty() ? "" : ", ") + k;
      const std::string near = name == nullptr ? "" : nearest_name(*name, known);
      fault(key, quote(*value) + " is not one of " + list + (near.empty() ? "" : " (" + near + "?)"));
    }
  }
  record(key, known[standard]);
  return standard;
}

ObjectReader ObjectReader::object(std::string_view key, bool required) {
  const Json* value = find(key);
  if (value != nullptr) return {*value, pointer(key), faults_};
  if (value_ == nullptr) return {Mute{}, pointer(key), faults_};
  if (!required) return {nothing, pointer(key), faults_};
  fault(key, "is missing; an object");
  return {Mute{}, pointer(key), faults_};
}

Json ObjectReader::finish() {
  if (value_ != nullptr)
    for (const auto& [key, value] : value_->items())
      if (std::find(known_.begin(), known_.end(), key) == known_.end())
        faults_.add(pointer(key), "is not a known key" + suggestion(key, known_));
  return std::move(resolved_);
}

}  // namespace talus
