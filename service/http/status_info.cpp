#include "http/links.hpp"

namespace talus::service {
namespace {

std::int64_t progress(const Job& job) {
  if (job.state == JobState::successful) return 100;
  const std::int64_t all = job.planned + job.floor, made = job.done + job.failed + job.floor_made;
  return all > 0 ? std::min<std::int64_t>(99, 100 * made / all) : 0;
}

std::string message(const Job& job) {
  if (ended(job.state)) return job.message;
  if (job.state == JobState::accepted) return "waiting";
  if (job.planned == 0) return "running";
  std::string text = std::to_string(job.done) + " of " + std::to_string(job.planned) + " realizations done";
  if (job.failed > 0) text += ", " + std::to_string(job.failed) + " failed";
  if (!job.message.empty()) text += "; " + job.message;
  return text;
}

Json links(const Job& job, const Exchange& exchange) {
  const std::string path = "/jobs/" + job.id;
  Json all = Json::array({link(exchange, path, "self", "This job")});  // a bare {link} is an object for some compilers
  if (!ended(job.state)) all.push_back(link(exchange, path, "monitor", "Progress events"));
  if (job.state == JobState::successful)
    all.push_back(link(exchange, path + "/results", "http://www.opengis.net/def/rel/ogc/1.0/results", "Results"));
  if (job.planned == 0 || job.state == JobState::dismissed) return all;
  all.push_back(link(exchange, path + "/histogram", "related", "Histogram of the realizations done so far"));
  all.push_back(link(exchange, path + "/realizations", "related", "Realizations"));
  all.push_back(link(exchange, path + "/events", "related", "Events", event_stream));
  return all;
}

}  // namespace

Json status_info(const Job& job, const Exchange& exchange) {
  Json info = {{"jobID", job.id},
               {"processID", job.process},
               {"type", "process"},
               {"status", word(job.state)},
               {"message", message(job)},
               {"created", utc_text(job.created)},
               {"updated", utc_text(job.updated)},
               {"progress", progress(job)}};
  if (job.started) info["started"] = utc_text(*job.started);
  if (!ended(job.state) && !job.message.empty()) info["waits"] = job.message;
  if (job.finished) info["finished"] = utc_text(*job.finished);
  if (job.planned > 0) {
    info["title"] = job.title;
    info["seed"] = job.seed;
    info["realizations"] = {{"planned", job.planned}, {"done", job.done}, {"failed", job.failed}};
  }
  info["links"] = links(job, exchange);
  return info;
}

}  // namespace talus::service
