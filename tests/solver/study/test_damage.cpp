// Single flipped bits in the files of a study: each is found, or changes nothing of what is read.

#include <functional>
#include <iostream>
#include <map>
#include <random>

#include "studies.hpp"
#include "study/directory_store.hpp"
#include "study/publish.hpp"
#include "study/run_study.hpp"
#include "support/files.hpp"
#include "support/json.hpp"
#include "support/output_directory.hpp"
#include "support/text.hpp"

using namespace talus;
using namespace talus::fixtures;

namespace {

namespace fs = std::filesystem;

/// A study of three realizations and a replicate, one of them failed.
struct FinishedStudy {
  TemporaryDirectory directory;
  fs::path out = directory / "study";
  Plan plan = fixtures::plan(3);

  FinishedStudy() {
    plan.study.noise_floor_replicates = 1;
    plan.study.max_failed_share = 1.0;
    RunStudyOptions options;
    options.program = {FAKE_RUN, (directory / "diary").string(), "0", "1=diverge"};
    options.poll = std::chrono::milliseconds(1);
    run_study(plan, {{"title", "A slope"}}, out, options);
  }
};

/// Everything that a program learns from the files of a study: by name, as text. What is found to be damaged is
/// missing.
using Knowledge = std::map<std::string, std::string>;

Knowledge learn(const fs::path& out, const StudyIdentity& identity, const StudySpec& expected) {
  Knowledge all;
  const auto unless_damaged = [](const std::function<void()>& read) {
    try {
      read();
    } catch (const IoError&) {
    }
  };
  for (const RunKind kind : {RunKind::realization, RunKind::replicate})
    unless_damaged([&] {
      for (const auto& [index, record] : read_records({out}, kind, identity))
        all[run_name({.kind = kind, .index = index})] = csv_line(record);
    });
  unless_damaged([&] {
    const Tables tables = read_tables(out);
    for (const Record& record : tables.runs) all["row " + std::to_string(record.index)] = csv_line(record);
    for (const Record& record : tables.floor)
      all["row of replicate " + std::to_string(record.index)] = csv_line(record);
  });
  unless_damaged([&] {
    const std::optional<Plan> plan = find_plan(out);
    if (!plan) return;
    all["plan"] = plan->title + plan->of.hash + plan->of.hash_without_end + plan->version + to_text(plan->of.end) +
                  std::to_string(plan->seed) + (plan->study == expected ? "same" : "other");
  });
  unless_damaged([&] {
    Json summary = read_json(StudyPaths{out}.summary(), std::size_t{1} << 24);
    summary.erase("checksum");
    all["summary"] = summary.dump();
  });
  unless_damaged([&] {
    if (const auto marker = find_output_marker(out))
      all["marker"] = marker->of.hash + to_text(marker->of.end) + (marker->finished ? "finished" : "");
  });
  return all;
}

TEST(Damage, NoFlippedBitChangesANumberInSilence) {
  const FinishedStudy study;
  const StudyIdentity identity = talus::identity(study.plan);
  const Knowledge whole = learn(study.out, identity, study.plan.study);
  EXPECT_EQ(whole.size(), 3 + 1 + 3 + 1 + 3);
  std::mt19937 random(1);
  int flips = 0, found = 0;
  for (const auto& entry : fs::recursive_directory_iterator(study.out)) {
    if (!entry.is_regular_file() || entry.file_size() == 0 || entry.path() == StudyPaths{study.out}.resolved_case())
      continue;
    const std::string content = fixtures::content(entry.path());
    for (int i = 0; i < 90; ++i) {
      std::string damaged = content;
      const std::size_t bit = random() % (8 * content.size());
      damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
      fixtures::write(entry.path(), damaged);
      const Knowledge known = learn(study.out, identity, study.plan.study);
      for (const auto& [name, value] : known)
        EXPECT_EQ(value, whole.contains(name) ? whole.at(name) : "nothing")
            << entry.path() << ", bit " << bit << ": " << name;
      ++flips;
      found += known.size() < whole.size() ? 1 : 0;
    }
    fixtures::write(entry.path(), content);
  }
  EXPECT_EQ(learn(study.out, identity, study.plan.study), whole);
  std::cout << flips << " flips, " << found << " found to be damage, the others change nothing that is read\n";
  EXPECT_GT(found, flips / 2);
}

TEST(Damage, TheResultOfAnotherRunIsRefused) {
  const FinishedStudy study;
  const StudyPaths paths{study.out};
  const StudyIdentity identity = talus::identity(study.plan);
  EXPECT_TRUE(read_result(paths.result(realization(0)), realization(0), identity));
  for (const RunKey& other : {realization(1), replicate(1), replicate(2)})
    EXPECT_THROW(read_result(paths.result(realization(0)), other, identity), ForeignResult) << run_name(other);
  EXPECT_THROW(read_result(paths.result(replicate(1)), realization(0), identity), ForeignResult);
}

}  // namespace
