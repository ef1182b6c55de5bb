#include "contract/exit_codes.h"

#include <system_error>

namespace peclet {

bool is_impossible_name(const std::exception& error) {
  const auto* const fault = dynamic_cast<const std::system_error*>(&error);
  return fault != nullptr && (fault->code() == std::errc::too_many_symbolic_link_levels ||
                              fault->code() == std::errc::filename_too_long);
}

}  // namespace peclet
