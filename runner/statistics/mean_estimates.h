// Mean and standard error over seeds of everything that results have in their "mean".
#pragma once

#include <map>
#include <string>
#include <vector>

#include "contract/json.h"

namespace peclet::runner {

class MeanEstimates {
 public:
  // The "mean" of one more result, in order of the seeds; null (a lost seed) has nothing to add.
  void add(const Json& mean);

  // {"/stress/total/3": {"count", "mean", "standard_error"}, ...}: by JSON pointer into "mean". The standard
  // error of a single value is null.
  Json estimates() const;

 private:
  std::map<std::string, std::vector<double>> values_;
};

}  // namespace peclet::runner
