#include "support/csv.hpp"

#include <algorithm>
#include <cstdint>

#include "support/error.hpp"

namespace talus {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r";
  const std::size_t first = text.find_first_not_of(blanks);
  return first == std::string_view::npos ? std::string_view()
                                         : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

void append_utf8(std::string& text, std::uint32_t code) {
  if (code < 0x80) {
    text += static_cast<char>(code);
    return;
  }
  const int more = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;  // bytes after the first
  constexpr std::uint32_t lead[] = {0, 0xC0, 0xE0, 0xF0};
  text += static_cast<char>(lead[more] | (code >> (6 * more)));
  for (int k = more - 1; k >= 0; --k) text += static_cast<char>(0x80 | ((code >> (6 * k)) & 0x3F));
}

/// Whether the bytes are UTF-8, by the number of continuation bytes alone.
bool is_utf8(std::string_view bytes) {
  int due = 0;
  for (const char c : bytes) {
    const auto b = static_cast<unsigned char>(c);
    const bool continues = (b & 0xC0) == 0x80;
    if (continues != (due > 0)) return false;
    if (continues)
      --due;
    else if (b >= 0x80)
      due = b >= 0xF8 ? -1 : b >= 0xF0 ? 3 : b >= 0xE0 ? 2 : b >= 0xC2 ? 1 : -1;
    if (due < 0) return false;
  }
  return due == 0;
}

std::string from_utf16(std::string_view bytes, bool big_endian) {
  const auto unit = [&](std::size_t i) {
    const auto first = static_cast<unsigned char>(bytes[i]), second = static_cast<unsigned char>(bytes[i + 1]);
    return static_cast<std::uint32_t>(big_endian ? first << 8 | second : second << 8 | first);
  };
  constexpr std::uint32_t replacement = 0xFFFD;  // for half a pair
  std::string text;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    std::uint32_t code = unit(i);
    const bool high = code >= 0xD800 && code < 0xDC00;
    const std::uint32_t low = high && i + 3 < bytes.size() ? unit(i + 2) : 0;
    if (low >= 0xDC00 && low < 0xE000) {
      code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
      i += 2;
    } else if (code >= 0xD800 && code < 0xE000) {
      code = replacement;
    }
    append_utf8(text, code);
  }
  return text;
}

}  // namespace

std::string decoded(std::string_view bytes) {
  using namespace std::string_view_literals;
  if (bytes.starts_with("\xFF\xFE"sv)) return from_utf16(bytes.substr(2), false);
  if (bytes.starts_with("\xFE\xFF"sv)) return from_utf16(bytes.substr(2), true);
  if (bytes.size() > 1 && bytes[1] == '\0') return from_utf16(bytes, false);
  if (bytes.size() > 1 && bytes[0] == '\0') return from_utf16(bytes, true);
  if (bytes.starts_with("\xEF\xBB\xBF"sv)) bytes.remove_prefix(3);
  if (is_utf8(bytes)) return std::string(bytes);
  std::string text;
  for (const char c : bytes) append_utf8(text, static_cast<unsigned char>(c));
  return text;
}

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
    const bool by_hand = style_ == CsvStyle::by_hand;
    const auto holds = [this](char c) { return row_.find(c) != std::string_view::npos; };
    fields_ = split_fields(row_, by_hand && holds(';') ? ';' : by_hand && holds('\t') ? '\t' : ',');
    if (by_hand)
      for (std::string& field : fields_) field = trimmed(field);
    return true;
  }
  return false;
}

std::vector<std::string> split_fields(std::string_view row, char separator) {
  const auto separates = [separator](char c) { return c == separator || (separator == ' ' && c == '\t'); };
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const char c = row[i];
    if (c == '"' && quoted && i + 1 < row.size() && row[i + 1] == '"') {
      fields.back() += row[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!separates(c) || quoted) {
      fields.back() += c;
    } else if (separator != ' ' || !fields.back().empty()) {
      fields.emplace_back();
    }
  }
  if (quoted) fields.clear();
  return fields;
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

void throw_at_line(const std::filesystem::path& path, int line, const std::string& what) {
  throw IoError(path.string() + ":" + std::to_string(line) + ": " + what);
}

}  // namespace talus
