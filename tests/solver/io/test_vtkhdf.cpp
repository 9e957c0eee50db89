#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <map>
#include <random>
#include <stdexcept>

#include "io/vtkhdf.hpp"
#include "io_faults.hpp"
#include "known_frame.hpp"
#include "support/files.hpp"
#include "temporary_directory.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;
using test::io_error;
using test::known_frame;
using test::TemporaryDirectory;

constexpr std::size_t megabyte = 1 << 20;
constexpr std::size_t n = 50;
constexpr std::size_t n_soil = 30;

void expect_equal(const Frame& found, const Frame& wanted) {
  EXPECT_EQ(found.time, wanted.time);
  EXPECT_EQ(found.step, wanted.step);
  EXPECT_EQ(found.n_soil, wanted.n_soil);
  EXPECT_EQ(found.position, wanted.position);
  EXPECT_EQ(found.displacement, wanted.displacement);
  EXPECT_EQ(found.velocity, wanted.velocity);
  EXPECT_EQ(found.density, wanted.density);
  EXPECT_EQ(found.pressure, wanted.pressure);
  EXPECT_EQ(found.cohesion, wanted.cohesion);
  EXPECT_EQ(found.shear_rate, wanted.shear_rate);
  EXPECT_EQ(found.stress, wanted.stress);
  ASSERT_EQ(found.tan_phi.size(), wanted.tan_phi.size());
  for (std::size_t i = 0; i < wanted.tan_phi.size(); ++i)
    // Stored as an angle in single precision.
    EXPECT_NEAR(found.tan_phi[i], wanted.tan_phi[i], 2 * wanted.tan_phi[i] * std::numeric_limits<float>::epsilon())
        << i;
}

/// Every array of a file by its path, as numbers.
void collect(hid_t group, const std::string& path, std::map<std::string, std::vector<double>>& all) {
  for (const std::string& name : hdf5::names(group)) {
    const hdf5::Id object(H5Oopen(group, name.c_str(), H5P_DEFAULT), name);
    if (H5Iget_type(object) == H5I_GROUP)
      collect(object, path + "/" + name, all);
    else
      all[path + "/" + name] = hdf5::read_array<double>(group, name);
  }
}

std::map<std::string, std::vector<double>> contents(const fs::path& path) {
  const hdf5::Id file = hdf5::open_file(path, hdf5::Access::read);
  std::map<std::string, std::vector<double>> all;
  collect(file, "", all);
  all["NSteps"] = {
      static_cast<double>(hdf5::read_attribute<std::int64_t>(hdf5::open_group(file, "VTKHDF/Steps"), "NSteps"))};
  return all;
}

/// Steps first .. last - 1.
void append(SnapshotWriter& writer, std::size_t first, std::size_t last) {
  for (std::size_t k = first; k < last; ++k) writer.append(known_frame(n, n_soil, k));
}

void write_uninterrupted(const fs::path& path, std::size_t steps) {
  SnapshotWriter writer(path, known_frame(n, n_soil, 0));
  append(writer, 1, steps);
  writer.close();
}

Frame read_after_writing(const std::filesystem::path& path, const Frame& frame) {
  SnapshotWriter(path, frame).close();
  return read_frame(path, 0);
}

TEST(Snapshots, ComeBack) {
  const TemporaryDirectory dir;
  write_uninterrupted(dir / "s.vtkhdf", 5);
  EXPECT_EQ(snapshot_times(dir / "s.vtkhdf"), (std::vector<double>{0.0, 0.1, 0.2, 0.3, 0.4}));
  for (const std::size_t k : {3, 0, 4}) expect_equal(read_frame(dir / "s.vtkhdf", k), known_frame(n, n_soil, k));
  EXPECT_NE(io_error([&] { read_frame(dir / "s.vtkhdf", 5); }).find("has 5 steps"), std::string::npos);
  EXPECT_EQ(test::names_in(dir.path()), (std::vector<std::string>{"s.vtkhdf", "s.xdmf"}));
}

