// What the words of the page mean.
#include <map>

#include "runner/page/page_parts.h"

namespace peclet::runner {
namespace {

// What a mark of the table means; the marks are those of reservations() and the verdicts.
std::string meaning(const std::string& mark) {
  static const std::map<std::string, std::string> meanings{
      {"converged-with-losses",
       "the interval is within the tolerance, but the mean leaves out the seeds that were lost; if they were "
       "lost because of what they would have given, it is biased"},
      {"capped",
       "all seeds that are allowed have ended, and the interval is still wider than the tolerance, or "
       "there is none"},
      {"complete-with-losses",
       "all seeds that were asked for have ended, and the mean leaves out those that were lost; if they were "
       "lost because of what they would have given, it is biased"},
      {"failed", "too many seeds were lost to give an interval"},
      {"open", "not decided yet: the numbers are provisional"},
      {"cancelled", "somebody decided that it gets no more seeds: the numbers stay provisional"},
      {"jammed",
       "half of the seeds or more have jammed: the point has no viscosity, and under a given stress its rate "
       "is 0"},
      {"transient",
       "the beginning of the measured windows differs from their end: they begin before the equilibration is "
       "over, which more seeds do not mend"},
      {"no-transient-test",
       "the results have no blocks of the observable, so that nothing can tell whether the windows begin "
       "before the equilibration is over"},
      {"skewed",
       "some values are far from the rest on one side, and the interval holds the mean less often than it "
       "says"},
      {"near-maximum",
       "the interval is within the tolerance, but perhaps by luck: with a spread as large as the values "
       "leave "
       "open the point would need more seeds than are allowed, and intervals of such points hold the mean "
       "less "
       "often than they say"},
      {"equal-values",
       "all values are one and the same number, so that there is no spread to make an interval from"},
      {"repeated-seeds",
       "some seeds ended in the same state, so that their values are not independent and have no interval"},
      {"earlier-look",
       "the target was tighter before: the first look within the present one decides, as if there had been "
       "no "
       "other, and leaves out seeds that ended later"},
      {"suspect", "a seed gave two different results; no number of this point can be trusted"},
      {"flagged jammed", "seeds that stood still under the given stress; their rate 0 is part of the mean"},
      {"flagged patience", "seeds whose window is too short to tell whether they have jammed"},
      {"flagged timestep",
       "seeds whose time step made too much energy, changes the stress or was often divided"},
      {"flagged solver", "seeds whose implicit steps were solved too inaccurately"},
      {"flagged overlap",
       "seeds whose contacts overlapped by more than a thousandth of a radius in the mean"}};
  const auto known = meanings.find(mark);
  return known == meanings.end() ? "the engine's own mark; its warning says more" : known->second;
}

}  // namespace

Json page_meanings(const CampaignStatus& status) {
  Json meanings = Json::object();
  for (const PointSummary& point : status.points) {
    const std::string standing = standing_word(point);
    const bool explains_itself =
        standing == to_string(Verdict::converged) || standing == to_string(Verdict::complete);
    if (!explains_itself) meanings[standing] = meaning(standing);
    for (const std::string& mark : reservations(point)) {
      const std::string code = mark.substr(mark.rfind(' ') + 1);
      const std::string kind = code == mark ? mark : "flagged " + code;
      meanings[kind] = meaning(kind);
    }
  }
  return meanings;
}

}  // namespace peclet::runner
