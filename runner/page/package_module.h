// Modules of the Python package peclet, which run as a child process.
#pragma once

#include <optional>
#include <string>

#include "contract/json.h"

namespace peclet::runner {

// Gives `document` to the module of the package, by python/peclet/answer.py, and returns its answer. The
// package is the one that was installed with this program, or that of its source; without both the one that
// Python finds. Throws std::runtime_error, which begins with `verb` and names `modules`, such as "NumPy
// (Debian: python3-numpy)", if python3 or one of them is missing. Throws InputError for the answer
// {"refused": [place, value, rule]}; `file` is the file of the place.
Json answer_of_package(const std::string& verb, const std::string& module, const std::string& modules,
                       const Json& document, const std::string& file = "");

// Returns the number for a document, or null.
Json json_or_null(const std::optional<double>& number);

}  // namespace peclet::runner
