#include "contract/nearest_name.h"

#include <algorithm>
#include <cstddef>

namespace peclet {
namespace {

// Optimal string alignment: Levenshtein's distance with neighbouring letters that are swapped as one mistake.
std::size_t mistakes_between(std::string_view one, std::string_view other) {
  std::vector<std::size_t> before_last, last(other.size() + 1), now(other.size() + 1);
  for (std::size_t j = 0; j <= other.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= one.size(); ++i) {
    now[0] = i;
    for (std::size_t j = 1; j <= other.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (one[i - 1] == other[j - 1] ? 0 : 1);
      now[j] = std::min({replaced, last[j] + 1, now[j - 1] + 1});
      const bool swapped = i > 1 && j > 1 && one[i - 1] == other[j - 2] && one[i - 2] == other[j - 1];
      if (swapped) now[j] = std::min(now[j], before_last[j - 2] + 1);
    }
    before_last = last;
    last = now;
  }
  return last[other.size()];
}

}  // namespace

std::string nearest_name(std::string_view typed, const std::vector<std::string>& names) {
  std::string nearest;
  std::size_t fewest = 0;
  for (const std::string& name : names) {
    const std::size_t most = std::max<std::size_t>(1, name.size() / 3);
    // Each letter more or less is a mistake: nobody need count those of a name that is far too long.
    const auto [shorter, longer] = std::minmax({typed.size(), name.size()});
    if (longer - shorter > most) continue;
    const std::size_t mistakes = mistakes_between(typed, name);
    if (mistakes > most || (!nearest.empty() && mistakes >= fewest)) continue;
    nearest = name;
    fewest = mistakes;
  }
  return nearest;
}

std::string suggestion(std::string_view typed, const std::vector<std::string>& names) {
  const std::string nearest = nearest_name(typed, names);
  return nearest.empty() ? "" : "; did you mean " + nearest + "?";
}

}  // namespace peclet
