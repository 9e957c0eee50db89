#include <gtest/gtest.h>

#include <cstdint>
#include <numbers>

#include "example_frame.hpp"
#include "figures/profile.hpp"
#include "figures/sheet.hpp"
#include "reading.hpp"
#include "support/error.hpp"
#include "temporary_directory.hpp"

namespace talus::figures {
namespace {

using test::block;
using test::contains;
using test::three_particles;

const Terrain slope{.bed = {{0, 10}, {10, 0}, {40, 0}}, .wall_top = 12, .run_out = {1.0}};

void plot_one(const Frame& frame, const Terrain& terrain, double dx, Colour colour, const std::filesystem::path& path,
              const Stamps& stamps) {
  const Snapshot shot{&frame, colour, {}};
  plot_profiles({&shot, 1}, terrain, dx, path, stamps);
}

TEST(Profile, DrawsTheSoilAndNothingElse) {
  const Frame frame = three_particles();
  const Snapshot shot{&frame, Colour::speed, {}};
  const std::string script = profile_sheet({&shot, 1}, slope, 0.5, {"title", "", ""}).script.text();
  const auto soil = block(script, "soil0");
  ASSERT_EQ(soil.size(), 3u);
  EXPECT_EQ(soil[0], (std::vector<double>{2, 9, 1}));
  EXPECT_EQ(soil[1], (std::vector<double>{20, 0.5, 1}));
  EXPECT_EQ(soil[2], (std::vector<double>{5, 6, 7}));
  EXPECT_TRUE(contains(script, "'t = 2.25 s'"));
  // The radius is that of the circle around a square of edge 0.5.
  EXPECT_TRUE(contains(script, "(" + number(0.25 * std::numbers::sqrt2) + "):3 with circles"));
}

TEST(Profile, TheFrontIsTheFarthestSoilParticleFromTheLeftBoundary) {
  const Frame frame = three_particles();
  const Snapshot shot{&frame, Colour::speed, {}};
  const std::string script = profile_sheet({&shot, 1}, slope, 0.5, {}).script.text();
  EXPECT_TRUE(contains(script, "'front 19.00 m'"));
  EXPECT_EQ(block(script, "front0")[0], (std::vector<double>{20, 0}));
  EXPECT_FALSE(contains(profile_sheet({&shot, 1}, slope, 0.5, {}, {.mark_front = false}).script.text(), "front 19"));
}

TEST(Profile, OneColourScaleForAllSnapshotsOfAQuantity) {
  const Frame slow = three_particles();
  Frame fast = slow;
  fast.velocity[0] = {15, 0};
  const std::array shots{Snapshot{&slow, Colour::speed, {}}, Snapshot{&fast, Colour::speed, {}}};
  const std::string script = profile_sheet(shots, slope, 0.5, {}).script.text();
  const std::size_t first = script.find("set cbrange [0:16]");
  ASSERT_NE(first, std::string::npos);
  EXPECT_NE(script.find("set cbrange [0:16]", first + 1), std::string::npos);
}

TEST(Profile, ViewHoldsTheSoilButNotWhatFellOffTheEnd) {
  Frame frame = three_particles();
  const std::array<const Frame*, 1> frames{&frame};
  const Box near = view_of(frames, slope, 0.5);
  EXPECT_LT(near.lo.x, 1.0);
  EXPECT_GT(near.hi.x, 20.5);
  EXPECT_LT(near.hi.x, 30.0);
  EXPECT_LT(near.lo.y, 0.0);
  EXPECT_GT(near.hi.y, 9.5);
  frame.position[1] = {500, -300};
  const Box far = view_of(frames, slope, 0.5);
  EXPECT_LT(far.hi.x, 60.0);
  EXPECT_GT(far.lo.y, -10.0);
}

TEST(Profile, PngHasTheSizeOfTheCanvasTimesTwo) {
  const test::TemporaryDirectory directory;
  const Frame frame = three_particles();
  const Snapshot shot{&frame, Colour::pressure, {}};
  const std::filesystem::path path = directory.path() / "a.png";
  plot_one(frame, slope, 0.5, Colour::pressure, path, {"title", "", ""});
  const Canvas canvas = profile_sheet({&shot, 1}, slope, 0.5, {}).canvas;
  EXPECT_EQ(test::png_size(path),
            (test::Size{static_cast<std::uint32_t>(2 * canvas.width), static_cast<std::uint32_t>(2 * canvas.height)}));
}

// 12,600 particles as in the illustrative case.
TEST(Profile, SvgOfManyParticlesStaysSmall) {
  const test::TemporaryDirectory directory;
  Frame frame;
  for (int i = 0; i < 12600; ++i) {
    frame.position.push_back({0.1 * (i % 360), 0.1 * (i / 360)});
    frame.tan_phi.push_back(0.4 + 0.1 * std::sin(0.01 * i));
  }
  frame.n_soil = frame.position.size();
  const std::filesystem::path path = directory.path() / "a.svg";
  plot_one(frame, {.bed = {{0, 0}, {40, 0}}, .run_out = {}}, 0.1, Colour::friction_angle, path, {"title", "", ""});
  const std::string svg = read_file(path, 1'000'000);
  EXPECT_TRUE(contains(svg, "data:image/png;base64,"));
  EXPECT_TRUE(contains(svg, "font-weight=\"bold\""));
  EXPECT_FALSE(contains(svg, "sans-serif:Bold"));
}

// gnuplot complains on stderr when it cannot do what the script says.
TEST(Profile, GnuplotHasNothingToSay) {
  const Frame frame = three_particles();
  const std::array shots{Snapshot{&frame, Colour::speed, {}}, Snapshot{&frame, Colour::friction_angle, {}}};
  const Terrain ring{.bed = {{-1, -1}, {30, -1}, {30, 30}, {-1, 30}}, .closed = true, .run_out = {}};
  for (const Terrain& terrain : {slope, ring}) {
    for (const bool raster : {false, true}) {
      const Sheet sheet = profile_sheet(shots, terrain, 0.5, {"t", "s", "u"}, {}, raster);
      EXPECT_EQ(run_gnuplot("set terminal pngcairo noenhanced\n" + sheet.script.text()).warnings, "");
    }
  }
}

TEST(Profile, AFrameWithoutSoilIsDrawnAsTerrain) {
  const test::TemporaryDirectory directory;
  const Frame empty;
  plot_one(empty, slope, 0.5, Colour::speed, directory.path() / "a.png", {"title", "", ""});
  EXPECT_GT(test::png_size(directory.path() / "a.png").width, 0u);
}

TEST(Profile, HostileTitlesAreText) {
  const test::TemporaryDirectory directory;
  const Frame frame = three_particles();
  const std::filesystem::path canary = directory.path() / "canary";
  const std::string attack = "touch " + canary.string();
  const std::vector<std::string> titles{"'; system('" + attack + "') #",
                                        "`" + attack + "`",
                                        "\"; system(\"" + attack + "\")",
                                        "x\n! " + attack + "\n",
                                        "\\",
                                        "$(" + attack + ")",
                                        "<script>alert(1)</script>",
                                        "END_OF_DATA"};
  for (const std::string& title : titles) {
    const std::filesystem::path path = directory.path() / "a.svg";
    plot_one(frame, slope, 0.5, Colour::speed, path, {title, title, title});
    const std::string svg = read_file(path, 1'000'000);
    EXPECT_FALSE(contains(svg, "<script>"));
    EXPECT_FALSE(std::filesystem::exists(canary)) << title;
  }
}

TEST(Profile, OtherEndingsAreRefused) {
  const test::TemporaryDirectory directory;
  EXPECT_THROW(plot_one(three_particles(), slope, 0.5, Colour::speed, directory.path() / "a.jpg", {}), IoError);
  EXPECT_FALSE(std::filesystem::exists(directory.path() / "a.jpg"));
}

}  // namespace
}  // namespace talus::figures
