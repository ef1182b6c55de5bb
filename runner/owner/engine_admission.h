// Which engine a run uses: one for the whole of it, and never two at one point.
#pragma once

#include <string>

#include "contract/errors.h"
#include "contract/json.h"
#include "runner/owner/board.h"

namespace peclet::runner {

// Points with results of one engine are to be run with another. what() names both.
class OtherEngine : public IntegrityError {
 public:
  using IntegrityError::IntegrityError;
};

class EngineAdmission {
 public:
  // The engine that says this of itself runs from now on. Throws OtherEngine when a point that is still to be
  // run has results of another one, IntegrityError when this run has begun with another one or when it does
  // not say what it is.
  void admit(const Json& engine, const Board& board);
  // Throws OtherEngine as admit(), of the engine that runs.
  void require_no_other(const Board& board) const;

  bool has_engine() const { return !identity_.empty(); }
  const std::string& identity() const { return identity_; }

 private:
  std::string identity_;
};

}  // namespace peclet::runner
