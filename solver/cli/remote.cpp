// talus submit, status, watch, results, cancel: the subcommands that use a talusd.

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <iterator>
#include <memory>
#include <random>

#include "case/load.hpp"
#include "cli/help.hpp"
#include "cli/http_client.hpp"
#include "cli/progress.hpp"
#include "cli/verbs.hpp"
#include "run/warnings.hpp"
#include "support/files.hpp"
#include "support/text.hpp"

namespace talus::cli {
namespace {

struct RemoteOptions {
  std::string server = "http://127.0.0.1:8080";  ///< URL; --server, else TALUS_SERVER
  std::string token_file;                        ///< unset: TALUS_TOKEN holds the token itself
  std::string job, case_file, out;
  std::vector<std::string> overrides;
  std::optional<std::int64_t> realizations;
  std::optional<std::uint64_t> seed;
  bool json = false, watch = false;
};

std::string token(const RemoteOptions& options) {
  const char* given = std::getenv("TALUS_TOKEN");
  std::string text = options.token_file.empty() ? (given ? given : "") : read_file(options.token_file, 4096);
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  return text;
}

/// Sent again after a broken connection, a request with the same key makes no second job.
std::string new_key() {
  std::random_device entropy;
  char text[40];
  std::snprintf(text, sizeof text, "talus-%08x%08x%08x", entropy(), entropy(), entropy());
  return text;
}

[[noreturn]] void not_a_talusd(const std::string& url) {
  throw IoError(url + " answered, but not as talusd; check the URL");
}

/// What the server answered, if that is a success.
/// @throws ConfigError with the server's faults when it refuses what we sent, IoError for everything else
Json answer_of(const HttpReply& reply, const std::string& url) {
  const Json body = Json::parse(reply.body, nullptr, false);
  if (body.is_discarded()) not_a_talusd(url);
  if (reply.status < 300) return body;
  const std::string detail = body.value("detail", "status " + std::to_string(reply.status));
  if (reply.status != 400 && reply.status != 422) throw IoError("talusd at " + url + ": " + detail);
  std::vector<Fault> faults;
  for (const Json& error : body.value("errors", Json::array()))
    faults.push_back({error.value("pointer", ""), error.value("message", "")});
  if (faults.empty()) faults.push_back({"", detail});
  throw ConfigError(faults);
}

/// Sends a request and waits for its answer. @param body  of a POST
Json ask(const RemoteOptions& options, const char* method, const std::string& path, const Json& body = {}) {
  HttpRequest request{.method = method, .path = path};
  if (const std::string secret = token(options); !secret.empty())
    request.headers.emplace_back("Authorization", "Bearer " + secret);
  if (!body.is_null()) {
    request.headers.emplace_back("Idempotency-Key", new_key());
    request.headers.emplace_back("Content-Type", "application/json");
    request.body = body.dump();
  }
  return answer_of(send_request(options.server, request), options.server);
}

std::string path_of(const std::string& job) {
  if (job.empty() || job.find_first_not_of("0123456789abcdef") != std::string::npos)
    throw ConfigError("", "\"" + job + "\" is not a job ID; talus status lists the jobs");
  return "/jobs/" + job;
}

std::string line_of(const Json& info) {
  return info.at("jobID").get<std::string>() + "  " + info.at("status").get<std::string>() + "  " +
         std::to_string(info.at("progress").get<int>()) + " %  " + info.at("message").get<std::string>();
}

Progress progress_of(const Json& info, double elapsed) {
  Progress p{.elapsed = elapsed};
  if (!info.contains("realizations")) return p;
  const Json& runs = info.at("realizations");
  p.planned = runs.at("planned");
  p.done = runs.at("done");
  p.failed = runs.at("failed");
  p.made_now = p.done + p.failed;
  p.pending_reason = info.value("waits", "");
  return p;
}

/// Shows the progress of a job until it ends: a bar on a terminal, occasional lines elsewhere.
Json follow(const RemoteOptions& options, const std::string& job) {
  const bool terminal = ::isatty(STDERR_FILENO) != 0;
  const auto begin = std::chrono::steady_clock::now();
  auto told = begin - std::chrono::minutes(1);
  std::int64_t version = 0;
  for (;;) {
    const Json info = ask(options, "GET", path_of(job) + "/events?wait=20&since=" + std::to_string(version));
    version = info.at("version");
    const auto now = std::chrono::steady_clock::now();
    const Progress p = progress_of(info, std::chrono::duration<double>(now - begin).count());
    const std::string state = info.at("status");
    const bool over = state != "accepted" && state != "running";
    if (terminal) {
      std::cerr << "\r" << progress_bar(p, terminal_width() - 1) << "\033[K" << (over ? "\n" : "") << std::flush;
    } else if (over || now - told > std::chrono::seconds(10)) {
      std::cerr << line_of(info) << "\n";
      told = now;
    }
    if (over) return info;
    ::usleep(100'000);  // a job of many short runs changes all the time
  }
}

Exit exit_of(const Json& info) {
  const std::string state = info.at("status");
  if (state == "failed") return Exit::too_many_failed;
  return state == "dismissed" ? Exit::interrupted : Exit::ok;
}

Exit watch(const RemoteOptions& options) {
  const Json info = follow(options, options.job);
  if (options.json) std::cout << info.dump(2) << "\n";
  return exit_of(info);
}

Exit submit(const RemoteOptions& options) {
  LoadedCase loaded = load_case(options.case_file, options.overrides);  // files beside the case are put into it
  std::ranges::move(warnings_before_run(loaded.value), std::back_inserter(loaded.warnings));
  print_warnings(loaded.warnings);
  Json inputs = {{"case", loaded.resolved}};
  if (options.realizations) inputs["realizations"] = *options.realizations;
  if (options.seed) inputs["seed"] = *options.seed;
  const Json info = ask(options, "POST", "/processes/influence-zone/execution", {{"inputs", inputs}});
  const std::string job = info.at("jobID");
  if (options.json)
    std::cout << info.dump(2) << "\n";
  else
    std::cout << job << std::endl;
  return options.watch ? exit_of(follow(options, job)) : Exit::ok;
}

Exit status(const RemoteOptions& options) {
  const Json answer = ask(options, "GET", options.job.empty() ? "/jobs" : path_of(options.job));
  if (options.json)
    std::cout << answer.dump(2) << "\n";
  else if (options.job.empty())
    for (const auto& info : answer.at("jobs")) std::cout << line_of(info) << "\n";
  else
    std::cout << line_of(answer) << "\n";
  return Exit::ok;
}

Exit results(const RemoteOptions& options) {
  const Json answer = ask(options, "GET", path_of(options.job) + "/results");
  if (!options.out.empty()) write_file_atomically(options.out, answer.dump(2) + "\n");
  if (options.json) std::cout << answer.dump(2) << "\n";
  if (options.json || !options.out.empty() || !answer.contains("summary")) return Exit::ok;
  std::cout << study_report(answer.at("summary").at("value"));
  return Exit::ok;
}

Exit cancel(const RemoteOptions& options) {
  const Json info = ask(options, "DELETE", path_of(options.job));
  std::cout << (options.json ? info.dump(2) : line_of(info)) << "\n";
  return Exit::ok;
}

/// A verb with the options that all of these share.
CLI::App* add_verb(CLI::App& app, Action& action, const char* name, const char* help,
                   const std::shared_ptr<RemoteOptions>& options, Exit (*carry_out)(const RemoteOptions&)) {
  CLI::App* verb = app.add_subcommand(name, help);
  verb->group("Commands for a talusd server");
  verb->add_option("--server", options->server, "URL of the talusd server")
      ->type_name("URL")
      ->envname("TALUS_SERVER")
      ->capture_default_str();
  verb->add_option("--token-file", options->token_file, "File with the token; default: $TALUS_TOKEN, if set")
      ->type_name("FILE");
  verb->add_flag("--json", options->json, "Print the server's answer as JSON");
  verb->callback([options, carry_out, &action] {
    action = [options, carry_out] {
      try {
        return carry_out(*options);
      } catch (const Json::exception&) {  // JSON, but with other members than those of talusd
        not_a_talusd(options->server);
      }
    };
  });
  return verb;
}

}  // namespace

void add_remote(CLI::App& app, Action& action) {
  // One for each verb, since TALUS_SERVER is read for all of them, whichever is chosen.
  const auto make = [] { return std::make_shared<RemoteOptions>(); };
  auto options = make();
  CLI::App* verb =
      add_verb(app, action, "submit", "Submit a study to a talusd server; prints the job ID", options, submit);
  verb->add_option("CASE", options->case_file, "Case file (JSON); the CSV files it names are sent along")->required();
  verb->add_option("--realizations", options->realizations, "Number of realizations; default: the case's")
      ->check(CLI::Range(1, 1'000'000'000));
  verb->add_option("--seed", options->seed, "Seed of the random fields; default: the case's, else the server's choice")
      ->check(CLI::Range(std::int64_t{0}, max_exact_integer));
  add_overrides(*verb, options->overrides);
  verb->add_flag("--watch", options->watch, "Wait until the job has ended");
  set_footer(*verb, {exit_text::bad_case, exit_text::io, exit_text::dismissed, exit_text::failed},
             {"submit slope.json --realizations 500 --watch"});
  options = make();
  verb = add_verb(app, action, "status", "Show job status (all jobs if no ID is given)", options, status);
  verb->add_option("JOB", options->job, "Job ID");
  set_footer(*verb, {exit_text::io}, {"status", "status JOB --json"});
  options = make();
  verb = add_verb(app, action, "watch", "Follow a job until it has ended", options, watch);
  verb->add_option("JOB", options->job, "Job ID")->required();
  set_footer(*verb, {exit_text::io, exit_text::dismissed, exit_text::failed}, {"watch JOB"});
  options = make();
  verb = add_verb(app, action, "results", "Show or save the results of a job", options, results);
  verb->add_option("JOB", options->job, "Job ID")->required();
  verb->add_option("--out", options->out, "Output file (JSON)")->type_name("FILE");
  set_footer(*verb, {exit_text::io}, {"results JOB", "results JOB --out study.json"});
  options = make();
  verb = add_verb(app, action, "cancel", "Cancel a job and delete its files", options, cancel);
  verb->add_option("JOB", options->job, "Job ID")->required();
  set_footer(*verb, {exit_text::io}, {"cancel JOB"});
}

}  // namespace talus::cli
