#include "runner/owner/event_stream.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstring>
#include <utility>

#include "runner/campaign/number_text.h"
#include "runner/statistics/cohorts.h"

namespace peclet::runner {
namespace {

constexpr int schema_version = 1;
constexpr double seconds_between_reports = 5;
constexpr std::size_t most_waiting = 16 << 20;
constexpr std::size_t most_taken = 1 << 20;  // bytes that are kept although the reader has them
constexpr int last_patience = 10'000;        // milliseconds

Json point_json(const PointName& point) { return {{"label", point.label}, {"hash", point.hash}}; }

Json optional(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json json_of(const RunBegan& event) {
  return {{"event", "begin"},         {"campaign", event.campaign}, {"directory", event.directory.string()},
          {"process", event.process}, {"points", event.points},     {"workers", event.workers},
          {"threads", event.threads}};
}

Json json_of(const SeedEnded& event) {
  return {{"event", "seed-ended"},
          {"point", point_json(event.point)},
          {"seed", event.seed},
          {"cause", event.cause},
          {"value", optional(event.value)},
          {"cpu_seconds", optional(event.cpu_seconds)}};
}

Json json_of(const AttemptFailed& event) {
  return {{"event", "attempt-failed"}, {"point", point_json(event.point)},
          {"seed", event.seed},        {"outcome", to_string(event.outcome)},
          {"blamed", event.blamed},    {"given_up", event.given_up},
          {"message", event.message}};
}

Json json_of(const StopTestMade& event) {
  return {{"event", "stop_test"},
          {"point", point_json(event.point)},
          {"stop_test", stop_test_json(event.stop_test)}};
}

Json json_of(const Decided& event) {
  return {{"event", "decided"},
          {"point", point_json(event.point)},
          {"verdict", to_string(event.stop_test.verdict)},
          {"stop_test", stop_test_json(event.stop_test)}};
}

Json json_of(const ValueChosen& event) {
  return {{"event", "value-chosen"},
          {"axis", event.axis},
          {"value", event.value},
          {"observable", event.observable},
          {"width", event.width}};
}

Json json_of(const ShortageBegan& event) {
  return {{"event", "shortage-begins"}, {"message", event.message}};
}

Json json_of(const ShortageEnded&) { return {{"event", "shortage-ends"}}; }

Json json_of(const RunEnded& event) {
  return {{"event", "end"},
          {"exit_code", event.exit_code},
          {"message", event.message.empty() ? Json(nullptr) : Json(event.message)}};
}

// {point} stands for the rows of a point, {stop_test} for those of a stop test.
constexpr const char* event_rows = R"(
/at | string | UTC, as 2026-11-27T07:31:15Z.
/schema_version | integer = 1

-- begin | The first line.
/campaign, /directory | string
/process, /points, /workers, /threads | count

-- progress | How far the run is, once in five seconds.
/points, /decided, /converged, /seeds_ended, /seeds_wanted, /workers, /busy, /results | count
/elapsed_seconds | number
/seconds_to_go | object or null
/seconds_to_go/low, /seconds_to_go/likely, /seconds_to_go/high | number

-- seed-ended | A seed has ended, with a value or without.
{point}
/seed | count
/cause | string
/value, /cpu_seconds | number or null

-- attempt-failed | An attempt gave no result; the seed is tried again unless it is given up.
{point}
/seed | count
/outcome | one of crashed, hung, garbled, refused, drained, killed, abandoned
/blamed, /given_up | true or false
/message | string

-- stop_test | A stop test was made.
{point}
{stop_test}

-- decided | The point needs no more seeds.
{point}
/verdict | one of converged, converged-with-losses, capped, failed, complete, complete-with-losses
{stop_test}

-- value-chosen | The run has added a value of the axis of its curves (/choose in a campaign), because seeds there
    narrow the widest band most; width is that of the band.
/axis, /observable | string
/value, /width | number

-- shortage-begins | The run pauses: a disk or quota is full or fails, or another program has locked the
    database. May come again, for another hindrance, before shortage-ends.
/message | string

-- shortage-ends | The run continues.

-- end | The last line.
/exit_code | count
/message | string or null
)";

constexpr const char* point_rows = R"(
/point | object
/point/hash | hash
/point/label | string
)";

constexpr const char* stop_test_rows = R"(
/stop_test | object | As in the export.
/stop_test/count, /stop_test/seeds, /stop_test/lost | count
/stop_test/mean, /stop_test/standard_error, /stop_test/half_width, /stop_test/skewness | number or null
/stop_test/transient | true or false or null
/stop_test/near_maximum | true or false
/stop_test/repeated_seeds | array
/stop_test/repeated_seeds/* | count
/stop_test/verdict | one of more, converged, converged-with-losses, capped, failed, complete, complete-with-losses
/stop_test/observables? | array | If there are several.
/stop_test/plain | object
/stop_test/plain/count | count
/stop_test/plain/mean, /stop_test/plain/standard_error, /stop_test/plain/half_width | number or null
)";

}  // namespace

const KindTables& event_keys() {
  static const KindTables tables(
      "One line of peclet run --jsonl", "event",
      fmt::format(event_rows, fmt::arg("point", point_rows), fmt::arg("stop_test", stop_test_rows)));
  return tables;
}

Json event_json(const RunEvent& event) {
  Json json = std::visit([](const auto& happened) { return json_of(happened); }, event);
  json["schema_version"] = schema_version;
  return json;
}

Json event_json(const RunReport& report) {
  return {{"event", "progress"},
          {"schema_version", schema_version},
          {"points", report.points},
          {"decided", report.decided},
          {"converged", report.converged},
          {"seeds_ended", report.seeds_ended},
          {"seeds_wanted", report.seeds_wanted},
          {"workers", report.workers},
          {"busy", report.busy},
          {"results", report.results},
          {"elapsed_seconds", report.elapsed},
          {"seconds_to_go", to_json(report.to_go)}};
}

EventStream::EventStream(int descriptor, RunListener& audience)
    : descriptor_(descriptor), audience_(audience) {
  std::signal(SIGPIPE, SIG_IGN);
}

EventStream::~EventStream() {
  write_out(last_patience);
  if (!waiting_.empty()) give_up("their reader does not take them");
}

void EventStream::happened(const RunEvent& event) {
  append(event_json(event));
  audience_.happened(event);
}

void EventStream::report(const RunReport& report) {
  if (report.elapsed >= next_report_) {
    append(event_json(report));
    next_report_ = report.elapsed + seconds_between_reports;
  } else {
    write_out(0);
  }
  audience_.report(report);
}

void EventStream::append(Json event) {
  if (descriptor_ < 0) return;
  event["at"] = utc_now();
  // Messages of engines need not be valid UTF-8.
  waiting_ += event.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
  write_out(0);
  if (waiting_.size() - taken_ > most_waiting) give_up("their reader does not take them");
}

// A pipe that is ready takes PIPE_BUF bytes at once, so that no write() waits.
void EventStream::write_out(int patience) {
  while (descriptor_ >= 0 && !waiting_.empty()) {
    pollfd ready{descriptor_, POLLOUT, 0};
    const int count = poll(&ready, 1, patience);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return;
    const std::size_t length = std::min<std::size_t>(waiting_.size() - taken_, PIPE_BUF);
    const ssize_t written = write(descriptor_, waiting_.data() + taken_, length);
    if (written >= 0) {
      taken_ += static_cast<std::size_t>(written);
      if (taken_ == waiting_.size() || taken_ > most_taken) waiting_.erase(0, std::exchange(taken_, 0));
    } else if (errno != EINTR && errno != EAGAIN) {
      give_up(std::strerror(errno));
    }
  }
}

void EventStream::give_up(const std::string& why) {
  descriptor_ = -1;
  waiting_.clear();
  taken_ = 0;
  audience_.warn(fmt::format("events can no longer be written ({}): the run continues without them", why));
}

}  // namespace peclet::runner
