#include "study/paths.hpp"

namespace talus {
namespace {

std::string stem(Job job) {
  const std::string digits = std::to_string(job.index);
  return job.floor ? digits : std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits;
}

}  // namespace

std::string job_name(Job job) {
  return (job.floor ? "noise-floor replicate " : "realization ") + std::to_string(job.index);
}

std::filesystem::path StudyPaths::result(Job job) const {
  return (job.floor ? floor() : runs()) / (stem(job) + ".json");
}
std::filesystem::path StudyPaths::failure(Job job) const {
  return (job.floor ? floor() : runs()) / (stem(job) + ".failed.json");
}
std::filesystem::path StudyPaths::work(Job job) const { return work() / ((job.floor ? "floor-" : "") + stem(job)); }
std::filesystem::path StudyPaths::log(Job job) const { return work(job).concat(".log"); }

}  // namespace talus
