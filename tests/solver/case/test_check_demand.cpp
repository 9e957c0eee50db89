// Numbers that ask for more steps or modes than any run can do.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "documents.hpp"
#include "random_field/random_field.hpp"

namespace talus {
namespace {

using test::faults_of;
using test::minimal;
using test::with;

/// The one fault of a document; "none" where it has none.
std::string fault_of(const Json& document) {
  const auto faults = faults_of(document);
  return faults.empty() ? "none" : faults.size() == 1 ? faults[0] : "several: " + faults[0] + ", " + faults[1];
}

/// The number after `words` in a message.
double number_after(const std::string& message, const std::string& words) {
  const auto at = message.find(words);
  return at == std::string::npos ? std::nan("") : std::stod(message.substr(at + words.size()));
}

Json until(double end, const char* key, double step) { return with("/time", {{"end_s", end}, {key, step}}); }

TEST(CheckDemand, StepsOfARunAreLimited) {
  for (const char* key : {"fixed_step_s", "max_step_s"}) {
    EXPECT_EQ(fault_of(until(2.0, key, 1e-15)),
              std::string("/time/") + key +
                  ": means 2e+15 time steps of 1e-15 s until end_s = 2 s; at most 1e+09 are allowed, that is a step "
                  "of at least 2e-09 s");
    EXPECT_EQ(fault_of(until(2.0, key, 2.001e-9)), "none");
    EXPECT_NE(fault_of(until(2.0, key, 1.999e-9)), "none");
    EXPECT_NE(fault_of(until(2.0, key, 1e-300)).find("means 2e+300 time steps"), std::string::npos);
  }
}

TEST(CheckDemand, TheCourantNumberThatTheMessageStatesIsAllowed) {
  const auto courant = [](double cfl) { return fault_of(with("/numerics/cfl", cfl)); };
  const std::string message = courant(1e-12);
  EXPECT_EQ(message.substr(0, 20), "/numerics/cfl: means");
  const double least = number_after(message, "a Courant number of at least ");
  EXPECT_EQ(courant(1.01 * least), "none");
  EXPECT_NE(courant(0.99 * least), "none");
}

TEST(CheckDemand, WhatElseMakesTheStepShortIsToldAtTheEnd) {
  const auto ending = [](double end) {
    Json document = with("/material/viscosity_Pa_s", 1e9);
    document["time"]["end_s"] = end;
    return fault_of(document);
  };
  const std::string message = ending(1e7);
  EXPECT_EQ(message.substr(0, 18), "/time/end_s: means");
  const double longest = number_after(message, "an end of at most ");
  EXPECT_EQ(ending(0.99 * longest), "none");
  EXPECT_NE(ending(1.01 * longest), "none");
}

Json field(double length, const char* direction = "xy") {
  return with("/random_field", {{"correlation_length_m", length}, {"log_stdev", 0.2}, {"direction", direction}});
}

TEST(CheckDemand, ACorrelationLengthTakesACountableNumberOfModes) {
  const auto faults = faults_of(field(1e-16));
  ASSERT_EQ(faults.size(), 2u);  // one for each axis
  EXPECT_NE(faults[0].find("half of the variance would take "), std::string::npos) << faults[0];
  const double least = number_after(faults[0], "a length of at least ");
  EXPECT_NEAR(least, 12.0 / (3.14159 * 1e6), 0.005 * least) << "12 m of slide";
  EXPECT_NEAR(number_after(faults[0], "would take "), 12.0 / (3.14159 * 1e-16), 1e15);
  EXPECT_EQ(fault_of(field(1.01 * least, "x")), "none");
  EXPECT_NE(fault_of(field(0.99 * least, "x")), "none");
  EXPECT_EQ(faults_of(field(1e-300, "y")).size(), 1u);
}

TEST(CheckDemand, ModesAreFoundForEveryLengthThatIsAllowed) {
  for (const double length : {6.37e-6, 1e-4, 1.0, 1e6}) {
    const FieldSpec spec{.ell_x = length, .ell_y = length, .mu = -0.5, .sigma = 0.2};
    const RandomField made(spec, Box{{0.0, 0.0}, {20.0, 20.0}}, 0.1);
    EXPECT_GT(made.captured_variance(), 0.0) << length;
    EXPECT_LE(made.captured_variance(), 1.0 + 1e-12) << length;
  }
}

TEST(CheckDemand, HalfOfTheVarianceTakesTheModesThatTheLimitCounts) {  // L/(pi l) modes along an axis
  const FieldSpec spec{.direction = FieldDirection::x, .ell_x = 0.05, .mu = -0.5, .sigma = 0.2, .terms = 127};
  const RandomField made(spec, Box{{0.0, 0.0}, {20.0, 20.0}}, 0.1);  // 20/(pi 0.05) = 127.3
  EXPECT_NEAR(made.captured_variance(), 0.5, 0.005);
}

TEST(CheckDemand, ValuesThatActAsZeroOrInfinityAreRefused) {
  for (const auto& [at, value] : {std::pair{"/material/density_kg_m3", 1e-300},
                                  {"/material/friction_angle_deg", 89.99999},
                                  {"/time/end_s", 5e-324},
                                  {"/time/end_s", 1e300},
                                  {"/gravity_m_s2", 1e-300},
                                  {"/gravity_m_s2", 1e300},
                                  {"/numerics/sound_speed_m_s", 1e-300},
                                  {"/material/cohesion_Pa", 1e300}})
    EXPECT_NE(fault_of(with(at, value)).find("is out of range; unit "), std::string::npos) << at << " " << value;
}

TEST(CheckDemand, NoNumberOfACaseMayBeEndless) {
  const std::filesystem::path place = std::filesystem::path(TALUS_SOURCE_DIR) / "schemas/examples/good";
  const Json full = parse_json(read_text(place / "case-full.json"), "case-full.json");
  ASSERT_NO_THROW(load_case(full, place));
  int numbers = 0;
  const Json flat = full.flatten();
  for (const auto& [at, value] : flat.items()) {
    if (!value.is_number()) continue;
    ++numbers;
    for (const double endless : {1e300, -1e300}) {
      Json document = full;
      document[Json::json_pointer(at)] = endless;
      EXPECT_THROW(load_case(document, place), ConfigError) << at << " " << endless;
    }
  }
  EXPECT_GT(numbers, 40);
}

}  // namespace
}  // namespace talus
