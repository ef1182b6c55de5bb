// What people call the points of a sweep: "peclet=10 volume_fraction=0.5".
#pragma once

#include <string>
#include <vector>

#include "runner/campaign/sweep.h"

namespace peclet::runner {

class SweepLabels {
 public:
  // The sweep must outlive it.
  explicit SweepLabels(const std::vector<SweepEntry>& sweep);

  // Of the point made of rows[row_of_entry[e]] of every entry e.
  std::string of(const std::vector<std::size_t>& row_of_entry) const;

 private:
  const std::vector<SweepEntry>& sweep_;
  std::vector<std::vector<std::string>> names_;  // of the pointers of every entry
};

}  // namespace peclet::runner
