// Are the seeds that a batch system has where somebody can find them again?
#include <fmt/format.h>

#include "runner/batch/bundle_files.h"
#include "runner/care/doctor.h"
#include "runner/store/bundle_store.h"

namespace peclet::runner {

void examine_hand_over(Database& database, const CampaignUnderExamination& examined, Findings& findings) {
  for (const HandedOver& bundle : BundleStore(database.connection()).handed_over()) {
    std::string why;
    if (!is_there(BundleFolder(bundle.shared, bundle.bundle), why)) {
      findings.push_back(
          {"bundle-stranded", Severity::warning,
           fmt::format("{} seeds are out in the bundle {}, and {}", bundle.seeds, bundle.bundle, why),
           fmt::format(
               "put it back, and `peclet ingest` takes in what it holds; if it is gone for good, `peclet "
               "ingest --forget {}` queues them again",
               bundle.bundle)});
    } else if (bundle.job.empty() && !examined.owner) {  // an owner is just about to know
      findings.push_back(
          {"bundle-unconfirmed", Severity::warning,
           fmt::format(
               "{} seeds are out in the bundle {}, and whether the batch system has taken its job is unknown",
               bundle.seeds, bundle.bundle),
           fmt::format(
               "`peclet ingest` asks for it by its name, `peclet hand-over` submits it again; `peclet ingest "
               "--forget {}` queues them again without an answer",
               bundle.bundle)});
    }
  }
}

}  // namespace peclet::runner