// Properties that vary within a material are there where a frame has them, in file and sidecar, also after a
// resumption; a file of frames without them does not name them.
TEST(Snapshots, OfVaryingProperties) {
  const TemporaryDirectory dir;
  const auto frame = [](std::size_t k) {
    Frame f = known_frame(n, n_soil, k);
    for (std::size_t i = 0; i < n; ++i) f.cohesion.push_back(i < n_soil ? 1000.0 + static_cast<double>(i) : 0.0);
    for (std::size_t i = 0; i < n; ++i) f.viscosity.push_back(i < n_soil ? 500.0 - static_cast<double>(i) : 0.0);
    return f;
  };
  SnapshotWriter writer(dir / "s.vtkhdf", frame(0));
  writer.append(frame(1));
  writer.append(frame(2));
  writer.close();
  SnapshotWriter again = SnapshotWriter::resume(dir / "s.vtkhdf", 0.15);
  again.append(frame(2));
  again.close();
  for (const std::size_t k : {0, 2}) {
    const Frame found = read_frame(dir / "s.vtkhdf", k);
    expect_equal(found, frame(k));
    EXPECT_EQ(found.cohesion, frame(k).cohesion);
    EXPECT_EQ(found.viscosity, frame(k).viscosity);
  }
  EXPECT_NE(read_file(dir / "s.xdmf", megabyte).find("cohesion_Pa"), std::string::npos);
  write_uninterrupted(dir / "plain.vtkhdf", 2);
  EXPECT_TRUE(read_frame(dir / "plain.vtkhdf", 1).cohesion.empty());
  EXPECT_EQ(read_file(dir / "plain.xdmf", megabyte).find("cohesion_Pa"), std::string::npos);
  Frame short_one = frame(0);
  short_one.cohesion.pop_back();
  EXPECT_THROW(SnapshotWriter(dir / "bad.vtkhdf", short_one), std::invalid_argument);
}

// Every array says its unit and the file which run it is of, also after a resumption.
TEST(Snapshots, SayUnitsAndRun) {
  const TemporaryDirectory dir;
  Provenance of{.version = "1.2.3", .seed = 9007199254740991, .realization = 7, .case_hash = "0123456789abcdef"};
  of.case_title = "Böschung über der Straße";
  SnapshotWriter(dir / "s.vtkhdf", known_frame(n, n_soil, 0), of).close();
  SnapshotWriter::resume(dir / "s.vtkhdf", 0.0).close();
  const hdf5::Id file = hdf5::open_file(dir / "s.vtkhdf", hdf5::Access::read);
  const hdf5::Id group = hdf5::open_group(file, "talus");
  EXPECT_EQ(hdf5::read_text_attribute(group, "title"), of.case_title);
  EXPECT_EQ(hdf5::read_text_attribute(group, "version"), of.version);
  EXPECT_EQ(hdf5::read_text_attribute(group, "case_hash"), of.case_hash);
  EXPECT_EQ(hdf5::read_attribute<std::uint64_t>(group, "seed"), of.seed);
  EXPECT_EQ(hdf5::read_attribute<std::int64_t>(group, "realization"), 7);
  EXPECT_FALSE(hdf5::has_attribute(group, "perturbation"));
  std::map<std::string, std::string> units;
  for (const std::string& name : hdf5::names(hdf5::open_group(file, "VTKHDF/PointData")))
    units[name] = hdf5::read_text_attribute(hdf5::open_array(file, "VTKHDF/PointData/" + name), "units");
  EXPECT_EQ(units["velocity"], "m/s");
  EXPECT_EQ(units["density"], "kg/m3");
  EXPECT_EQ(units["friction_angle_deg"], "deg");
  EXPECT_EQ(units["stress"], "Pa");
  EXPECT_EQ(units["id"], "1");
  EXPECT_EQ(hdf5::read_text_attribute(hdf5::open_array(file, "VTKHDF/Points"), "units"), "m");
  EXPECT_EQ(hdf5::read_text_attribute(hdf5::open_array(file, "VTKHDF/Steps/Values"), "units"), "s");
  of.realization.reset();
  of.perturbation = 1e-6;
  SnapshotWriter(dir / "median.vtkhdf", known_frame(n, n_soil, 0), of).close();
  const hdf5::Id median = hdf5::open_file(dir / "median.vtkhdf", hdf5::Access::read);
  EXPECT_FALSE(hdf5::has_attribute(hdf5::open_group(median, "talus"), "realization"));
  EXPECT_EQ(hdf5::read_attribute<double>(hdf5::open_group(median, "talus"), "perturbation"), 1e-6);
}

