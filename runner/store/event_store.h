// What happened to a campaign, for good.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "runner/store/sqlite.h"

namespace peclet::runner {

class EventStore {
 public:
  // Requires a connection that may write, which must outlive it. write() is for use inside a Transaction of
  // the caller.
  explicit EventStore(Connection& connection) : connection_(connection) {}

  // `request`: the name of the request that caused it, "" when none did.
  void write(const std::string& kind, std::optional<std::int64_t> point, std::optional<int> seed,
             const std::string& message, const std::string& request = "");
  // Whether the request has been carried out, or refused.
  bool has_answered(const std::string& request);

 private:
  Connection& connection_;
};

}  // namespace peclet::runner
