// What the campaign has cost and is expected to cost, and who works on it.
#include "runner/page/page_parts.h"

namespace peclet::runner {

Json page_progress(const CampaignStatus& status) {
  int decided = 0, ended = 0, lost = 0, surplus = 0, running = 0;
  std::size_t workers = 0;
  double cpu_seconds = 0;
  std::map<std::string, int> standings;
  for (const PointSummary& point : status.points) {
    ++standings[standing_word(point)];
    decided += point.decided ? 1 : 0;
    ended += point.counts.terminal();
    lost += point.lost();
    surplus += point.surplus();
    running += point.counts.running;
    workers += point.leases.size();
    cpu_seconds += point.counts.cpu_seconds;
  }
  int handed_over = 0;
  for (const HandedOver& bundle : status.handed_over) handed_over += bundle.seeds;
  return {{"points", status.points.size()},
          {"decided", decided},
          {"standings", standings},
          {"check", standing(status)},
          {"seeds",
           {{"ended", ended},
            {"lost", lost},
            {"surplus", surplus},
            {"running", running},
            {"handed_over", handed_over}}},
          {"cpu_seconds", cpu_seconds},
          {"seconds_to_go", to_json(status.to_go)},
          {"owner", status.owner ? Json(*status.owner) : Json(nullptr)},
          {"workers", status.owner ? Json(workers) : Json(nullptr)}};
}

}  // namespace peclet::runner
