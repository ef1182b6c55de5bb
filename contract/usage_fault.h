// What is wrong with a command line, said once and with what to do: the parser's own words name no verb.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace peclet {

// The verb that the words, those after the program's name, begin with; null when there is none of that name.
const CLI::App* verb_called(const CLI::App& app, const std::vector<std::string>& words);

// One line without the program's name: "run: --wrokers: there is no such option; ...". The app has the
// program's name.
std::string usage_fault(const CLI::App& app, const std::vector<std::string>& words,
                        const CLI::ParseError& fault);

}  // namespace peclet
