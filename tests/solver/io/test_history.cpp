#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "io/history.hpp"
#include "io_faults.hpp"
#include "support/files.hpp"
#include "temporary_directory.hpp"

namespace talus {
namespace {

using test::io_error;
using test::TemporaryDirectory;

const std::string header =
    "time_s,step,front_m,centre_of_mass_x_m,kinetic_energy_J_per_m,max_speed_m_s,"
    "kinetic_J_m,potential_J_m,compression_J_m,distortion_J_m,friction_J_m,viscosity_J_m,artificial_viscosity_J_m,"
    "density_diffusion_J_m,boundaries_J_m,contact_J_m,departed_J_m,stored_at_start_J_m,created_J_m\n";

/// 13 columns of zeros that follow the first six.
const std::string no_energy = ",0,0,0,0,0,0,0,0,0,0,0,0,0";

/// Another value for every term, powers of two: sums are exact.
EnergyBudget some_energy() {
  EnergyBudget e;
  double value = 1.0;
  for (const EnergyTerm& term : energy_terms) e.*term.value = (value *= 2.0);
  return e;
}

TEST(History, ComesBackBitForBit) {
  using Limits = std::numeric_limits<double>;
  const TemporaryDirectory dir;
  const std::vector<HistoryRow> rows = {{.time = 0.0,
                                         .step = 0,
                                         .front = 1.0 / 3.0,
                                         .centre_of_mass_x = -0.0,
                                         .kinetic_energy = Limits::denorm_min(),
                                         .max_speed = Limits::max(),
                                         .energy = some_energy()},
                                        {.time = 0.1,
                                         .step = std::numeric_limits<std::int64_t>::max(),
                                         .front = -1e-300,
                                         .centre_of_mass_x = 2.0,
                                         .kinetic_energy = Limits::infinity(),
                                         .max_speed = 4.0,
                                         .energy = {.kinetic = Limits::infinity(), .contact = Limits::denorm_min()}}};
  write_history(dir / "h.csv", rows);
  const auto found = read_history(dir / "h.csv");
  ASSERT_EQ(found.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(found[i].time, rows[i].time);
    EXPECT_EQ(found[i].step, rows[i].step);
    EXPECT_EQ(found[i].front, rows[i].front);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(found[i].centre_of_mass_x),
              std::bit_cast<std::uint64_t>(rows[i].centre_of_mass_x));
    EXPECT_EQ(found[i].kinetic_energy, rows[i].kinetic_energy);
    EXPECT_EQ(found[i].energy, rows[i].energy);
    EXPECT_EQ(found[i].max_speed, rows[i].max_speed);
  }
}

TEST(History, HasAColumnForEachUnit) {
  const TemporaryDirectory dir;
  write_history(dir / "h.csv", std::vector<HistoryRow>{{.time = 0.5,
                                                        .step = 2,
                                                        .front = 3.25,
                                                        .centre_of_mass_x = 4,
                                                        .kinetic_energy = 5,
                                                        .max_speed = 6,
                                                        .energy = some_energy()}});
  constexpr double created = 2 + 4 + 8 + 16 + 32 + 64 + 128 + 256 + 512 + 1024 + 2048 - 4096;
  static_assert(created == -2);
  EXPECT_EQ(read_file(dir / "h.csv", 1000), header + "0.5,2,3.25,4,5,6,2,4,8,16,32,64,128,256,512,1024,2048,4096,-2\n");
  write_history(dir / "h.csv", {});
  EXPECT_TRUE(read_history(dir / "h.csv").empty());
}

TEST(History, OfAnEarlierVersionHasNoEnergy) {
  const TemporaryDirectory dir;
  const std::string earlier = header.substr(0, header.find(",kinetic_J_m")) + "\n";
  write_file_atomically(dir / "h.csv", earlier + "0.5,2,3.25,4,5,6\n");
  const auto rows = read_history(dir / "h.csv");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].max_speed, 6);
  EXPECT_EQ(rows[0].energy, EnergyBudget());
  write_file_atomically(dir / "h.csv", earlier + "0.5,2,3.25,4,5,6,7\n");
  EXPECT_NE(io_error([&] { read_history(dir / "h.csv"); }).find("is not 6 numbers"), std::string::npos);
}

TEST(History, RefusesOtherFilesByLine) {
  const TemporaryDirectory dir;
  const auto message_for = [&](const std::string& text) {
    write_file_atomically(dir / "h.csv", text);
    return io_error([&] { read_history(dir / "h.csv"); });
  };
  EXPECT_NE(message_for("").find("h.csv:1: the header is missing"), std::string::npos);
  EXPECT_NE(message_for("a,b\n").find("h.csv:1: is not the header"), std::string::npos);
  EXPECT_NE(message_for(header + "1,2,3,4,5,6" + no_energy + "\n1,2,3,4,5\n").find("h.csv:3: is not 19 numbers"),
            std::string::npos);
  EXPECT_NE(message_for(header + "1,2,3,4,5,6,7" + no_energy + "\n").find("h.csv:2:"), std::string::npos);
  EXPECT_NE(message_for(header + "1,2.5,3,4,5,6" + no_energy + "\n").find("h.csv:2:"), std::string::npos);
  EXPECT_NE(message_for(header + "1,2,3,4,5,six" + no_energy + "\n").find("h.csv:2:"), std::string::npos);
  EXPECT_NE(message_for(header + "1,2,3,4,5,6" + no_energy).find("h.csv:2: the line does not end"), std::string::npos);
}

}  // namespace
}  // namespace talus
