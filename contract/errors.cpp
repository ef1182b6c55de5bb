#include "contract/errors.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "contract/text.h"

namespace peclet {
namespace {

// Longest quoted parts of a message [characters]. The text of what is allowed gets the rest of the message.
constexpr std::size_t longest_file = 160, longest_pointer = 100, longest_value = 60;
constexpr std::size_t separators = 6;  // three times ": "

// Shortens `allowed` to what is left of a message whose other parts have `used` characters.
std::string fitting(const std::string& allowed, std::size_t used) {
  constexpr std::size_t least = longest_message - longest_file - longest_pointer - longest_value - separators;
  return printable(
      allowed, std::max(least, longest_message - separators - std::min(used, longest_message - separators)));
}

std::string joined(const InputError::Parts& parts) {
  std::string message;
  for (const std::string* part : {&parts.file, &parts.pointer, &parts.value, &parts.allowed}) {
    if (part->empty()) continue;
    if (!message.empty()) message += ": ";
    message += *part;
  }
  return message;
}

InputError::Parts shown(const InputError::Parts& given) {
  InputError::Parts parts{printable(given.file, longest_file), printable(given.pointer, longest_pointer),
                          printable(given.value, longest_value), ""};
  parts.allowed = fitting(given.allowed, parts.file.size() + parts.pointer.size() + parts.value.size());
  return parts;
}

}  // namespace

InputError::InputError(const std::string& file, const std::string& pointer, const std::string& value,
                       const std::string& allowed)
    : InputError(shown({file, pointer, value, allowed})) {}

InputError::InputError(Parts parts) : std::runtime_error(joined(parts)), parts_(std::move(parts)) {}

InputError InputError::within(const std::string& file, const std::string& prefix) const {
  return {file, prefix + parts_.pointer, parts_.value, parts_.allowed};
}

bool is_impossible_name(const std::exception& error) {
  const auto* const fault = dynamic_cast<const std::system_error*>(&error);
  return fault != nullptr && (fault->code() == std::errc::too_many_symbolic_link_levels ||
                              fault->code() == std::errc::filename_too_long);
}

}  // namespace peclet
