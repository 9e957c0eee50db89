#include <bit>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <stdexcept>

#include "io/checkpoint.hpp"
#include "io/hdf5.hpp"
#include "io_faults.hpp"
#include "support/digest.hpp"
#include "support/files.hpp"
#include "temporary_directory.hpp"

namespace talus {
namespace {

using test::io_error;
using test::TemporaryDirectory;

constexpr std::size_t megabyte = 1 << 20;
const CheckpointHeader header = {.talus_version = "1.2.3",
                                 .case_hash = "0123456789abcdef",
                                 .seed = 18446744073709551615u,
                                 .realization = 7,
                                 .perturbation = 1e-6};

CheckpointState sample_state() {
  using Limits = std::numeric_limits<double>;
  return {.reals = {{"velocity_x",
                     {0.0, -0.0, 1.0 / 3.0, Limits::denorm_min(), -Limits::min(), Limits::max(), Limits::infinity(),
                      std::bit_cast<double>(0x7ff8dead0000beefu)}},
                    {"empty", {}}},
          .integers = {{"step",
                        {std::numeric_limits<std::int64_t>::min(), -1, 0, std::numeric_limits<std::int64_t>::max()}},
                       {"none", {}}},
          .wall_clock = 12.625};
}

/// The bits of an array, so that -0 is not 0 and NaN is itself.
std::vector<std::uint64_t> bits(const std::vector<double>& values) {
  std::vector<std::uint64_t> all;
  for (const double v : values) all.push_back(std::bit_cast<std::uint64_t>(v));
  return all;
}

void expect_equal(const CheckpointState& a, const CheckpointState& b) {
  EXPECT_EQ(a.integers, b.integers);
  EXPECT_EQ(a.wall_clock, b.wall_clock);
  ASSERT_EQ(a.reals.size(), b.reals.size());
  for (const auto& [name, values] : a.reals) {
    ASSERT_TRUE(b.reals.contains(name)) << name;
    EXPECT_EQ(bits(values), bits(b.reals.at(name))) << name;
  }
}

TEST(Checksum, IsFnv1a) {
  // Test vectors of http://www.isthe.com/chongo/tech/comp/fnv/
  EXPECT_EQ(fnv1a64(""), 0xcbf29ce484222325u);
  EXPECT_EQ(fnv1a64("a"), 0xaf63dc4c8601ec8cu);
  EXPECT_EQ(fnv1a64("foobar"), 0x85944171f73967e8u);
}

TEST(Checkpoint, ComesBackBitForBit) {
  const TemporaryDirectory dir;
  write_checkpoint(dir / "c", sample_state(), header);
  expect_equal(read_checkpoint(dir / "c", header), sample_state());
  write_checkpoint(dir / "c", CheckpointState{}, header);
  expect_equal(read_checkpoint(dir / "c", header), CheckpointState{});
}

TEST(Checkpoint, OfTheSameStateIsTheSameFile) {
  const TemporaryDirectory dir;
  write_checkpoint(dir / "a", sample_state(), header);
  write_checkpoint(dir / "b", sample_state(), header);
  EXPECT_EQ(read_file(dir / "a", megabyte), read_file(dir / "b", megabyte));
}

TEST(Checkpoint, IsAnHdf5File) {
  const TemporaryDirectory dir;
  write_checkpoint(dir / "c", sample_state(), header);
  const hdf5::Id file = hdf5::open_file(dir / "c", hdf5::Access::read);
  EXPECT_EQ(hdf5::read_array<std::int64_t>(file, "integers/step"), sample_state().integers.at("step"));
}

TEST(Checkpoint, OfAnotherRunIsRefused) {
  const TemporaryDirectory dir;
  write_checkpoint(dir / "c", sample_state(), header);
  const auto message_for = [&](auto change) {
    CheckpointHeader other = header;
    change(other);
    return io_error([&] { read_checkpoint(dir / "c", other); });
  };
  EXPECT_NE(message_for([](auto& h) { h.talus_version = "2"; }).find("version 1.2.3, wanted 2"), std::string::npos);
  EXPECT_NE(message_for([](auto& h) { h.case_hash = ""; }).find("case 0123456789abcdef, wanted "), std::string::npos);
  EXPECT_NE(message_for([](auto& h) { h.seed = 1; }).find("seed 18446744073709551615, wanted 1"), std::string::npos);
  EXPECT_NE(message_for([](auto& h) { h.realization = 8; }).find("realization 7, wanted 8"), std::string::npos);
  EXPECT_NE(message_for([](auto& h) { h.realization.reset(); }).find("realization 7, wanted none"), std::string::npos);
  EXPECT_NE(message_for([](auto& h) { h.perturbation = 2e-6; }).find("perturbation 1e-06, wanted 2e-06"),
            std::string::npos);
  EXPECT_NE(message_for([](auto& h) { h.perturbation.reset(); }).find((dir / "c").string()), std::string::npos);
}

TEST(Checkpoint, WithoutRealizationIsNotThatOfRealizationZero) {
  const TemporaryDirectory dir;
  const CheckpointHeader deterministic = {
      .talus_version = "1", .case_hash = "", .seed = 0, .realization = {}, .perturbation = {}};
  write_checkpoint(dir / "c", sample_state(), deterministic);
  EXPECT_NO_THROW(read_checkpoint(dir / "c", deterministic));
  CheckpointHeader zero = deterministic;
  zero.realization = 0;
  EXPECT_NE(io_error([&] { read_checkpoint(dir / "c", zero); }).find("realization none, wanted 0"), std::string::npos);
}

TEST(Checkpoint, IsRefusedWithAnyByteChanged) {
  const TemporaryDirectory dir;
  write_checkpoint(dir / "c", sample_state(), header);
  const std::string good = read_file(dir / "c", megabyte);
  for (std::size_t i = 0; i < good.size(); i += 31) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 0x10);
    write_file_atomically(dir / "bad", bad);
    const std::string message = io_error([&] { read_checkpoint(dir / "bad", header); });
    EXPECT_NE(message.find((dir / "bad").string()), std::string::npos) << i << ": " << message;
  }
}

