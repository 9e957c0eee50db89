#include "queue/records.hpp"

namespace talus::service {
namespace {

constexpr const char* job_words[] = {"accepted", "running", "successful", "failed", "dismissed"};
constexpr const char* run_words[] = {"queued", "leased", "done", "failed"};

template <class State, std::size_t n>
std::optional<State> find(const char* const (&words)[n], const std::string& word) {
  for (std::size_t i = 0; i < n; ++i)
    if (word == words[i]) return static_cast<State>(i);
  return std::nullopt;
}

}  // namespace

const char* word(JobState state) { return job_words[static_cast<int>(state)]; }
const char* word(RunState state) { return run_words[static_cast<int>(state)]; }
std::optional<JobState> job_state(const std::string& word) { return find<JobState>(job_words, word); }
std::optional<RunState> run_state(const std::string& word) { return find<RunState>(run_words, word); }

}  // namespace talus::service
