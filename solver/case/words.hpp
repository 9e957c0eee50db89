#pragma once
// Words for messages: the nearest known name, a value shortened, a number as a person writes it.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "math/vec2.hpp"

namespace talus {

/// Levenshtein distance: the fewest insertions, deletions and substitutions that turn `a` into `b`.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The known name nearest to `word`, or "" when none is nearer than half of the longer one's length.
std::string nearest_name(std::string_view word, std::span<const std::string> known);

/// " (cohesion_Pa?)" when a known name is near, else "; known: a, b, c".
std::string suggestion(std::string_view word, std::span<const std::string> known);

/// At most `most` bytes of `text`, cut between characters and marked with "..."; control characters become '?'.
std::string shorten(std::string_view text, std::size_t most = 60);

/// The shortest decimal that reads back as `x`: "0.1", "1e+09".
std::string to_text(double x);
/// Three significant digits: "0.333".
std::string rounded(double x);
/// "(3, 4.5)"
std::string to_text(Vec2 p);
/// The word shortened, between quotation marks.
std::string in_quotes(std::string_view word);

}  // namespace talus
