#pragma once
// How far the result of a run may be trusted.

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// From best to worst: not_assessed: recorded by a version that assessed nothing; sound: no check objects; doubtful:
/// usable only with the reasons in mind; invalid: not a result.
enum class Verdict { not_assessed, sound, doubtful, invalid };
inline constexpr std::array verdict_words{"not_assessed", "sound", "doubtful", "invalid"};

inline const char* word(Verdict verdict) { return verdict_words[static_cast<std::size_t>(verdict)]; }
/// The verdict of a word; nothing for another word.
inline std::optional<Verdict> verdict_of(std::string_view word) {
  const auto* const at = std::ranges::find(verdict_words, word);
  return at == verdict_words.end() ? std::nullopt : std::optional(static_cast<Verdict>(at - verdict_words.begin()));
}

/// What one check objects to.
struct QualityReason {
  std::string check;  ///< key of the check, as in the table of simulation/checks.cpp
  Verdict verdict = Verdict::doubtful;
  double value = 0.0;   ///< what was found, in the unit of the check
  double limit = 0.0;   ///< what is allowed
  std::string message;  ///< one sentence with the numbers and their units, without semicolon
};

/// The verdict is the worst of the reasons, sound without any.
struct Quality {
  Verdict verdict = Verdict::not_assessed;
  std::vector<QualityReason> reasons = {};
};

/// "invalid: ..." and "doubtful: ...", a line for each reason, the worst first; empty without any.
std::string verdict_lines(const Quality& quality);

/// A reason as tables keep it.
struct Objection {
  std::string check, message;
  bool operator==(const Objection&) const = default;
};

/// "still_moving: ...; left_terrain: ...": the reasons as one cell of a table; empty without any.
std::string objections_text(const Quality& quality);
/// The way back.
std::vector<Objection> objections_in(std::string_view text);

/// "still moving" of "still_moving".
std::string words_of_check(std::string check);

}  // namespace talus
