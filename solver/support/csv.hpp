#pragma once
// Comma-separated values (RFC 4180), read row by row and written field by field.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// Whose table it is.
enum class CsvStyle {
  strict,   ///< written by a program: commas, every line a row
  by_hand,  ///< a person's: commas, semicolons or tabs, # comments, a byte order mark, blanks around fields
};

/// Splits a row at a separator; fields lose their quotation marks. A blank as separator stands for any run of blanks
/// and tabs.
/// @return no fields at all where a quotation mark is not closed
std::vector<std::string> split_fields(std::string_view row, char separator);

/// The bytes of a text file as UTF-8 without a byte order mark: from UTF-16 of either byte order, told by its mark or
/// by the zero byte of its first character; from Latin-1 where the bytes are not UTF-8.
std::string decoded(std::string_view bytes);

/// Goes through the rows of a text; holds one row at a time. Blank lines are skipped; a row ends with its line.
class CsvRows {
 public:
  explicit CsvRows(std::string_view text, CsvStyle style = CsvStyle::strict);

  /// Reads the next row; false at the end of the text.
  bool next();
  /// The line of the row, counted from 1.
  int line() const { return line_; }
  /// The fields of the row without their quotation marks; none at all where a quotation mark is not closed.
  const std::vector<std::string>& fields() const { return fields_; }
  /// The row as it stands in the text, without the end of its line.
  std::string_view text() const { return row_; }

 private:
  std::string_view rest_;
  CsvStyle style_;
  std::string_view row_;
  std::vector<std::string> fields_;
  int line_ = 0;
};

/// A text as a field on one line: in quotation marks, line breaks as blanks; an empty text stays empty.
std::string csv_quoted(std::string_view text);

/// @throws IoError "PATH:LINE: WHAT". @param line  counted from 1
[[noreturn]] void throw_at_line(const std::filesystem::path& path, int line, const std::string& what);

}  // namespace talus
