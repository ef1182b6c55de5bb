// What is wrong with something that a person gave us, said once and completely.
#pragma once

#include <stdexcept>
#include <string>

namespace peclet {

// Carries the file, the JSON pointer inside it, the offending value and what is allowed instead.
// Programs print what() and leave with exit code 2; nothing has been written by then.
class InputError : public std::runtime_error {
 public:
  // Any of the four may be empty and is then left out of the message:
  // "FILE: POINTER: VALUE: ALLOWED", for example
  // "scene.json: /fluid/viscosity: -1: must be a number > 0".
  InputError(std::string file, std::string pointer, std::string value, std::string allowed);

  const std::string& file() const { return file_; }
  const std::string& pointer() const { return pointer_; }
  const std::string& value() const { return value_; }
  const std::string& allowed() const { return allowed_; }

  // The same fault seen from a document that embeds the first one: `prefix` is put before the pointer.
  InputError within(const std::string& file, const std::string& prefix) const;

 private:
  std::string file_, pointer_, value_, allowed_;
};

}  // namespace peclet
