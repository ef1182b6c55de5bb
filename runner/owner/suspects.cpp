#include "runner/owner/suspects.h"

#include <algorithm>

namespace peclet::runner {
namespace {

bool admits(const Company& company, int halvings) {
  return largest_company(company.capacity, halvings) > static_cast<int>(company.seeds.size());
}

}  // namespace

void Suspects::read(SeedStore& seeds) {
  if (halvings_) return;
  halvings_.emplace();
  for (const KnownSeed& seed : seeds.seeds_with_deaths()) note(seed, seeds.history(seed.point, seed.seed));
}

void Suspects::note(KnownSeed seed, const std::vector<PastAttempt>& attempts) {
  if (const int number = halvings(attempts); halvings_ && number > 0) (*halvings_)[seed] = number;
}

void Suspects::acquit(KnownSeed seed) {
  if (halvings_) halvings_->erase(seed);
}

bool Suspects::may_grow(const Company& company) const {
  return admits(company, 0) && std::ranges::none_of(company.seeds, [&](const KnownSeed& seed) {
           return contains(seed) && !admits(company, halvings_->at(seed));
         });
}

std::optional<KnownSeed> Suspects::next_for(const Company& company,
                                            const std::function<bool(KnownSeed)>& may_run) const {
  std::optional<KnownSeed> chosen;
  if (!any()) return chosen;
  int most = 0;
  for (const auto& [seed, number] : *halvings_) {
    if (number <= most || !admits(company, number) || !may_run(seed)) continue;
    chosen = seed;
    most = number;
  }
  return chosen;
}

}  // namespace peclet::runner
