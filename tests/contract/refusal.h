// Messages of expected exceptions, and the words that they must have.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "contract/errors.h"

namespace peclet {

// Returns the message of the Error that `work` throws, or nothing if it throws none.
template <class Error = InputError, class Work>
std::string refusal_by(Work&& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

// True if `text` has `part`; a failure shows both.
inline testing::AssertionResult contains(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << '"' << text << "\" has not \"" << part << '"';
}

}  // namespace peclet
