// EventStream writes what happens in a run as JSON, one object a line (`peclet run --jsonl`).
//
// The run never waits for the reader: lines that it has not taken are kept in memory. If the reader is gone,
// cannot be written to, or leaves too much behind, one warning is given and the run continues without events.
#pragma once

#include <cstddef>
#include <string>

#include "contract/key_table.h"
#include "runner/owner/run_listener.h"

namespace peclet::runner {

// Returns the keys of a line, by its "event".
const KindTables& event_keys();

// Returns the line without "at". Undefined numbers are null.
Json event_json(const RunEvent& event);
Json event_json(const RunReport& report);

class EventStream : public RunListener {
 public:
  // Writes to `descriptor`, and passes messages for people on to `audience`, which must outlive the stream.
  // From now on this process ignores SIGPIPE.
  EventStream(int descriptor, RunListener& audience);
  // Writes what is left, unless the reader takes nothing for ten seconds.
  ~EventStream() override;
  EventStream& operator=(EventStream&&) = delete;

  void note(const std::string& message) override { audience_.note(message); }
  void warn(const std::string& message) override { audience_.warn(message); }
  void happened(const RunEvent& event) override;
  void report(const RunReport& report) override;  // writes an event once in five seconds

 private:
  void append(Json event);
  // Writes until the reader takes nothing for `patience` [ms].
  void write_out(int patience);
  void give_up(const std::string& why);

  int descriptor_;  // -1 after giving up
  RunListener& audience_;
  std::string waiting_;     // lines, of which the reader has the first bytes
  std::size_t taken_ = 0;   // number of these bytes
  double next_report_ = 0;  // time of the run [s] at which a report is due
};

}  // namespace peclet::runner
