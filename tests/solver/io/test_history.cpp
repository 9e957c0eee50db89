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

const std::string header = "time_s,step,front_m,centre_of_mass_x_m,kinetic_energy_J_per_m,max_speed_m_s\n";

TEST(History, ComesBackBitForBit) {
  using Limits = std::numeric_limits<double>;
  const TemporaryDirectory dir;
  const std::vector<HistoryRow> rows = {{.time = 0.0,
                                         .step = 0,
                                         .front = 1.0 / 3.0,
                                         .centre_of_mass_x = -0.0,
                                         .kinetic_energy = Limits::denorm_min(),
                                         .max_speed = Limits::max()},
                                        {.time = 0.1,
                                         .step = std::numeric_limits<std::int64_t>::max(),
                                         .front = -1e-300,
                                         .centre_of_mass_x = 2.0,
                                         .kinetic_energy = Limits::infinity(),
                                         .max_speed = 4.0}};
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
    EXPECT_EQ(found[i].max_speed, rows[i].max_speed);
  }
}

TEST(History, HasAColumnForEachUnit) {
  const TemporaryDirectory dir;
  write_history(
      dir / "h.csv",
      std::vector<HistoryRow>{
          {.time = 0.5, .step = 2, .front = 3.25, .centre_of_mass_x = 4, .kinetic_energy = 5, .max_speed = 6}});
  EXPECT_EQ(read_file(dir / "h.csv", 1000), header + "0.5,2,3.25,4,5,6\n");
  write_history(dir / "h.csv", {});
  EXPECT_TRUE(read_history(dir / "h.csv").empty());
}

TEST(History, RefusesOtherFilesByLine) {
  const TemporaryDirectory dir;
  const auto message_for = [&](const std::string& text) {
    write_file_atomically(dir / "h.csv", text);
    return io_error([&] { read_history(dir / "h.csv"); });
  };
  EXPECT_NE(message_for("").find("h.csv:1: the header is missing"), std::string::npos);
  EXPECT_NE(message_for("a,b\n").find("h.csv:1: is not the header"), std::string::npos);
  EXPECT_NE(message_for(header + "1,2,3,4,5,6\n1,2,3,4,5\n").find("h.csv:3: is not six numbers"), std::string::npos);
  EXPECT_NE(message_for(header + "1,2,3,4,5,6,7\n").find("h.csv:2:"), std::string::npos);
  EXPECT_NE(message_for(header + "1,2.5,3,4,5,6\n").find("h.csv:2:"), std::string::npos);
  EXPECT_NE(message_for(header + "1,2,3,4,5,six\n").find("h.csv:2:"), std::string::npos);
  EXPECT_NE(message_for(header + "1,2,3,4,5,6").find("h.csv:2: the line does not end"), std::string::npos);
}

}  // namespace
}  // namespace talus
