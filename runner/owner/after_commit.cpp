#include "runner/owner/after_commit.h"

#include <utility>

#include "contract/durable_file.h"
#include "runner/store/campaign_directory.h"
#include "runner/store/intruders.h"
#include "runner/store/spool.h"

namespace peclet::runner {

AfterCommit::Mark AfterCommit::mark() const {
  return {to_keep_.size(), to_discard_.size(), to_remove_.size(), to_reject_.size(), to_tell_.size()};
}

void AfterCommit::back_to(const Mark& mark) {
  to_keep_.resize(mark.keep);
  to_discard_.resize(mark.discard);
  to_remove_.resize(mark.remove);
  to_reject_.resize(mark.reject);
  to_tell_.erase(to_tell_.begin() + static_cast<std::ptrdiff_t>(mark.tell), to_tell_.end());
}

void AfterCommit::carry_out(RunListener& listener) {
  committed_ = mark();
  const auto make_way_for_file = [&listener](const std::filesystem::path& path) {
    if (const std::string text = make_way(path, "a regular file"); !text.empty()) listener.warn(text);
  };
  for (const auto& [from, place] : to_keep_) {
    // `peclet doctor` names one that somebody has taken away meanwhile.
    if (!is_there(from)) continue;
    make_way_for_file(place);
    rename_durably(from, place);
  }
  for (const std::filesystem::path& checkpoint : to_discard_) {
    for (const std::filesystem::path& file : {checkpoint, growing_beside(checkpoint)}) {
      make_way_for_file(file);
      std::filesystem::remove(file);
    }
  }
  removal_.add(to_remove_);
  for (const std::filesystem::path& file : to_reject_) peclet::runner::reject(home_of_spool_file(file), file);
  to_keep_.clear();
  to_discard_.clear();
  to_remove_.clear();
  to_reject_.clear();
  committed_ = {};
  for (const auto& told : std::exchange(to_tell_, {})) {
    if (const auto* const note = std::get_if<Note>(&told)) listener.note(note->text);
    if (const auto* const warning = std::get_if<Warning>(&told)) listener.warn(warning->text);
    if (const auto* const event = std::get_if<RunEvent>(&told)) listener.happened(*event);
  }
}

}  // namespace peclet::runner
