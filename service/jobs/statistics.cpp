#include "jobs/statistics.hpp"

#include "study/publish.hpp"

namespace talus::service {

StudySummary publish_study(Store& store, const Job& job, const Plan& plan, const StudyPaths& paths) {
  const auto records = [&](bool floor) {
    return [&store, &job, floor](const RecordSink& take) { store.for_each_record(job.number, floor, take); };
  };
  return publish(paths, plan, records(false), records(true));
}

}  // namespace talus::service
