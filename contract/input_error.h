// What is wrong with something that a person gave us, said once and completely.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace peclet {

// A message is one line of at most so many characters, whatever was given.
constexpr std::size_t longest_message = 480;

// Carries the file, the JSON pointer inside it, the offending value and what is allowed instead.
// Programs print what() and leave with exit code 2; nothing has been written by then.
//
// Here, and nowhere else, what is quoted becomes printable and short (printable.h): whoever throws hands over
// what was given, as it is.
class InputError : public std::runtime_error {
 public:
  // Any of the four may be empty and is then left out of the message:
  // "FILE: POINTER: VALUE: ALLOWED", for example
  // "scene.json: /fluid/viscosity: -1: must be a number > 0".
  InputError(const std::string& file, const std::string& pointer, const std::string& value,
             const std::string& allowed);

  // As they stand in the message.
  struct Parts {
    std::string file, pointer, value, allowed;
  };
  const std::string& file() const { return parts_.file; }
  const std::string& pointer() const { return parts_.pointer; }
  const std::string& value() const { return parts_.value; }
  const std::string& allowed() const { return parts_.allowed; }

  // The same fault seen from a document that embeds the first one: `prefix` is put before the pointer.
  InputError within(const std::string& file, const std::string& prefix) const;

 private:
  explicit InputError(Parts parts);

  Parts parts_;
};

}  // namespace peclet
