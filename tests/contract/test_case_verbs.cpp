// talus validate and talus schema as other programs call them: output, streams, exit codes.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

namespace {

struct Outcome {
  int code;
  std::string out;  ///< stdout alone
};

Outcome talus(const std::string& arguments) {
  const std::string command = std::string(TALUS_BINARY_DIR) + "/bin/talus " + arguments + " 2>/dev/null";
  FILE* pipe = popen(command.c_str(), "r");
  std::string out;
  std::array<char, 4096> buffer{};
  while (const std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe)) out.append(buffer.data(), n);
  const int status = pclose(pipe);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, out};
}

const std::string good = std::string(TALUS_SOURCE_DIR) + "/schemas/examples/good/case-full.json";
const std::string bad = std::string(TALUS_SOURCE_DIR) + "/schemas/examples/bad/case-schema-out-of-range.json";

TEST(Validate, SoundCase) {
  const Outcome text = talus("validate " + good);
  EXPECT_EQ(text.code, 0);
  EXPECT_NE(text.out.find("captured variance"), std::string::npos);
  const Outcome outcome = talus("validate --json " + good);
  EXPECT_EQ(outcome.code, 0);
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["valid"], true);
  EXPECT_GT(json["particles"]["soil"], 100);
  EXPECT_GT(json["particles"]["wall"], 100);
  EXPECT_EQ(json["step_s"], 0.001);
  EXPECT_EQ(json["steps"], 5000);
  EXPECT_GT(json["memory_bytes"], 1e6);
  EXPECT_EQ(json["field"]["terms"], 3);
  EXPECT_GT(json["field"]["captured_variance"], 0.0);
  EXPECT_EQ(json["hash"].get<std::string>().size(), 16u);
  EXPECT_TRUE(json["warnings"].is_array());
}

TEST(Validate, ListsTheRateDependenceOfSoilTypesWhereNoneIsStated) {
  const std::string command = "validate " + std::string(TALUS_SOURCE_DIR) +
                              "/solver/cases/road-slope.json --set material.friction_angle_deg=30 "
                              "--set material.viscosity_Pa_s=";
  const auto proposals = nlohmann::json::parse(talus(command + "0 --json").out)["rate_dependence_by_soil"];
  ASSERT_GT(proposals.size(), 3u);
  for (const auto& proposal : proposals) {
    EXPECT_NE(proposal["source"].get<std::string>().find_first_of("12"), std::string::npos) << proposal;
    EXPECT_NE(proposal.contains("viscosity_Pa_s"), proposal.contains("mu_i")) << proposal;
    if (!proposal.contains("mu_i")) continue;
    // tan(mu_2) = tan(30 deg) + rise
    const double mu_2 =
        std::tan(proposal["mu_i"]["high_rate_friction_angle_deg"].get<double>() * std::numbers::pi / 180);
    EXPECT_NEAR(mu_2 - 1.0 / std::numbers::sqrt3, proposal["mu_i"]["friction_rise"].get<double>(), 1e-12);
  }
  const std::string text = talus(command + "0").out;
  EXPECT_NE(text.find("numerical dissipation, which falls with the"), std::string::npos);
  EXPECT_NE(text.find("viscosity_Pa_s 1500 (800 to 3000)"), std::string::npos);
  EXPECT_NE(text.find("viscosity_Pa_s 50 (one value)"), std::string::npos);
  EXPECT_NE(text.find("mu_i: high_rate_friction_angle_deg 39.9"), std::string::npos);
  EXPECT_FALSE(nlohmann::json::parse(talus(command + "1500 --json").out).contains("rate_dependence_by_soil"));
  EXPECT_EQ(talus(command + "1500").out.find("rate dependence"), std::string::npos);
}

TEST(Validate, SaysWhatSpeedOfSoundAndShearModulusAreInForce) {
  const auto numerics = [](const std::string& set) {
    return nlohmann::json::parse(talus("validate --json " + good + set).out)["numerics"];
  };
  EXPECT_EQ(numerics(""), (nlohmann::json{{"sound_speed_m_s", 120.0}, {"shear_modulus_Pa", {1e6, 1e6}}}));
  const auto derived = numerics(" --set rheology.shear_modulus_Pa=null");
  EXPECT_NEAR(derived["shear_modulus_Pa"][1].get<double>() / derived["shear_modulus_Pa"][0].get<double>(),
              1800.0 / 2000.0, 1e-12);
}

