#include "study/run_key.hpp"

#include "support/text.hpp"

namespace talus {
namespace {

constexpr std::size_t stem_digits = 6;
constexpr const char* replicate_prefix = "floor-";

}  // namespace

std::string run_name(const RunKey& key) {
  return (key.is_replicate() ? "noise-floor replicate " : "realization ") + std::to_string(key.index);
}

std::string file_stem(const RunKey& key) {
  const std::string digits = std::to_string(key.index);
  if (key.is_replicate() || digits.size() >= stem_digits) return digits;
  return std::string(stem_digits - digits.size(), '0') + digits;
}

std::string work_name(const RunKey& key) { return (key.is_replicate() ? replicate_prefix : "") + file_stem(key); }

std::optional<RunKey> run_of_work_name(const std::string& name) {
  const bool replicate = name.starts_with(replicate_prefix);
  const auto index =
      to_integer(std::string_view(name).substr(replicate ? std::string_view(replicate_prefix).size() : 0));
  if (!index) return std::nullopt;
  return RunKey{.kind = replicate ? RunKind::replicate : RunKind::realization, .index = *index};
}

std::string perturbation(const RunKey& key) {
  return key.is_replicate() ? to_text(static_cast<double>(key.index) / 1e6) : std::string();
}

std::string replay_command(const RunKey& key, std::uint64_t seed, const std::string& case_file) {
  return "talus run " + case_file + " --realization " + std::to_string(key.drawn_realization()) + " --seed " +
         std::to_string(seed) + (key.is_replicate() ? " --perturbation " + perturbation(key) : "") + " --out DIR";
}

}  // namespace talus
