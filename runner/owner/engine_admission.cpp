#include "runner/owner/engine_admission.h"

#include <fmt/format.h>

#include "runner/store/realisation_result.h"

namespace peclet::runner {
namespace {

void refuse_other(const Board& board, const std::string& identity) {
  for (const PointRecord& about : board.points()) {
    if (board.is_to_be_run(about) && !about.engine_identity.empty() && about.engine_identity != identity) {
      throw OtherEngine(
          fmt::format("{}: has results of engine {}, but the engine now is {}; one point never mixes two",
                      about.label, about.engine_identity, identity));
    }
  }
}

}  // namespace

void EngineAdmission::admit(const Json& engine, const Board& board) {
  std::string identity;
  try {
    identity = engine_identity(engine);
  } catch (const ResultError& error) {
    throw IntegrityError(fmt::format("the engine's hello does not say what it is: {}", error.what()));
  }
  if (has_engine() && identity_ != identity) {
    throw IntegrityError(fmt::format("the engine changed while the campaign ran: it was {}, now it is {}",
                                     identity_, identity));
  }
  refuse_other(board, identity);
  identity_ = identity;
}

void EngineAdmission::require_no_other(const Board& board) const {
  if (has_engine()) refuse_other(board, identity_);
}

}  // namespace peclet::runner
