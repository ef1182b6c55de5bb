#include "runner/owner/booked_worker.h"

#include <algorithm>
#include <utility>

namespace peclet::runner {

Assignment* BookedWorker::find(std::int64_t job) {
  const auto known = std::ranges::find(running, job, &Assignment::job);
  return known == running.end() ? nullptr : &*known;
}

bool BookedWorker::has_finished(std::int64_t job) const {
  return std::ranges::find(finished, job) != finished.end();
}

void BookedWorker::begin(Assignment about, Awake now) {
  watch.begin_job(about.job(), now);
  running.push_back(std::move(about));
}

void BookedWorker::end(std::int64_t job, Awake now, Assignment::Time time) {
  if (std::ssize(finished) == capacity) finished.erase(finished.begin());
  finished.push_back(job);
  watch.end_job(job);
  std::erase_if(running, [&](const Assignment& about) { return about.job() == job; });
  if (!waiting) return;
  waiting->begun = time;
  begin(*std::exchange(waiting, std::nullopt), now);
}

Company BookedWorker::company() const {
  Company company{capacity, {}};
  for (const Assignment& about : running)
    company.seeds.push_back({about.given_seed.point_id, about.given_seed.id.seed});
  // A job that waits takes the place of another one.
  if (!has_place()) company.seeds.pop_back();
  return company;
}

void BookedWorker::mark_lost_folders() {
  for (Assignment& about : running) about.lost_a_folder = true;
  if (waiting) waiting->lost_a_folder = true;
}

}  // namespace peclet::runner