TEST(Checkpoint, IsRefusedAtAnyOtherLength) {
  const TemporaryDirectory dir;
  write_checkpoint(dir / "c", sample_state(), header);
  const std::string good = read_file(dir / "c", megabyte);
  for (std::size_t length = 0; length < good.size(); length += 97) {
    write_file_atomically(dir / "bad", good.substr(0, length));
    EXPECT_FALSE(io_error([&] { read_checkpoint(dir / "bad", header); }).empty()) << length;
  }
  write_file_atomically(dir / "bad", good + "x");
  EXPECT_NE(io_error([&] { read_checkpoint(dir / "bad", header); }).find("truncated or damaged"), std::string::npos);
}

TEST(Checkpoint, ThatIsNoneIsRefused) {
  const TemporaryDirectory dir;
  EXPECT_NE(io_error([&] { read_checkpoint(dir / "missing", header); }).find("No such file"), std::string::npos);
  write_file_atomically(dir / "c", "a letter to a friend");
  EXPECT_NE(io_error([&] { read_checkpoint(dir / "c", header); }).find("is not a checkpoint"), std::string::npos);
}

TEST(Checkpoint, OfALaterFormatIsRefused) {
  const TemporaryDirectory dir;
  const hdf5::Id file = hdf5::create_in_memory();
  hdf5::write_attribute<std::int64_t>(file, "format", 9);
  const std::string body = hdf5::image(file);
  char preamble[512] = {};
  std::snprintf(preamble, sizeof preamble, "talus checkpoint\nbytes %zu\nfnv1a64 %016llx\n", body.size(),
                static_cast<unsigned long long>(fnv1a64(body)));
  write_file_atomically(dir / "c", std::string(preamble, sizeof preamble) + body);
  EXPECT_NE(io_error([&] { read_checkpoint(dir / "c", header); }).find("format 9"), std::string::npos);
}

TEST(Checkpoint, LeavesTheOldOneWhenTheNewOneDoesNotFit) {
  const TemporaryDirectory dir;
  write_checkpoint(dir / "c", sample_state(), header);
  {
    const test::FileSizeLimit limit(megabyte);
    CheckpointState large;
    large.reals["x"].resize(megabyte / sizeof(double));
    EXPECT_NE(io_error([&] { write_checkpoint(dir / "c", large, header); }).find("File too large"), std::string::npos);
  }
  expect_equal(read_checkpoint(dir / "c", header), sample_state());
  EXPECT_EQ(test::names_in(dir.path()), std::vector<std::string>{"c"});
}

TEST(Checkpoint, RefusesNamesThatHdf5CannotStore) {
  const TemporaryDirectory dir;
  for (const char* name : {"", ".", "a/b"}) {
    CheckpointState state;
    state.integers[name] = {1};
    EXPECT_THROW(write_checkpoint(dir / "c", state, header), std::invalid_argument) << name;
  }
}

}  // namespace
}  // namespace talus