TEST(Snapshots, OfACaseFarFromZeroKeepItsOrigin) {
  const TemporaryDirectory dir;
  Frame far = known_frame(4, 2, 0);
  EXPECT_EQ(read_after_writing(dir / "near.vtkhdf", far).origin, Vec2{});
  far.origin = {2'683'000, -1'247'000};
  const Frame found = read_after_writing(dir / "far.vtkhdf", far);
  EXPECT_EQ(found.origin, far.origin);
  expect_equal(found, far);
  for (Vec2& x : far.position) x = {x.x + 1e-6, x.y - 1e-6};
  const Frame close = read_after_writing(dir / "far.vtkhdf", far);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(norm(close.position[i] - far.position[i]), 0.0, 1e-9) << i;
}

TEST(Snapshots, OfMoreParticlesThanAChunkHolds) {
  const TemporaryDirectory dir;
  constexpr std::size_t many = 70'000;
  SnapshotWriter writer(dir / "s.vtkhdf", known_frame(many, 69'000, 0));
  writer.append(known_frame(many, 69'000, 1));
  writer.append(known_frame(many, 69'000, 2));
  writer.close();
  const Frame found = read_frame(dir / "s.vtkhdf", 2);
  const Frame wanted = known_frame(many, 69'000, 2);
  EXPECT_EQ(found.n_soil, 69'000u);
  EXPECT_EQ(found.displacement[many - 1].x, static_cast<float>(wanted.displacement[many - 1].x));
  EXPECT_EQ(found.stress[65'536][3], static_cast<float>(wanted.stress[65'536][3]));
}

TEST(Snapshots, CanBeReadWhileTheFileGrows) {
  const TemporaryDirectory dir;
  SnapshotWriter writer(dir / "s.vtkhdf", known_frame(n, n_soil, 0));
  EXPECT_EQ(snapshot_times(dir / "s.vtkhdf").size(), 1u);
  append(writer, 1, 3);
  EXPECT_EQ(snapshot_times(dir / "s.vtkhdf").size(), 3u);
  expect_equal(read_frame(dir / "s.vtkhdf", 2), known_frame(n, n_soil, 2));
}

TEST(Snapshots, TakeNoMoreSpaceThanTheyNeed) {
  const TemporaryDirectory dir;
  SnapshotWriter writer(dir / "s.vtkhdf", known_frame(n, n_soil, 0));
  append(writer, 1, 3);
  const auto open_size = fs::file_size(dir / "s.vtkhdf");
  writer.close();
  EXPECT_EQ(fs::file_size(dir / "s.vtkhdf"), open_size) << "the reserve should be gone after each step";
}

TEST(Snapshots, OfTheSameTimeAreWrittenOnce) {
  const TemporaryDirectory dir;
  SnapshotWriter writer(dir / "s.vtkhdf", known_frame(n, n_soil, 1));
  writer.append(known_frame(n, n_soil, 1));
  EXPECT_EQ(snapshot_times(dir / "s.vtkhdf").size(), 1u);
  EXPECT_THROW(writer.append(known_frame(n, n_soil, 0)), std::invalid_argument);
}

TEST(Snapshots, RefuseOtherParticlesAndUnevenFrames) {
  const TemporaryDirectory dir;
  EXPECT_THROW(SnapshotWriter(dir / "s.vtkhdf", Frame{}), std::invalid_argument);
  SnapshotWriter writer(dir / "s.vtkhdf", known_frame(n, n_soil, 0));
  EXPECT_THROW(writer.append(known_frame(n + 1, n_soil, 1)), std::invalid_argument);
  Frame uneven = known_frame(n, n_soil, 1);
  uneven.stress.pop_back();
  EXPECT_THROW(writer.append(uneven), std::invalid_argument);
}

TEST(Snapshots, OfAResumedRunAreThoseOfAnUninterruptedOne) {
  const TemporaryDirectory dir;
  constexpr std::size_t steps = 70;
  write_uninterrupted(dir / "whole.vtkhdf", steps);
  {
    SnapshotWriter writer(dir / "s.vtkhdf", known_frame(n, n_soil, 0));
    append(writer, 1, 67);
  }
  {
    SnapshotWriter writer = SnapshotWriter::resume(dir / "s.vtkhdf", 2.05);  // between two snapshots
    append(writer, 21, 30);
  }
  SnapshotWriter writer = SnapshotWriter::resume(dir / "s.vtkhdf", known_frame(n, n_soil, 25).time);  // at one
  append(writer, 26, steps);
  writer.close();
  EXPECT_EQ(contents(dir / "s.vtkhdf"), contents(dir / "whole.vtkhdf"));
  std::string sidecar = read_file(dir / "s.xdmf", megabyte);
  for (std::size_t at; (at = sidecar.find("s.vtkhdf:")) != std::string::npos;) sidecar.replace(at, 9, "whole.vtkhdf@");
  for (std::size_t at; (at = sidecar.find('@')) != std::string::npos;) sidecar[at] = ':';
  EXPECT_EQ(sidecar, read_file(dir / "whole.xdmf", megabyte));
}

TEST(Snapshots, CanBeResumedBeforeTheFirst) {
  const TemporaryDirectory dir;
  { SnapshotWriter writer(dir / "s.vtkhdf", known_frame(n, n_soil, 3)); }
  SnapshotWriter writer = SnapshotWriter::resume(dir / "s.vtkhdf", 0.0);
  EXPECT_TRUE(snapshot_times(dir / "s.vtkhdf").empty());
  append(writer, 1, 3);
  expect_equal(read_frame(dir / "s.vtkhdf", 1), known_frame(n, n_soil, 2));
}

TEST(Snapshots, OfAnInterruptedAppendAreDroppedOnResume) {
  const TemporaryDirectory dir;
  write_uninterrupted(dir / "whole.vtkhdf", 4);
  write_uninterrupted(dir / "s.vtkhdf", 3);
  {
    // A process killed in the middle of its third append: arrays are longer than NSteps says.
    const hdf5::Id file = hdf5::open_file(dir / "s.vtkhdf", hdf5::Access::read_write);
    hdf5::append_rows<float>(file, "VTKHDF/Points", std::vector<float>(3 * n, 9.0f));
    hdf5::append_rows<double>(file, "VTKHDF/Steps/Values", {{9.0}});
  }
  EXPECT_EQ(snapshot_times(dir / "s.vtkhdf").size(), 3u);
  SnapshotWriter writer = SnapshotWriter::resume(dir / "s.vtkhdf", 10.0);
  append(writer, 3, 4);
  writer.close();
  EXPECT_EQ(contents(dir / "s.vtkhdf"), contents(dir / "whole.vtkhdf"));
}

TEST(Snapshots, AreWholeAfterAKill) {
  const TemporaryDirectory dir;
  for (int i = 1; i <= 8; ++i) {
    fs::remove(dir / "s.vtkhdf");
    test::run_and_kill(std::chrono::milliseconds(60 * i), [&] {
      SnapshotWriter writer(dir / "s.vtkhdf", known_frame(n, n_soil, 0));
      append(writer, 1, 1'000'000);
    });
    if (!fs::exists(dir / "s.vtkhdf")) continue;  // killed before the first step
    const std::size_t steps = snapshot_times(dir / "s.vtkhdf").size();
    ASSERT_GE(steps, 1u);
    expect_equal(read_frame(dir / "s.vtkhdf", 0), known_frame(n, n_soil, 0));
    expect_equal(read_frame(dir / "s.vtkhdf", steps - 1), known_frame(n, n_soil, steps - 1));
    SnapshotWriter writer = SnapshotWriter::resume(dir / "s.vtkhdf", 1e9);
    append(writer, steps, steps + 1);
    expect_equal(read_frame(dir / "s.vtkhdf", steps), known_frame(n, n_soil, steps));
  }
}

/// A frame that does not compress.
Frame noise_frame(std::size_t particles, std::size_t k) {
  Frame f = known_frame(particles, particles, k);
  std::mt19937 random(static_cast<unsigned>(k));
  std::uniform_real_distribution<double> uniform(-1e6, 1e6);
  for (std::size_t i = 0; i < particles; ++i) {
    f.position[i] = f.displacement[i] =
        f.velocity[i] = {static_cast<float>(uniform(random)), static_cast<float>(uniform(random))};
    f.density[i] = f.pressure[i] = f.shear_rate[i] = static_cast<float>(uniform(random));
  }
  return f;
}

/// Appends until there is no more room, and expects everything before that to be readable, and no more to be harmed by
/// another try.
void fill_up(const fs::path& path, const std::string& reason) {
  constexpr std::size_t particles = 3000;
  constexpr std::size_t more_than_fit = 1000;
  SnapshotWriter writer(path, noise_frame(particles, 0));
  std::size_t k = 1;
  const std::string message = io_error([&] {
    for (; k < more_than_fit; ++k) writer.append(noise_frame(particles, k));
  });
  EXPECT_NE(message.find(reason), std::string::npos) << message;
  EXPECT_NE(message.find(path.string()), std::string::npos) << message;
  EXPECT_GT(k, 5u);
  EXPECT_FALSE(io_error([&] { writer.append(noise_frame(particles, k)); }).empty());
  ASSERT_EQ(snapshot_times(path).size(), k);
  for (std::size_t j = 0; j < k; ++j) expect_equal(read_frame(path, j), noise_frame(particles, j));
}

TEST(Snapshots, SurviveAFullDisk) {
  const test::SmallDisk disk("4m");
  if (!disk.exists()) GTEST_SKIP() << "no right to make a disk";
  fill_up(disk.path() / "s.vtkhdf", "No space left on device; free some space");
}

TEST(Snapshots, SurviveALimitOfFileSize) {
  const TemporaryDirectory dir;
  const test::FileSizeLimit limit(4 * megabyte);
  fill_up(dir / "s.vtkhdf", "File too large; raise the limit");
}

TEST(Snapshots, OfOtherFilesAreRefused) {
  const TemporaryDirectory dir;
  const auto refused = [&](const fs::path& path) {
    const std::string a = io_error([&] { snapshot_times(path); });
    const std::string b = io_error([&] { SnapshotWriter::resume(path, 1.0); });
    return a.find(path.string()) != std::string::npos && b.find(path.string()) != std::string::npos;
  };
  EXPECT_TRUE(refused(dir / "missing"));
  write_file_atomically(dir / "text", "not HDF5");
  EXPECT_TRUE(refused(dir / "text"));
  write_file_atomically(dir / "hdf5", hdf5::image(hdf5::create_in_memory()));
  EXPECT_TRUE(refused(dir / "hdf5"));
  write_points(dir / "points", std::vector<Vec2>{{1, 2}}, {});
  EXPECT_TRUE(refused(dir / "points"));
  write_uninterrupted(dir / "s.vtkhdf", 4);
  fs::resize_file(dir / "s.vtkhdf", fs::file_size(dir / "s.vtkhdf") - 100);
  EXPECT_TRUE(refused(dir / "s.vtkhdf"));
}

TEST(Points, AreWrittenWithTheirArrays) {
  const TemporaryDirectory dir;
  const std::vector<Vec2> positions = {{0.1, -0.0}, {1.0 / 3.0, 2e-308}};
  const std::vector<double> angle = {25.5, 26.25};
  const std::vector<NamedArray> arrays = {{"friction_angle_deg", angle}};
  write_points(dir / "f.vtkhdf", positions, arrays);
  const hdf5::Id file = hdf5::open_file(dir / "f.vtkhdf", hdf5::Access::read);
  EXPECT_EQ(hdf5::read_array<double>(file, "VTKHDF/Points"),
            (std::vector<double>{0.1, -0.0, 0.0, 1.0 / 3.0, 2e-308, 0.0}));
  EXPECT_EQ(hdf5::read_array<double>(file, "VTKHDF/PointData/friction_angle_deg"), angle);
  write_field_csv(dir / "f.csv", positions, arrays);
  EXPECT_EQ(read_file(dir / "f.csv", 1000),
            "x_m,y_m,friction_angle_deg\n0.1,-0,25.5\n0.3333333333333333,2e-308,26.25\n");
}

TEST(Points, RefuseArraysOfAnotherLength) {
  const TemporaryDirectory dir;
  const std::vector<Vec2> positions(2);
  const std::vector<double> one(1);
  EXPECT_THROW(write_points(dir / "f", positions, std::vector<NamedArray>{{"a", one}}), std::invalid_argument);
  EXPECT_THROW(write_field_csv(dir / "f", positions, std::vector<NamedArray>{{"a", one}}), std::invalid_argument);
}

}  // namespace
}  // namespace talus
