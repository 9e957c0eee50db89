// What Slurm's programs, the operator's file and the files of a batch may say, rightly or not.

#include <gtest/gtest.h>

#include "executor/run_times.hpp"
#include "executor/slurm_batch.hpp"
#include "executor/slurm_config.hpp"
#include "executor/slurm_queue.hpp"
#include "files.hpp"

using namespace talus::executor;
using talus::test::content;
using talus::test::TemporaryDirectory;
using talus::test::write;

namespace {

std::string queue(const std::string& jobs) { return R"({"meta": {}, "errors": [], "jobs": [)" + jobs + "]}"; }

std::string what_fails(const std::string& json) {
  try {
    SlurmQueue{json};
  } catch (const talus::IoError& e) {
    return e.what();
  }
  return "";
}

template <class Error, class Action>
std::string message(Action action) {
  try {
    action();
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST(SlurmQueue, ReadsSlurm2205) {
  const SlurmQueue q(queue(R"(
    {"array_job_id": 7, "array_task_id": null, "array_task_string": "2-4,9%3", "job_state": "PENDING",
     "name": "talus-x"},
    {"array_job_id": 7, "array_task_id": 0, "array_task_string": "", "job_state": "RUNNING", "name": "talus-x"},
    {"array_job_id": 7, "array_task_id": 1, "array_task_string": "", "job_state": "NODE_FAIL", "name": "talus-x"},
    {"array_job_id": 0, "array_task_id": null, "job_state": "RUNNING", "name": "another"})"));
  EXPECT_TRUE(q.task(7, 0)->running);
  EXPECT_FALSE(q.task(7, 1)->alive);
  EXPECT_EQ(q.task(7, 1)->state, "NODE_FAIL");
  for (const int waiting : {2, 3, 4, 9}) EXPECT_TRUE(q.task(7, waiting)->alive && !q.task(7, waiting)->running);
  EXPECT_FALSE(q.task(7, 5));
  EXPECT_FALSE(q.task(8, 0));
  EXPECT_EQ(q.job_named("talus-x"), 7);
  EXPECT_FALSE(q.job_named("another"));
}

TEST(SlurmQueue, ReadsLaterVersions) {
  const SlurmQueue q(queue(R"(
    {"array_job_id": {"set": true, "infinite": false, "number": 7}, "array_task_id": {"set": false, "number": 0},
     "array_task_string": "1,3,...", "job_state": ["PENDING"], "name": "a"},
    {"array_job_id": {"set": true, "number": 7}, "array_task_id": {"set": true, "number": 0},
     "job_state": ["TIMEOUT", "COMPLETING"], "name": "a"},
    {"array_job_id": {"set": true, "number": 7}, "array_task_id": {"set": true, "number": 2},
     "job_state": ["TIMEOUT"], "name": "a"})"));
  EXPECT_TRUE(q.task(7, 0)->alive);
  EXPECT_FALSE(q.task(7, 2)->alive);
  EXPECT_TRUE(q.task(7, 999)->alive);  // the list is cut short: it may be any that has no record of its own
}

TEST(SlurmQueue, WhyATaskWaits) {
  const SlurmQueue q(queue(R"(
    {"array_job_id": 7, "array_task_id": null, "array_task_string": "1-3", "job_state": "PENDING",
     "state_reason": "JobHeldUser"},
    {"array_job_id": 7, "array_task_id": 0, "job_state": "RUNNING", "state_reason": "None"},
    {"array_job_id": 8, "array_task_id": 0, "job_state": "PENDING"})"));
  EXPECT_EQ(q.task(7, 2)->reason, "JobHeldUser");
  EXPECT_EQ(q.task(7, 0)->reason, "");
  EXPECT_EQ(q.task(8, 0)->reason, "");
}

TEST(SlurmQueue, AStateThatNobodyKnowsIsNotAnEnd) {
  EXPECT_TRUE(
      SlurmQueue(queue(R"({"array_job_id": 7, "array_task_id": 0, "job_state": "TELEPORTING"})")).task(7, 0)->alive);
}

TEST(SlurmQueue, NamesThePlaceOfWhatItCannotRead) {
  EXPECT_NE(what_fails("slurm_load_jobs error"), "");
  EXPECT_NE(what_fails("[]").find("object"), std::string::npos);
  EXPECT_NE(what_fails(R"({"jobs": 3})").find("/jobs is not a list"), std::string::npos);
  EXPECT_NE(what_fails(queue("3")).find("/jobs/0 is not an object"), std::string::npos);
  EXPECT_NE(what_fails(queue(R"({"array_job_id": "7"})")).find("/jobs/0/array_job_id"), std::string::npos);
  EXPECT_NE(what_fails(queue(R"({"array_job_id": {"set": true}})")).find("/jobs/0/array_job_id"), std::string::npos);
  EXPECT_NE(
      what_fails(queue(R"({"array_job_id": 7, "array_task_id": -1, "job_state": "RUNNING"})")).find("array_task_id"),
      std::string::npos);
  for (const char* state : {"null", "[]", "[3]", "3"}) {
    const std::string json =
        queue(R"({"array_job_id": 7, "array_task_id": 1, "job_state": )" + std::string(state) + "}");
    EXPECT_NE(what_fails(json).find("job_state"), std::string::npos) << state;
  }
  EXPECT_NE(what_fails(R"({"errors": [{"error": "Unable to contact slurm controller"}], "jobs": []})").find("Unable"),
            std::string::npos);
}

TEST(SlurmQueue, Indices) {
  EXPECT_EQ(*parse_indices("0-2,5,7-11:2%4"), (std::set<std::int64_t>{0, 1, 2, 5, 7, 9, 11}));
  for (const char* bad : {"", "1,", "1,...", "3-1", "1-2:0", "a", "-1", "0-99999999999", "1-2-3"})
    EXPECT_FALSE(parse_indices(bad)) << bad;
}

TEST(SlurmAnswer, TheNumberOfTheJob) {
  EXPECT_EQ(parse_job_id("123\n"), 123);
  EXPECT_EQ(parse_job_id("123;north\n"), 123);
  for (const char* bad : {"", "\n", "0", "-4", "Submitted batch job 7", "99999999999999999999", "12 13"})
    EXPECT_THROW(parse_job_id(bad), talus::IoError) << bad;
}

TEST(SlurmConfig, EveryFaultAtOnce) {
  const SlurmConfig c = parse_slurm_config(
      R"({"partition": "long", "memory_MiB": 2000, "sbatch_options": ["--qos=low", "-C", "--constraint=a&b"]})", "f");
  EXPECT_EQ(c.partition, "long");
  EXPECT_EQ(c.memory_MiB, 2000);
  EXPECT_EQ(c.time_limit_min, 60);
  EXPECT_EQ(c.sbatch_options.size(), 3u);
  const std::string faults = message<SlurmConfigError>([] {
    parse_slurm_config(
        R"({"partition": "a;b", "account": 3, "time_limit_min": 0, "task_s": null, "cpus_per_task": 1.5, "sbatch": [],
                           "sbatch_options": ["--array=1", "-W", "-o/x", "qos", 4]})",
        "slurm.json");
  });
  for (const char* fault :
       {"slurm.json: /partition may", "/account is not a text", "/time_limit_min is not an integer", "/task_s is null",
        "/cpus_per_task is not an integer", "/sbatch is not a known key", "/sbatch_options/0 --array",
        "/sbatch_options/1 -W", "/sbatch_options/2 -o", "/sbatch_options/3 is not", "/sbatch_options/4 is not"})
    EXPECT_NE(faults.find(fault), std::string::npos) << fault << "\n" << faults;
  EXPECT_THROW(parse_slurm_config("[", "f"), SlurmConfigError);
  EXPECT_THROW(parse_slurm_config("[]", "f"), SlurmConfigError);
  EXPECT_THROW(read_slurm_config("/no/such/file"), SlurmConfigError);
}

TEST(Batch, SaysWhatItWasTold) {
  const TemporaryDirectory directory;
  const BatchDirectory batch(directory / "batch");
  talus::executor::Run run{.name = "j/000001",
                           .group = "j",
                           .command = {.arguments = {"/bin/talus", "run"}},
                           .directory = "/d",
                           .log = "/d.log"};
  talus::executor::Run limited = run;
  limited.command.environment = std::vector<std::string>{"A=1"};
  limited.command.limits = {
      .memory_bytes = 1, .cpu_seconds = 2, .file_bytes = 3, .wall_seconds = 4, .core_dumps = false};
  limited.command.niceness = 5;
  batch.write({{run}, {run, limited}});
  EXPECT_EQ(batch.runs(0)->size(), 1u);
  EXPECT_FALSE(batch.runs(2));
  const talus::executor::Run back = batch.runs(1)->at(1);
  EXPECT_EQ(back.command.arguments, limited.command.arguments);
  EXPECT_EQ(back.command.environment, limited.command.environment);
  EXPECT_EQ(back.command.limits.wall_seconds, 4u);
  EXPECT_FALSE(back.command.limits.core_dumps);
  EXPECT_FALSE(batch.runs(0)->at(0).command.environment);
  EXPECT_EQ(back.directory, "/d");

  EXPECT_FALSE(batch.has_status({1, 1}));
  batch.write_status({1, 1}, {.end = {.exit_code = 4}, .seconds = 1.5, .resumed = true, .why = "because"});
  batch.write_status({0, 0}, {.end = {.signal = 9}, .timed_out = true});
  EXPECT_EQ(batch.statuses(), (std::vector<RunPlace>{{0, 0}, {1, 1}}));
  EXPECT_EQ(batch.status({1, 1}).end.exit_code, 4);
  EXPECT_TRUE(batch.status({1, 1}).resumed);
  EXPECT_EQ(batch.status({1, 1}).why, "because");
  EXPECT_TRUE(batch.status({0, 0}).timed_out);

  EXPECT_FALSE(batch.job());
  batch.write_job(77);
  EXPECT_EQ(batch.job(), 77);
  EXPECT_FALSE(batch.is_killed({0, 0}));
  batch.want_killed({0, 0});
  EXPECT_TRUE(batch.is_killed({0, 0}));
}

TEST(Batch, DamagedFilesAreNamed) {
  const TemporaryDirectory directory;
  const BatchDirectory batch(directory.path());
  const std::string good =
      R"({"exit_code": 0, "signal": 0, "seconds": 1, "resumed": false, "timed_out": false, "why": ""})";
  write(directory / "0-0.status", good);
  EXPECT_EQ(batch.status({0, 0}).end.exit_code, 0);
  for (const auto& [from, to] :
       std::vector<std::pair<std::string, std::string>>{{"\"exit_code\": 0", "\"exit_code\": 256"},
                                                        {"\"exit_code\": 0", "\"exit_code\": \"0\""},
                                                        {"\"signal\": 0", "\"signal\": -1"},
                                                        {"\"seconds\": 1", "\"seconds\": -1"},
                                                        {"\"resumed\": false, ", ""},
                                                        {"{", ""}}) {
    std::string bad = good;
    bad.replace(bad.find(from), from.size(), to);
    write(directory / "0-0.status", bad);
    const std::string said = message<talus::IoError>([&] { batch.status({0, 0}); });
    EXPECT_NE(said.find("0-0.status"), std::string::npos) << bad;
  }
  for (const char* name : {"x-0.status", "0.status", "0-.status", "-1-0.status", "0-0.status.tmp-12", "0-0.json"})
    write(directory / name, good);
  EXPECT_EQ(batch.statuses().size(), 1u);
  write(directory / "3.json", R"({"runs": [{"name": "a"}]})");
  EXPECT_NE(message<talus::IoError>([&] { batch.runs(3); }).find("3.json"), std::string::npos);
  EXPECT_TRUE(BatchDirectory(directory / "none").statuses().empty());
  write(directory / "job", "7x");
  EXPECT_FALSE(batch.job());
}

TEST(RunTimes, AMeanOfEachGroup) {
  RunTimes times;
  EXPECT_FALSE(times.of("a"));
  times.still_runs("a", 9.0);
  EXPECT_FALSE(times.of("a"));
  times.still_runs("a", 20.0);
  times.still_runs("a", 15.0);
  EXPECT_EQ(times.of("a"), 20.0);
  times.ended("a", 1.0);
  times.ended("a", 2.0);
  EXPECT_EQ(times.of("a"), (1.0 + 2.0) / 2.0);
  EXPECT_FALSE(times.of("b"));
}

TEST(RunTimes, SizeOfAChunk) {
  EXPECT_EQ(chunk_size(1000, 10, std::nullopt, 300.0), 1u);
  EXPECT_EQ(chunk_size(1000, 10, 3600.0, 300.0), 1u);    // longer than a task should be: one each
  EXPECT_EQ(chunk_size(1000000, 10, 3.0, 300.0), 100u);  // 300 s
  EXPECT_EQ(chunk_size(200, 10, 3.0, 300.0), 20u);       // all free tasks get some
  EXPECT_EQ(chunk_size(200, 200, 0.1, 300.0), 100u);     // at least 10 s
  EXPECT_EQ(chunk_size(120, 200, 0.1, 300.0), 60u);      // two tasks, equally long
  EXPECT_LE(chunk_size(1000000, 1, 1e-9, 86400.0), 5000u);
}
