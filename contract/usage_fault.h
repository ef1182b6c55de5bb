// Describes faults of a command line: the verb, the fault, what to do. The parser's own text lacks the verb.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace peclet {

// Returns the verb that the words after the program's name begin with, or null.
const CLI::App* verb_called(const CLI::App& app, const std::vector<std::string>& words);

// Returns one line, "run: --wrokers: there is no such option; ...". The name of `app` must be the program's.
std::string usage_fault(const CLI::App& app, const std::vector<std::string>& words,
                        const CLI::ParseError& fault);

}  // namespace peclet
