#include "support/output_directory.hpp"

#include <chrono>
#include <system_error>
#include <thread>

#include "support/json.hpp"
#include "support/text.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;

constexpr const char* marker_name = "talus-output.json";
constexpr const char* lock_name = "talus-output.lock";
constexpr const char* kind_names[] = {"run", "study"};

const char* name(OutputKind kind) { return kind_names[static_cast<int>(kind)]; }

[[noreturn]] void refuse(const fs::path& directory, const std::string& why) {
  throw IoError("cannot write into " + directory.string() + ": " + why +
                "; choose another directory or remove this one");
}

/// A directory is ours once it has the marker; before that it may only hold what a killed claim leaves behind.
void refuse_foreign(const fs::path& directory) {
  if (find_output_marker(directory)) return;
  for (const auto& entry : fs::directory_iterator(directory)) {
    const fs::path file = entry.path().filename();
    const bool of_a_claim =
        file == lock_name || (is_temporary(file) && file.string().find(marker_name) != std::string::npos);
    if (!of_a_claim) refuse(directory, "it holds files that are not of Talus (" + file.string() + ")");
  }
}

/// Tries for a second: what a killed process was just starting keeps its lock until it has begun.
FileDescriptor lock(const fs::path& directory) {
  for (int tries = 0; tries < 50; ++tries) {
    if (FileDescriptor file = try_lock(directory / lock_name, false).file) return file;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  throw IoError("cannot write into " + directory.string() +
                ": another process of Talus is at work there; wait for it or choose another directory");
}

void remove_temporaries(const fs::path& directory) {
  for (const auto& entry : fs::directory_iterator(directory))
    if (entry.is_regular_file() && is_temporary(entry.path())) fs::remove(entry.path());
}

}  // namespace

bool is_output_lock(const fs::path& file) { return file.filename() == lock_name; }

bool is_temporary(const fs::path& file) {
  const std::string text = file.filename().string();
  return text.starts_with('.') && text.find(".tmp-") != std::string::npos;
}

fs::path output_marker_path(const fs::path& directory) { return directory / marker_name; }

std::optional<OutputMarker> find_output_marker(const fs::path& directory) {
  const fs::path path = output_marker_path(directory);
  std::error_code error;
  if (!fs::exists(path, error) && !error) return std::nullopt;
  return read_json(path, 1 << 16, "a marker of Talus; remove the directory or choose another one",
                   [&](const Json& json) {
                     const auto kind = json.at("kind").get<std::string>();
                     if (kind != "run" && kind != "study")
                       throw IoError(path.string() + ": /kind is \"" + kind + "\", not run or study");
                     return OutputMarker{.kind = kind == "run" ? OutputKind::run : OutputKind::study,
                                         .of = {.hash = json.at("case_hash").get<std::string>(),
                                                .hash_without_end = json.value("case_hash_without_end", ""),
                                                .end = json.value("end_s", 0.0)},
                                         .finished = json.at("finished").get<bool>()};
                   });
}

OutputDirectory::OutputDirectory(fs::path path, OutputKind kind, const CaseIdentity& of, bool resume)
    : path_(std::move(path)), marker_{.kind = kind, .of = of} {
  try {
    fs::create_directories(path_);
    refuse_foreign(path_);  // first, since the lock file would stay behind in a foreign directory
    lock_ = lock(path_);
    if (const auto old = find_output_marker(path_)) {
      if (old->kind != kind) refuse(path_, std::string("it holds a ") + name(old->kind) + ", not a " + name(kind));
      const bool extends = of.extends(old->of);
      if (extends && old->finished && !resume)
        throw IoError(path_.string() + " holds this " + name(kind) + " up to t = " + to_text(old->of.end) +
                      " s; --resume continues it to " + to_text(of.end) + " s");
      if (old->of.extends(of))
        refuse(path_, std::string("it holds this ") + name(kind) + " up to t = " + to_text(old->of.end) +
                          " s, beyond time.end_s = " + to_text(of.end) + " s");
      if (old->of.hash != of.hash && !extends)
        refuse(path_, std::string("it holds a ") + name(kind) + " of another case (or of other settings)");
      if (old->finished && !resume) refuse(path_, std::string("it holds a finished ") + name(kind));
      marker_.finished = old->finished && !extends;
      if (extends) earlier_end_ = old->of.end;
    }
    remove_temporaries(path_);
    if (!finished() && !extends()) write_marker();
  } catch (const fs::filesystem_error& e) {
    throw_io_error("write into", path_, e.code().value());
  }
}

void OutputDirectory::reopen() {
  marker_.finished = false;
  write_marker();
}

void OutputDirectory::mark_finished() {
  marker_.finished = true;
  write_marker();
}

void OutputDirectory::write_marker() const {
  const Json json = {{"program", "talus"},           {"kind", name(marker_.kind)},
                     {"case_hash", marker_.of.hash}, {"case_hash_without_end", marker_.of.hash_without_end},
                     {"end_s", marker_.of.end},      {"finished", marker_.finished}};
  write_file_atomically(output_marker_path(path_), with_checksum(json));
}

}  // namespace talus
