#include "runner/store/event_store.h"

#include "runner/text/utc_time.h"

namespace peclet::runner {

void EventStore::write(const std::string& kind, std::optional<std::int64_t> point, std::optional<int> seed,
                       const std::string& message, const std::string& request) {
  Statement(connection_,
            "INSERT INTO event (at, kind, point_id, seed, message, request) VALUES (?, ?, ?, ?, ?, ?)")
      .bind(utc_now())
      .bind(kind)
      .bind(point)
      .bind(seed)
      .bind(message)
      .bind(request.empty() ? std::nullopt : std::optional<std::string>(request))
      .run();
}

bool EventStore::has_answered(const std::string& request) {
  Statement query(connection_, "SELECT 1 FROM event WHERE request = ?");
  return query.bind(request).step();
}

}  // namespace peclet::runner
