#include "contract/input_error.h"

#include <utility>

namespace peclet {

namespace {

std::string joined(const std::string& file, const std::string& pointer, const std::string& value,
                   const std::string& allowed) {
  std::string message;
  for (const std::string* part : {&file, &pointer, &value, &allowed}) {
    if (part->empty()) continue;
    if (!message.empty()) message += ": ";
    message += *part;
  }
  return message;
}

}  // namespace

InputError::InputError(std::string file, std::string pointer, std::string value, std::string allowed)
    : std::runtime_error(joined(file, pointer, value, allowed)),
      file_(std::move(file)),
      pointer_(std::move(pointer)),
      value_(std::move(value)),
      allowed_(std::move(allowed)) {}

InputError InputError::within(const std::string& file, const std::string& prefix) const {
  return {file, prefix + pointer_, value_, allowed_};
}

}  // namespace peclet
