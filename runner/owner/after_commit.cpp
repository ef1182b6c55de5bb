#include "runner/owner/after_commit.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "contract/durable_file.h"
#include "runner/store/campaign_directory.h"
#include "runner/store/spool.h"

namespace peclet::runner {

namespace {

template <typename T>
void append(std::vector<T>& list, std::vector<T>& later) {
  std::move(later.begin(), later.end(), std::back_inserter(list));
}

}  // namespace

void AfterCommit::add(AfterCommit&& later) {
  append(to_keep_, later.to_keep_);
  append(to_discard_, later.to_discard_);
  append(to_remove_, later.to_remove_);
  append(to_reject_, later.to_reject_);
  append(to_tell_, later.to_tell_);
}

void AfterCommit::carry_out(RunListener& listener, FileRemoval& removal) {
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
  removal.add(to_remove_);
  for (const std::filesystem::path& file : to_reject_) peclet::runner::reject(home_of_spool_file(file), file);
  for (const auto& told : std::exchange(*this, {}).to_tell_) {
    if (const auto* const note = std::get_if<Note>(&told)) listener.note(note->text);
    if (const auto* const warning = std::get_if<Warning>(&told)) listener.warn(warning->text);
    if (const auto* const event = std::get_if<RunEvent>(&told)) listener.happened(*event);
  }
}

}  // namespace peclet::runner
