#include "runner/verbs/exit_code.h"

#include <filesystem>

#include "contract/exit_codes.h"
#include "contract/input_error.h"
#include "contract/integrity_error.h"
#include "contract/printable.h"
#include "runner/store/campaign_directory.h"
#include "runner/store/locks.h"

namespace peclet::runner {
int exit_code_of(const std::exception& error) {
  if (dynamic_cast<const InputError*>(&error) != nullptr || is_impossible_name(error)) return ExitCode::usage;
  if (dynamic_cast<const OwnedByAnother*>(&error) != nullptr) return ExitCode::owned;
  if (dynamic_cast<const IntegrityError*>(&error) != nullptr) return ExitCode::integrity;
  return ExitCode::error;
}

std::string message_of(const std::exception& error) {
  if (const auto* const fault = dynamic_cast<const std::filesystem::filesystem_error*>(&error)) {
    return InputError(fault->path1().string(), "", "", fault->code().message()).what();
  }
  return printable_lines(error.what());
}

}  // namespace peclet::runner
