// Errors of both programs, and the exit codes with which they leave.
#pragma once

#include <cstddef>
#include <exception>
#include <stdexcept>
#include <string>

namespace peclet {

// A message is one line of at most so many characters, whatever was given.
constexpr std::size_t longest_message = 480;

// What is wrong with something that a person gave: the file, the JSON pointer inside it, the offending value
// and what is allowed instead. Programs print what() and leave with exit code 2; nothing has been written by
// then.
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

// What is stored, or what an engine says about it, is not what this program may go on with. Programs print
// what() and leave with exit code 6.
class IntegrityError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// How both programs leave.
struct ExitCode {
  enum : int {
    done = 0,  // of a run: every point converged, or has all its seeds
    error = 1,
    usage = 2,        // or faulty input; nothing has been written
    unconverged = 3,  // finished, but some points are capped, failed, cancelled or lost seeds
    unfinished = 4,   // of a request: asked for, and not carried out yet
    owned = 5,        // another process owns the campaign
    integrity = 6,    // the database is damaged, or a seed gave two different results
    stopped = 75,     // by a signal, a time limit or a budget; the same command goes on
  };
};

// Whether an error is about a name that no file can have, too long or a loop of links: only a person gives
// such names, so that it is one of usage.
bool is_impossible_name(const std::exception& error);

}  // namespace peclet
