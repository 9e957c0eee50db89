#pragma once
// What a person sees while a study runs, and at its end. Makes text; prints nothing.

#include <optional>
#include <string>

#include "study/run_study.hpp"
#include "support/json.hpp"

namespace talus::cli {

/// Time to go at the present rate [s]; unset before the first run has ended.
std::optional<double> time_left(const Progress& progress);

/// "12/100 done, 1 failed, mean farthest particle 34.12 +/- 0.31 m, 22 min left, 4 running, 240/h"
std::string progress_line(const Progress& progress);

/// The same behind a bar, cut to `width` columns.
std::string progress_bar(const Progress& progress, int width);

/// Columns of the terminal that stderr is; 80 where it is none.
int terminal_width();

/// What ends `talus study`, from the content of study.json: a table of all measures, and the histogram of the leading
/// one, 80 columns wide.
std::string study_report(const Json& study);

/// The table alone.
std::string summary_table(const Json& study);

/// The means by regression, and what moves the leading measure; a phrase where there is no regression.
std::string regression_text(const Json& study);

/// The histogram of a quantity as bars of text, `width` columns in all; empty where there is none.
std::string text_histogram(const Json& quantity, int width);

}  // namespace talus::cli
