#include <sys/stat.h>

#include <cstdlib>

#include "io_faults.hpp"
#include "support/files.hpp"
#include "support/output_directory.hpp"
#include "temporary_directory.hpp"

namespace talus {
namespace {

using test::io_error;
using test::TemporaryDirectory;
using testing::Test;

using Names = std::vector<std::string>;
constexpr std::size_t megabyte = 1 << 20;

TEST(WriteFileAtomically, WritesAndReplaces) {
  const TemporaryDirectory dir;
  const auto file = dir / "a.txt";
  write_file_atomically(file, "first");
  EXPECT_EQ(read_file(file, 100), "first");
  const std::string binary("second\0\n\xff", 9);
  write_file_atomically(file, binary);
  EXPECT_EQ(read_file(file, 100), binary);
  write_file_atomically(file, "");
  EXPECT_EQ(read_file(file, 100), "");
  EXPECT_EQ(test::names_in(dir.path()), Names{"a.txt"});
}

TEST(WriteFileAtomically, GivesTheModeThatTheUserAskedForByUmask) {
  const TemporaryDirectory dir;
  const mode_t old = ::umask(027);
  write_file_atomically(dir / "a", "x");
  ::umask(old);
  struct stat status {};
  ASSERT_EQ(::stat((dir / "a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0666u & ~027u);
}

TEST(WriteFileAtomically, TakesARelativeName) {
  const TemporaryDirectory dir;
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(dir.path());
  write_file_atomically("bare", "x");
  std::filesystem::current_path(before);
  EXPECT_EQ(read_file(dir / "bare", 1), "x");
}

TEST(WriteFileAtomically, NamesTheMissingDirectory) {
  const TemporaryDirectory dir;
  const std::string message = io_error([&] { write_file_atomically(dir / "no/such/file", "x"); });
  EXPECT_NE(message.find((dir / "no/such/file").string()), std::string::npos) << message;
  EXPECT_NE(message.find("No such file or directory"), std::string::npos) << message;
}

TEST(WriteFileAtomically, LeavesTheOldFileWhenTheNewOneDoesNotFit) {
  const TemporaryDirectory dir;
  const auto file = dir / "a";
  write_file_atomically(file, "old");
  {
    const test::FileSizeLimit limit(megabyte);
    const std::string message = io_error([&] { write_file_atomically(file, std::string(megabyte + 1, 'x')); });
    EXPECT_NE(message.find("File too large; raise the limit"), std::string::npos) << message;
  }
  EXPECT_EQ(read_file(file, 100), "old");
  EXPECT_EQ(test::names_in(dir.path()), Names{"a"});
}

TEST(WriteFileAtomically, LeavesTheOldFileWhenTheDiskIsFull) {
  const test::SmallDisk disk("1m");
  if (!disk.exists()) GTEST_SKIP() << "no right to make a disk";
  const auto file = disk.path() / "a";
  write_file_atomically(file, "old");
  const std::string message = io_error([&] { write_file_atomically(file, std::string(2 * megabyte, 'x')); });
  EXPECT_NE(message.find("No space left on device; free some space"), std::string::npos) << message;
  EXPECT_EQ(read_file(file, 100), "old");
  EXPECT_EQ(test::names_in(disk.path()), Names{"a"});
}

TEST(WriteFileAtomically, RefusesWhatIsNotARegularFile) {
  const TemporaryDirectory dir;
  EXPECT_NE(io_error([&] { write_file_atomically("/dev/null", "x"); }).find("not a regular file"), std::string::npos);
  EXPECT_NE(io_error([&] { write_file_atomically(dir.path(), "x"); }).find("not a regular file"), std::string::npos);
}

TEST(WriteFileAtomically, IsWholeAfterAKill) {
  const TemporaryDirectory dir;
  const auto file = dir / "a";
  write_file_atomically(file, std::string(megabyte, 'a'));
  for (int i = 1; i <= 5; ++i) {
    test::run_and_kill(std::chrono::milliseconds(7 * i), [&] {
      for (char c = 'a';; c = c == 'z' ? 'a' : static_cast<char>(c + 1))
        write_file_atomically(file, std::string(megabyte, c));
    });
    const std::string content = read_file(file, megabyte);
    EXPECT_EQ(content, std::string(megabyte, content.at(0)));
  }
}

TEST(ReadFile, RefusesWhatItCannotRead) {
  const TemporaryDirectory dir;
  write_file_atomically(dir / "a", "12345");
  EXPECT_EQ(read_file(dir / "a", 5), "12345");
  EXPECT_NE(io_error([&] { read_file(dir / "a", 4); }).find("larger than 4 bytes"), std::string::npos);
  EXPECT_NE(io_error([&] { read_file(dir / "b", 4); }).find("No such file"), std::string::npos);
  EXPECT_NE(io_error([&] { read_file(dir.path(), 4); }).find("Is a directory"), std::string::npos);
}

TEST(OutputDirectory, IsCreatedWithItsParents) {
  const TemporaryDirectory dir;
  OutputDirectory out(dir / "some/where", OutputKind::run, {"0123"}, false);
  EXPECT_FALSE(out.extends());
  EXPECT_FALSE(out.finished());
  const auto marker = find_output_marker(dir / "some/where");
  ASSERT_TRUE(marker);
  EXPECT_EQ(marker->kind, OutputKind::run);
  EXPECT_EQ(marker->of.hash, "0123");
  EXPECT_FALSE(marker->finished);
}

TEST(OutputDirectory, TakesAnEmptyDirectory) {
  const TemporaryDirectory dir;
  EXPECT_FALSE(find_output_marker(dir.path()));
  EXPECT_NO_THROW(OutputDirectory(dir.path(), OutputKind::study, {"0123"}, true));
  EXPECT_EQ(find_output_marker(dir.path())->kind, OutputKind::study);
}

TEST(OutputDirectory, RefusesAForeignDirectoryAndLeavesNoTrace) {
  const TemporaryDirectory dir;
  write_file_atomically(dir / "thesis.tex", "years of work");
  const std::string message = io_error([&] { OutputDirectory(dir.path(), OutputKind::run, {"0123"}, true); });
  EXPECT_NE(message.find(dir.path().string()), std::string::npos) << message;
  EXPECT_NE(message.find("thesis.tex"), std::string::npos) << message;
  EXPECT_EQ(test::names_in(dir.path()), Names{"thesis.tex"});
}

TEST(OutputDirectory, RefusesAFile) {
  const TemporaryDirectory dir;
  write_file_atomically(dir / "file", "x");
  EXPECT_NE(io_error([&] { OutputDirectory(dir / "file", OutputKind::run, {"0"}, false); }).find("file"),
            std::string::npos);
  EXPECT_NE(io_error([&] { OutputDirectory(dir / "file/below", OutputKind::run, {"0"}, false); }).find("file"),
            std::string::npos);
}

TEST(OutputDirectory, RefusesAMarkerThatIsNotOurs) {
  const TemporaryDirectory dir;
  for (const char* text :
       {"not json", "[]", "{\"kind\": \"run\"}", "{\"kind\": \"nonsense\", \"case_hash\": \"0\", \"finished\": true}",
        "{\"kind\": \"run\", \"case_hash\": 0, \"finished\": true}"}) {
    write_file_atomically(dir / "talus-output.json", text);
    EXPECT_NE(io_error([&] { OutputDirectory(dir.path(), OutputKind::run, {"0"}, true); }).find("talus-output.json"),
              std::string::npos)
        << text;
  }
}

TEST(OutputDirectory, GoesOnWithAnUnfinishedRunOfTheSameCase) {
  const TemporaryDirectory dir;
  { const OutputDirectory first(dir.path(), OutputKind::run, {"0123"}, false); }
  write_file_atomically(dir / "history.csv", "ours");
  for (const bool resume : {false, true})
    EXPECT_NO_THROW(OutputDirectory(dir.path(), OutputKind::run, {"0123"}, resume));
  EXPECT_NE(io_error([&] { OutputDirectory(dir.path(), OutputKind::run, {"4567"}, true); }).find("another case"),
            std::string::npos);
  EXPECT_NE(io_error([&] {
              OutputDirectory(dir.path(), OutputKind::study, {"0123"}, true);
            }).find("it holds a run, not a study"),
            std::string::npos);
}

TEST(OutputDirectory, TakesALaterEndWithResumeOnlyAndWritesWhenReopened) {
  const TemporaryDirectory dir;
  const CaseIdentity shorter{"0123", "family", 2.0}, longer{"4567", "family", 12.0},
      other{"89ab", "another family", 12.0};
  OutputDirectory(dir.path(), OutputKind::run, shorter, false).mark_finished();
  EXPECT_NE(io_error([&] {
              OutputDirectory(dir.path(), OutputKind::run, longer, false);
            }).find("up to t = 2 s; --resume continues it to 12 s"),
            std::string::npos);
  EXPECT_NE(io_error([&] { OutputDirectory(dir.path(), OutputKind::run, other, true); }).find("another case"),
            std::string::npos);
  {
    OutputDirectory out(dir.path(), OutputKind::run, longer, true);
    EXPECT_TRUE(out.extends());
    EXPECT_FALSE(out.finished());
    EXPECT_EQ(out.earlier_end(), 2.0);
    EXPECT_TRUE(find_output_marker(dir.path())->finished);
    out.reopen();
  }
  EXPECT_EQ(find_output_marker(dir.path())->of.hash, "4567");
  EXPECT_FALSE(find_output_marker(dir.path())->finished);
  // Back to the earlier end: no longer the same case.
  EXPECT_NE(
      io_error([&] { OutputDirectory(dir.path(), OutputKind::run, shorter, true); }).find("beyond time.end_s = 2 s"),
      std::string::npos);
}

TEST(OutputDirectory, KeepsAFinishedRun) {
  const TemporaryDirectory dir;
  {
    OutputDirectory first(dir.path(), OutputKind::run, {"0123"}, false);
    first.mark_finished();
    EXPECT_TRUE(first.finished());
  }
  EXPECT_NE(io_error([&] { OutputDirectory(dir.path(), OutputKind::run, {"0123"}, false); }).find("finished run"),
            std::string::npos);
  const OutputDirectory again(dir.path(), OutputKind::run, {"0123"}, true);
  EXPECT_TRUE(again.finished());
}

TEST(OutputDirectory, KeepsASecondProcessOut) {
  const TemporaryDirectory dir;
  {
    OutputDirectory first(dir.path(), OutputKind::run, {"0123"}, false);
    const OutputDirectory moved(std::move(first));
    EXPECT_NE(io_error([&] { OutputDirectory(dir.path(), OutputKind::run, {"0123"}, true); }).find("another process"),
              std::string::npos);
  }
  EXPECT_NO_THROW(OutputDirectory(dir.path(), OutputKind::run, {"0123"}, true));
}

TEST(OutputDirectory, CleansUpAfterAKilledProcess) {
  const TemporaryDirectory dir;
  // What a claim that was killed leaves behind: a lock file and half of the marker.
  write_file_atomically(dir / "talus-output.lock", "");
  write_file_atomically(dir / ".talus-output.json.tmp-1-0", "{");
  { const OutputDirectory out(dir.path(), OutputKind::run, {"0123"}, false); }
  // And a run: half of a result.
  write_file_atomically(dir / ".result.json.tmp-1-0", "{");
  write_file_atomically(dir / "notes.txt", "a person's own");
  const OutputDirectory out(dir.path(), OutputKind::run, {"0123"}, true);
  EXPECT_EQ(test::names_in(dir.path()), (Names{"notes.txt", "talus-output.json", "talus-output.lock"}));
}

TEST(OutputDirectory, NamesADirectoryThatCannotBeMade) {
  const std::string message = io_error([&] { OutputDirectory("/proc/talus", OutputKind::run, {"0"}, false); });
  EXPECT_NE(message.find("/proc/talus"), std::string::npos) << message;
}

}  // namespace
}  // namespace talus
