#include "support/csv.hpp"

#include <algorithm>

namespace talus {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r";
  const std::size_t first = text.find_first_not_of(blanks);
  return first == std::string_view::npos ? std::string_view()
                                         : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

}  // namespace

CsvRows::CsvRows(std::string_view text, CsvStyle style) : rest_(text), style_(style) {
  if (style == CsvStyle::by_hand && rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
}

bool CsvRows::next() {
  while (!rest_.empty()) {
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    row_ = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++line_;
    if (row_.ends_with('\r')) row_.remove_suffix(1);
    if (style_ == CsvStyle::by_hand) row_ = trimmed(row_);
    if (row_.empty() || (style_ == CsvStyle::by_hand && row_.starts_with('#'))) continue;
    split();
    return true;
  }
  return false;
}

void CsvRows::split() {
  const auto holds = [this](char c) { return row_.find(c) != std::string_view::npos; };
  const bool by_hand = style_ == CsvStyle::by_hand;
  const char separator = by_hand && holds(';') ? ';' : by_hand && holds('\t') ? '\t' : ',';
  std::size_t n = 0;
  const auto begin_field = [&] {
    if (n == fields_.size()) fields_.emplace_back();
    fields_[n++].clear();
  };
  begin_field();
  bool quoted = false;
  for (std::size_t i = 0; i < row_.size(); ++i) {
    const char c = row_[i];
    if (c == '"' && quoted && i + 1 < row_.size() && row_[i + 1] == '"') {
      fields_[n - 1] += row_[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == separator && !quoted) {
      begin_field();
    } else {
      fields_[n - 1] += c;
    }
  }
  fields_.resize(quoted ? 0 : n);
  if (by_hand)
    for (std::string& field : fields_) field = trimmed(field);
}

std::string csv_quoted(std::string_view text) {
  if (text.empty()) return {};
  std::string field = "\"";
  for (const char c : text) {
    if (c == '"') field += '"';
    field += c == '\n' || c == '\r' ? ' ' : c;
  }
  return field + '"';
}

}  // namespace talus
