// `peclet run --jsonl`: what happens in a run as JSON, one object a line, for programs that follow it.
//
// The run never waits for its reader: lines that it has not taken yet are kept here. When the reader is gone,
// cannot be written to, or leaves too much behind, that is said once and the run goes on without events.
#pragma once

#include <cstddef>
#include <string>

#include "contract/key_table.h"
#include "runner/owner/run_listener.h"

namespace peclet::runner {

// Keys of a line, by its "event".
const KindTables& event_keys();

// Without "at". Numbers that do not exist are null.
Json event_json(const RunEvent& event);
Json event_json(const RunReport& report);

class EventStream : public RunListener {
 public:
  // Writes to `descriptor`, and passes on to `audience` what is for people; it must outlive the stream. From
  // now on this process ignores SIGPIPE.
  EventStream(int descriptor, RunListener& audience);
  // Waits while the reader takes what is left, until it has taken nothing for ten seconds.
  ~EventStream() override;
  EventStream& operator=(EventStream&&) = delete;

  void note(const std::string& message) override { audience_.note(message); }
  void warn(const std::string& message) override { audience_.warn(message); }
  void happened(const RunEvent& event) override;
  void report(const RunReport& report) override;  // as an event once in five seconds

 private:
  void append(Json event);
  // Writes what the reader takes, until it has taken nothing for `patience` milliseconds.
  void write_out(int patience);
  void give_up(const std::string& why);

  int descriptor_;  // -1: given up
  RunListener& audience_;
  std::string waiting_;     // lines, of which the reader has
  std::size_t taken_ = 0;   // so many bytes already
  double next_report_ = 0;  // seconds of the run
};

}  // namespace peclet::runner