TEST(Validate, SaysWhatWasMadeOfTheGround) {
  const auto report = [](const std::string& name, const std::string& set = "") {
    return nlohmann::json::parse(
        talus("validate --json " + std::string(TALUS_SOURCE_DIR) + "/solver/cases/" + name + ".json" + set).out);
  };
  const auto road = report("road-slope");
  EXPECT_EQ(road["files"][0],
            "road-slope-ground.csv: columns \"chainage_m\" and \"elevation_m\", separated by commas, 21 vertices");
  EXPECT_EQ(road["files"].size(), 2u);
  EXPECT_EQ(road["ground"]["source"], "the bed joined from the surfaces of the slide");
  EXPECT_EQ(road["ground"]["vertices"], (nlohmann::json{{"given", 23}, {"kept", 23}}));
  EXPECT_EQ(road["ground"]["moved_m"], 0.0);
  EXPECT_EQ(road["ground"]["left_end"]["kind"], "wall");
  EXPECT_EQ(road["ground"]["right_end"], (nlohmann::json{{"kind", "open"}, {"x_m", 95.0}, {"y_m", 8.1}}));
  EXPECT_EQ(road["slide"]["x_m"], (nlohmann::json{8.0, 35.0}));
  EXPECT_EQ(road["slide"]["slides_to"], "right");
  EXPECT_NEAR(road["slide"]["thickness_m"].get<double>(), 6.8, 0.3);
  const auto coarse = report("road-slope", " --set particle_spacing_m=3");
  EXPECT_LT(coarse["ground"]["vertices"]["kept"], 23) << "vertices nearer than the spacing are taken out";
  EXPECT_GT(coarse["ground"]["moved_m"], 0.0);
  EXPECT_LE(coarse["ground"]["moved_m"], 0.5 * 3);
}

TEST(Plot, DrawsACaseBeforeItIsRun) {
  const std::string out = ::testing::TempDir() + "input-case.svg";
  const Outcome drawn = talus("plot " + good + " --walls --out " + out);
  EXPECT_EQ(drawn.code, 0);
  EXPECT_EQ(drawn.out, out + "\n");
  std::ifstream file(out);
  const std::string svg(std::istreambuf_iterator<char>(file), {});
  EXPECT_NE(svg.find("Every key"), std::string::npos);
  EXPECT_NE(svg.find("wall particles"), std::string::npos);
  std::remove(out.c_str());
  EXPECT_EQ(talus("plot " + bad + " --out " + out).code, 3);
  EXPECT_EQ(talus("plot /tmp --out " + out).code, 2) << "a directory has its figures in it";
}

TEST(Validate, BadCase) {
  const Outcome text = talus("validate " + bad);
  EXPECT_EQ(text.code, 3);
  EXPECT_EQ(text.out, "") << "messages belong on stderr";
  const Outcome outcome = talus("validate --json " + bad);
  EXPECT_EQ(outcome.code, 3);
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["valid"], false);
  EXPECT_EQ(json["faults"].size(), 5u);
  EXPECT_EQ(json["faults"][0]["pointer"], "/material/density_kg_m3");
}

TEST(Validate, Overrides) {
  EXPECT_EQ(nlohmann::json::parse(
                talus("validate --json --set time.fixed_step_s=0.0005 --set random_field=null " + good).out)["steps"],
            10'000);
  const auto json = nlohmann::json::parse(talus("validate --json " + good + " --set time.fixed_step_s=fast").out);
  EXPECT_NE(json["faults"][0]["message"].get<std::string>().find("(from --set time.fixed_step_s=fast)"),
            std::string::npos);
}

TEST(Validate, ExitCodes) {
  EXPECT_EQ(talus("validate /nonexistent/case.json").code, 5);
  EXPECT_EQ(talus("validate").code, 2);
  EXPECT_EQ(talus("validate --no-such-option " + good).code, 2);
}

TEST(Schema, PrintsListsAndRefuses) {
  const Outcome outcome = talus("schema case");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(nlohmann::json::parse(outcome.out)["title"], "Talus case");
  EXPECT_NE(talus("schema").out.find("case\n"), std::string::npos);
  EXPECT_EQ(talus("schema cases").code, 2);
}

}  // namespace
