// Exceptions of both programs, and their exit codes.
#pragma once

#include <cstddef>
#include <exception>
#include <stdexcept>
#include <string>

namespace peclet {

// Longest message of an InputError [characters]; longer ones are shortened.
constexpr std::size_t longest_message = 480;

// A fault in what a person gave: the file, the JSON pointer inside it, the offending value and what is
// allowed. Programs print what() and leave with exit code 2; nothing has been written by then.
//
// The constructor makes the parts printable and short (text.h). Callers pass them unchanged.
class InputError : public std::runtime_error {
 public:
  // Any of the four may be empty and is then left out of the message:
  // "FILE: POINTER: VALUE: ALLOWED", for example
  // "scene.json: /fluid/viscosity: -1: must be a number > 0".
  InputError(const std::string& file, const std::string& pointer, const std::string& value,
             const std::string& allowed);

  // The parts of the message, printable and shortened.
  struct Parts {
    std::string file, pointer, value, allowed;
  };
  const std::string& file() const { return parts_.file; }
  const std::string& pointer() const { return parts_.pointer; }
  const std::string& value() const { return parts_.value; }
  const std::string& allowed() const { return parts_.allowed; }

  // Returns this fault for a `file` that embeds the document at the JSON pointer `prefix`.
  InputError within(const std::string& file, const std::string& prefix) const;

 private:
  explicit InputError(Parts parts);

  Parts parts_;
};

// Stored data, or an engine's answer about them, are damaged or inconsistent. Programs leave with code 6.
class IntegrityError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Exit codes of both programs.
struct ExitCode {
  enum : int {
    done = 0,  // success; for a run: every point converged, or has all its seeds
    error = 1,
    usage = 2,        // faulty command line or input; nothing has been written
    unconverged = 3,  // finished, but some points are capped, failed, cancelled or lost seeds
    unfinished = 4,   // a request was made and has not been carried out yet
    owned = 5,        // another process owns the campaign
    integrity = 6,    // the database is damaged, or a seed gave two different results
    stopped = 75,     // stopped by a signal, a time limit or a budget; the same command continues
  };
};

// Returns true if the error is about a name that is too long or a loop of links. Only users give such names,
// so that it is an error of usage.
bool is_impossible_name(const std::exception& error);

}  // namespace peclet
