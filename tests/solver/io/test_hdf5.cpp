#include <cstdint>

#include "io/hdf5.hpp"
#include "io_faults.hpp"
#include "support/files.hpp"
#include "temporary_directory.hpp"

namespace talus {
namespace {

using test::io_error;
using test::TemporaryDirectory;
using Doubles = std::vector<double>;

TEST(Hdf5, ErrorsBecomeIoErrorWithHdf5sReasonAndNothingIsPrinted) {
  const TemporaryDirectory dir;
  write_file_atomically(dir / "text", "not HDF5");
  testing::internal::CaptureStderr();
  const std::string missing = io_error([&] { hdf5::open_file(dir / "missing", hdf5::Access::read); });
  const std::string foreign = io_error([&] { hdf5::open_file(dir / "text", hdf5::Access::read_write); });
  const hdf5::Id file = hdf5::create_in_memory();
  const hdf5::Id group = hdf5::create_group(file, "g");
  const std::string no_array = io_error([&] { hdf5::read_array<double>(group, "a"); });
  const std::string no_group = io_error([&] { hdf5::open_group(group, "b"); });
  const std::string no_attribute = io_error([&] { hdf5::read_attribute<double>(group, "c"); });
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_NE(missing.find((dir / "missing").string()), std::string::npos) << missing;
  EXPECT_NE(missing.find("No such file"), std::string::npos) << missing;
  EXPECT_NE(foreign.find("file signature not found"), std::string::npos) << foreign;
  EXPECT_NE(no_array.find("/g/a in memory"), std::string::npos) << no_array;
  EXPECT_NE(no_group.find("/g/b in memory"), std::string::npos) << no_group;
  EXPECT_NE(no_attribute.find("/g/c in memory"), std::string::npos) << no_attribute;
}

TEST(Hdf5, FilesInMemoryAreApart) {
  const hdf5::Id a = hdf5::create_in_memory();
  const hdf5::Id b = hdf5::create_in_memory();
  hdf5::write_attribute<std::int64_t>(a, "n", 1);
  hdf5::write_attribute<std::int64_t>(b, "n", 2);
  const hdf5::Id a_again = hdf5::open_image(hdf5::image(a), "same");
  const hdf5::Id b_again = hdf5::open_image(hdf5::image(b), "same");
  EXPECT_EQ(hdf5::read_attribute<std::int64_t>(a_again, "n"), 1);
  EXPECT_EQ(hdf5::read_attribute<std::int64_t>(b_again, "n"), 2);
}

TEST(Hdf5, RowsGrowAndShrink) {
  const hdf5::Id file = hdf5::create_in_memory();
  hdf5::create_rows(file, "pairs", hdf5::type<double>(), 2, 3, hdf5::Filter::compressed);
  hdf5::append_rows<double>(file, "pairs", Doubles{1, 2, 3, 4, 5, 6, 7, 8});
  hdf5::append_rows<double>(file, "pairs", Doubles{9, 10});
  hdf5::append_rows<double>(file, "pairs", Doubles{});
  EXPECT_EQ(hdf5::read_rows<double>(file, "pairs", 3, 2), (Doubles{7, 8, 9, 10}));
  EXPECT_EQ(hdf5::read_rows<double>(file, "pairs", 5, 0), Doubles{});
  hdf5::truncate_rows(file, "pairs", 2);
  hdf5::append_rows<double>(file, "pairs", Doubles{11, 12});
  EXPECT_EQ(hdf5::read_array<double>(file, "pairs"), (Doubles{1, 2, 3, 4, 11, 12}));
  EXPECT_NE(io_error([&] { hdf5::read_rows<double>(file, "pairs", 2, 2); }).find("has 3 rows, 4 are needed"),
            std::string::npos);
  EXPECT_NE(io_error([&] { hdf5::truncate_rows(file, "pairs", 4); }).find("only 3 rows"), std::string::npos);
}

TEST(Hdf5, FixedArraysMayBeEmptyOrTables) {
  const hdf5::Id file = hdf5::create_in_memory();
  hdf5::write_array<float>(file, "empty", {}, hdf5::Filter::compressed);
  EXPECT_TRUE(hdf5::read_array<float>(file, "empty").empty());
  const std::vector<std::int32_t> table = {1, 2, 3, 4, 5, 6};
  hdf5::write_array<std::int32_t>(file, "table", table, hdf5::Filter::compressed, 3);
  EXPECT_EQ(hdf5::read_rows<std::int32_t>(file, "table", 1, 1), (std::vector<std::int32_t>{4, 5, 6}));
  EXPECT_EQ(hdf5::names(file), (std::vector<std::string>{"empty", "table"}));
}

TEST(Hdf5, AttributesAreReplaced) {
  const hdf5::Id file = hdf5::create_in_memory();
  hdf5::write_attribute<std::int64_t>(file, "n", 1);
  hdf5::write_attribute<std::int64_t>(file, "n", -2);
  EXPECT_EQ(hdf5::read_attribute<std::int64_t>(file, "n"), -2);
  hdf5::write_text_attribute(file, "empty", "");
  hdf5::write_text_attribute(file, "text", "UnstructuredGrid");
  EXPECT_EQ(hdf5::read_text_attribute(file, "empty"), "");
  EXPECT_EQ(hdf5::read_text_attribute(file, "text"), "UnstructuredGrid");
  hdf5::write_attribute_list<double>(file, "two", Doubles{1, 2});
  EXPECT_NE(io_error([&] { hdf5::read_attribute<double>(file, "two"); }).find("not a single value"), std::string::npos);
  EXPECT_NE(io_error([&] { hdf5::read_text_attribute(file, "n"); }).find("not a text"), std::string::npos);
}

TEST(Hdf5, AnArrayThatClaimsTooMuchIsNotBelieved) {
  const hdf5::Id file = hdf5::create_in_memory();
  const hsize_t dims[] = {hsize_t{1} << 40};
  const hsize_t chunk[] = {1024};
  const hdf5::Id space(H5Screate_simple(1, dims, nullptr), "space");
  const hdf5::Id list(H5Pcreate(H5P_DATASET_CREATE), "list");
  H5Pset_chunk(list, 1, chunk);
  { const hdf5::Id huge(H5Dcreate2(file, "huge", H5T_IEEE_F64LE, space, H5P_DEFAULT, list, H5P_DEFAULT), "array"); }
  EXPECT_NE(io_error([&] { hdf5::read_array<double>(file, "huge"); }).find("implausible"), std::string::npos);
}

}  // namespace
}  // namespace talus
