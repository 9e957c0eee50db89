#include <gtest/gtest.h>

#include "case/overrides.hpp"
#include "documents.hpp"

namespace talus {
namespace {

/// As on the command line: "study.realisations" gets a value, "rheology.yield=regularised" has one.
std::string as_override(std::string_view name) {
  return std::string(name) + (name.find('=') == std::string_view::npos ? "=7" : "");
}

TEST(CaseAliases, GiveTheSameCaseAndAWarning) {
  ASSERT_EQ(std::size(case_aliases), 3u);
  for (const auto& [alias, name] : case_aliases) {
    const LoadedCase old = test::load(test::minimal(), {as_override(alias)});
    const LoadedCase present = test::load(test::minimal(), {as_override(name)});
    EXPECT_EQ(old.resolved, present.resolved) << alias;
    EXPECT_NE(present.resolved, test::load(test::minimal()).resolved) << name << " changes nothing";
    ASSERT_EQ(old.warnings.size(), present.warnings.size() + 1) << alias;
    EXPECT_NE(old.warnings[0].message.find("write " + std::string(name)), std::string::npos);
    Json document = test::minimal();
    std::vector<std::string> none;
    Faults faults;
    apply_overrides(document, std::vector{as_override(alias)}, faults);
    EXPECT_EQ(test::load(document).resolved, present.resolved) << alias << " in the file";
    EXPECT_EQ(replace_aliases(document, none).size(), 1u);
  }
}

TEST(CaseAliases, OverridesWinOverThePresentNameInTheFile) {
  const Json document = test::with("/study", {{"realizations", 5}});
  EXPECT_EQ(test::load(document, {"study.realisations=6"}).value.study.realizations, 6);
}

TEST(CaseAliases, AreUnknownBesideThePresentName) {
  EXPECT_EQ(test::faults_of(test::with("/study", {{"realizations", 5}, {"realisations", 6}})),
            std::vector<std::string>{"/study/realisations: is not a known key (realizations?)"});
}

TEST(CaseAliases, LeaveAnythingElseAlone) {
  for (const Json& document : {Json(5), Json::array(), Json{{"study", 5}}, Json{{"rheology", {{"yield", 5}}}}}) {
    Json changed = document;
    std::vector<std::string> overrides = {"study.realisation", "study.realisationsx=5", "rheology.yield=elastic"};
    EXPECT_TRUE(replace_aliases(changed, overrides).empty()) << document;
    EXPECT_EQ(overrides[2], "rheology.yield=elastic");
    EXPECT_EQ(changed, document);
  }
}

}  // namespace
}  // namespace talus
