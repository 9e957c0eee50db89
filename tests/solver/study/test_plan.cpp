#include <cstdint>

#include "case/load.hpp"
#include "studies.hpp"
#include "study/plan.hpp"
#include "support/error.hpp"

using namespace talus;
using namespace talus::fixtures;

namespace {

/// Why `asked` may not go on where `begun` was begun; empty if it may.
std::string refusal(const Plan& begun, const Plan& asked, bool resume = false) {
  try {
    check_continues(begun, asked, "dir", resume);
  } catch (const IoError& e) {
    return e.what();
  }
  return {};
}

LoadedCase a_case() {
  LoadedCase c;
  c.value.title = "A slope";
  c.value.field = FieldSpec{.sigma = 0.2};
  c.hash = "0123456789abcdef";
  return c;
}

std::string pointer_of_fault(const LoadedCase& c) {
  try {
    make_plan(c, 1, "0.1.0");
  } catch (const ConfigError& e) {
    return e.faults.front().pointer;
  }
  return "none";
}

}  // namespace

TEST(Plan, ReadsBack) {
  const TemporaryDirectory directory;
  EXPECT_FALSE(find_plan(directory.path()));
  Plan p = plan(30);
  p.seed = 18446744073709551615ULL;
  p.study = {.realizations = 30,
             .seed = {},
             .noise_floor_replicates = 3,
             .sampling = Sampling::latin_hypercube,
             .stratified_modes = 7,
             .stop_half_width = 0.25,
             .max_failed_share = 0.2,
             .histogram_edges = {1.0, 2.5}};
  p.earlier = {"0011223344556677"};
  write_plan(directory.path(), p);
  const Plan back = *find_plan(directory.path());
  EXPECT_EQ(back.title, p.title);
  EXPECT_EQ(back.of.hash, p.of.hash);
  EXPECT_EQ(back.of.hash_without_end, "family");
  EXPECT_EQ(back.of.end, 2.0);
  EXPECT_EQ(back.earlier, p.earlier);
  EXPECT_EQ(back.version, p.version);
  EXPECT_EQ(back.seed, p.seed);
  EXPECT_EQ(back.study.realizations, 30);
  EXPECT_EQ(back.study.noise_floor_replicates, 3);
  EXPECT_EQ(back.study.sampling, Sampling::latin_hypercube);
  EXPECT_EQ(back.study.stratified_modes, 7);
  EXPECT_EQ(back.study.stop_half_width, 0.25);
  EXPECT_EQ(back.study.max_failed_share, 0.2);
  EXPECT_EQ(back.study.histogram_edges, (std::vector{1.0, 2.5}));
  write(directory / "plan.json", "{}");
  EXPECT_THROW(find_plan(directory.path()), IoError);
}

TEST(Plan, OnlyTheSameStudyOrALongerOneGoesOn) {
  EXPECT_EQ(refusal(plan(10), plan(10)), "");
  EXPECT_EQ(refusal(plan(10), plan(25)), "");
  EXPECT_NE(refusal(plan(10), plan(9)).find("dir holds a study with more planned realizations, 10, not 9"),
            std::string::npos);
  Plan other = plan(10);
  other.seed = 43;
  other.of.hash = "fedcba9876543210";
  const std::string both = refusal(plan(10), other);
  EXPECT_NE(both.find("study.seed 42, not 43"), std::string::npos);
  EXPECT_NE(both.find("the case hash 0123456789abcdef, not fedcba9876543210"), std::string::npos);
  other = plan(10);
  other.version = "0.2.0";
  EXPECT_NE(refusal(plan(10), other).find("version"), std::string::npos);
  other = plan(10);
  other.study.histogram_edges = {1.0, 2.0};  // changes no run
  other.study.stop_half_width = 0.1;
  EXPECT_EQ(refusal(plan(10), other), "");
}

TEST(Plan, ALaterEndGoesOnWithResumeOnly) {
  Plan later = plan(10);
  later.of = {"fedcba9876543210", "family", 12.0};
  EXPECT_EQ(refusal(plan(10), later, true), "");
  EXPECT_EQ(refusal(plan(10), later), "dir holds this study up to t = 2 s; --resume continues it to 12 s");
  EXPECT_EQ(refusal(later, plan(10), true),
            "dir holds this study up to t = 12 s, beyond time.end_s = 2 s; choose another directory");
  later.of.hash_without_end = "another";
  EXPECT_NE(refusal(plan(10), later, true).find("the case hash"), std::string::npos);
}

TEST(Plan, ALatinHypercubeDoesNotGrow) {
  Plan ten = plan(10), twenty = plan(20);
  ten.study.sampling = twenty.study.sampling = Sampling::latin_hypercube;
  EXPECT_EQ(refusal(ten, ten), "");
  EXPECT_NE(refusal(ten, twenty).find("a Latin hypercube of 10 realizations, which cannot become one of 20"),
            std::string::npos);
}

TEST(Plan, RefusesStudiesThatMakeNoSense) {
  EXPECT_EQ(pointer_of_fault(a_case()), "none");
  LoadedCase c = a_case();
  c.value.field.reset();
  EXPECT_EQ(pointer_of_fault(c), "/random_field");
  c.value.study.realizations = 1;  // one run and its noise floor are a question worth asking
  EXPECT_EQ(pointer_of_fault(c), "none");
  c = a_case();
  c.value.field->sigma = 0.0;
  EXPECT_EQ(pointer_of_fault(c), "/random_field");
  c = a_case();
  c.value.field->xi = {1.0};
  EXPECT_EQ(pointer_of_fault(c), "/random_field/xi");
  c = a_case();
  c.value.study.sampling = Sampling::latin_hypercube;
  c.value.study.stop_half_width = 0.1;
  EXPECT_EQ(pointer_of_fault(c), "/study/stop_when_ci_half_width_below_m");
}
