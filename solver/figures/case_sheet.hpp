#pragma once
// A case before it is run: ground as given and as fitted to the spacing, slide, ends.

#include "case/ground_report.hpp"
#include "figures/sheet.hpp"

namespace talus::figures {

/// The whole section at a scale of 1 : 1. Materials have a colour each; ends of the bed without a wall are marked.
/// @param walls  draw the wall particles as well
Sheet case_sheet(const LoadedCase& loaded, const GroundReport& report, const Stamps& stamps, bool walls);

}  // namespace talus::figures
