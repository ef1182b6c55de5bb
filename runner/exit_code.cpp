#include "runner/exit_code.h"

#include "contract/input_error.h"
#include "runner/campaign_directory.h"
#include "runner/integrity_error.h"

namespace peclet::runner {

int exit_code_of(const std::exception& error) {
  if (dynamic_cast<const InputError*>(&error) != nullptr) return 2;
  if (dynamic_cast<const OwnedByAnother*>(&error) != nullptr) return 5;
  if (dynamic_cast<const IntegrityError*>(&error) != nullptr) return 6;
  return 1;
}

}  // namespace peclet::runner
