#pragma once
// Text of messages and numbers: the nearest known name, a value shortened, a number in its shortest form.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// 2^53 - 1: the largest integer that every reader of JSON keeps exact.
inline constexpr std::int64_t max_exact_integer = (std::int64_t{1} << 53) - 1;

/// Levenshtein distance: the fewest insertions, deletions and substitutions that turn `a` into `b`.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The known name nearest to `word`, or "" when none is nearer than half of the longer one's length.
std::string nearest_name(std::string_view word, std::span<const std::string> known);

/// " (cohesion_Pa?)" when a known name is near, else "; known: a, b, c".
std::string suggestion(std::string_view word, std::span<const std::string> known);

/// At most `most` bytes of `text`, cut between characters and marked with "..."; control characters become '?'.
std::string shorten(std::string_view text, std::size_t most = 60);

/// The word shortened, between quotation marks.
std::string in_quotes(std::string_view word);

/// The shortest decimal that reads back as `x`, whatever the locale: "0.1", "1e+09".
std::string to_text(double x);
inline std::string to_text(std::int64_t x) { return std::to_string(x); }

/// Three significant digits: "0.333".
std::string rounded(double x);

/// The number that the whole of `text` spells, with an optional sign: "+0.5", "-1e3"; nothing where it is not one, or
/// not finite.
std::optional<double> to_number(std::string_view text);
/// The whole number >= 0 that the whole of `digits` spells; nothing where it is not one, or too large.
std::optional<std::int64_t> to_integer(std::string_view digits);

}  // namespace talus
