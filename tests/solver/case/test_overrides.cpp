#include <gtest/gtest.h>

#include "case/overrides.hpp"
#include "documents.hpp"

namespace talus {
namespace {

using test::faults_of;
using test::minimal;

Json edited(Json document, const std::vector<std::string>& overrides) {
  Faults faults;
  apply_overrides(document, overrides, faults);
  faults.raise();
  return document;
}

TEST(Overrides, ReplaceAddAndRemove) {
  const Json before = Json::parse(R"({"a": {"b": [1, {"c": 2}]}, "d": 3})");
  EXPECT_EQ(edited(before, {"a.b.1.c=0.5"})["a"]["b"][1]["c"], 0.5);
  EXPECT_EQ(edited(before, {"a.b.0=[1,2]"})["a"]["b"][0].dump(), "[1,2]");
  EXPECT_EQ(edited(before, {"e.f.g=true"})["e"]["f"]["g"], true);
  EXPECT_FALSE(edited(before, {"d=null"}).contains("d"));
  EXPECT_EQ(edited(before, {"d=1", "d=2"})["d"], 2) << "the last one holds";
}

TEST(Overrides, ValueIsJsonElseText) {
  EXPECT_EQ(edited({{"t", 0}}, {"t=leapfrog"})["t"], "leapfrog");
  EXPECT_EQ(edited({{"t", 0}}, {"t=\"7\""})["t"], "7");
  EXPECT_EQ(edited({{"t", 0}}, {"t=a=b"})["t"], "a=b");
  EXPECT_EQ(edited({{"t", 0}}, {"t="})["t"], "");
  EXPECT_EQ(edited({{"t", 0}}, {"t=1e-3"})["t"], 1e-3);
}

TEST(Overrides, BadPathsAreFaults) {
  EXPECT_EQ(faults_of(minimal(), {"nonsense"}),
            std::vector<std::string>{"--set nonsense: is not of the form key.path=value"});
  EXPECT_EQ(faults_of(minimal(), {"a..b=1"}).size(), 1u);
  EXPECT_EQ(faults_of(minimal(), {"=1"}).size(), 1u);
  EXPECT_EQ(faults_of(minimal(), {"slide.outlines.1.material.cohesion_Pa=5"})[0],
            "/slide/outlines: has no element \"1\", it has 1 (counted from 0) (from --set "
            "slide.outlines.1.material.cohesion_Pa=5)");
  EXPECT_EQ(faults_of(minimal(), {"title.x=5"})[0],
            "/title: is neither object nor array, it holds nothing called \"x\" (from --set title.x=5)");
}

TEST(Overrides, PassTheSameCheckAndSayWhereTheyCameFrom) {
  EXPECT_EQ(faults_of(minimal(), {"material.cohesion_Pa=-1"})[0],
            "/material/cohesion_Pa: -1 is out of range; unit Pa, allowed >= 0 and <= 1e+09 (from --set "
            "material.cohesion_Pa=-1)");
  EXPECT_EQ(faults_of(minimal(), {"materail.cohesion_Pa=1"})[0],
            "/materail: is not a known key (material?) (from --set materail.cohesion_Pa=1)");
  const auto both = faults_of(test::with("/time/end_s", 0), {"study.seed=-1"});
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[0].find("--set"), std::string::npos) << "the file's own fault is not the option's";
}

TEST(Overrides, DoubleKeysAndDepthInAValueAreRefused) {
  EXPECT_THROW(edited(minimal(), {"time={\"end_s\":1,\"end_s\":2}"}), ConfigError);
  EXPECT_THROW(edited(minimal(), {"time=" + std::string(100, '[') + std::string(100, ']')}), ConfigError);
}

TEST(Overrides, AreInForce) {
  const LoadedCase loaded =
      test::load(minimal(), {"particle_spacing_m=0.4", "slide.outlines.0.material.friction_angle_deg=20"});
  EXPECT_EQ(loaded.value.model.dx, 0.4);
  EXPECT_EQ(loaded.value.model.materials.size(), 2u);
  EXPECT_EQ(loaded.resolved["particle_spacing_m"], 0.4);
}

}  // namespace
}  // namespace talus
