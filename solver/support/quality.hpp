#pragma once
// How far the result of a run may be trusted.

#include <string>
#include <vector>

namespace talus {

/// sound: no check objects; doubtful: usable only with the reason in mind; invalid: not a result.
enum class Verdict { sound, doubtful, invalid };

/// What one check objects to.
struct QualityReason {
  std::string check;  ///< key of the check, as in the table of simulation/checks.cpp
  Verdict verdict = Verdict::doubtful;
  double value = 0.0;   ///< what was found, in the unit of the check
  double limit = 0.0;   ///< what is allowed
  std::string message;  ///< one sentence with the numbers and their units
};

/// The verdict is the worst of the reasons, sound without any.
struct Quality {
  Verdict verdict = Verdict::sound;
  std::vector<QualityReason> reasons;
};

}  // namespace talus
