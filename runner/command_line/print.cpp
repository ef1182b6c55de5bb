#include "runner/command_line/print.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "contract/errors.h"
#include "contract/named_files.h"
#include "contract/text.h"
#include "runner/store/campaign_directory.h"
#include "runner/store/locks.h"

namespace peclet::runner {

void print(const std::string& text, const char* advice) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    throw std::system_error(errno, std::generic_category(), fmt::format("standard output{}", advice));
  }
}

void say(const std::string& text) { std::fputs(text.c_str(), stderr); }

void deliver(const std::string& text, const std::filesystem::path& output, bool quiet) {
  if (output.empty()) {
    print(text, " (the campaign is as it was; --output FILE writes a file whole or not at all)");
    return;
  }
  write_output(output, text);
  if (!quiet) say(fmt::format("peclet: {} is written, {} bytes\n", output.string(), text.size()));
}

int exit_code_of(const std::exception& error) {
  if (dynamic_cast<const InputError*>(&error) != nullptr || is_impossible_name(error)) return ExitCode::usage;
  if (dynamic_cast<const OwnedByAnother*>(&error) != nullptr) return ExitCode::owned;
  if (dynamic_cast<const IntegrityError*>(&error) != nullptr) return ExitCode::integrity;
  return ExitCode::error;
}

std::string message_of(const std::exception& error) {
  if (const auto* const fault = dynamic_cast<const std::filesystem::filesystem_error*>(&error)) {
    return InputError(fault->path1().string(), "", "", fault->code().message()).what();
  }
  return printable_lines(error.what());
}

OpenCampaign open_for_viewing(const std::filesystem::path& given, const std::filesystem::path& chosen) {
  OpenCampaign open = open_campaign(given, chosen);
  if (is_frozen_for_us(open.directory.database())) {
    say(fmt::format(
        "note: {} may not be written by you: it is read without locks, as if no process ran the campaign\n",
        open.directory.root().string()));
  }
  return open;
}

std::vector<OpenCampaign> open_beside(OpenCampaign& first, const std::vector<std::filesystem::path>& others) {
  std::vector<OpenCampaign> open;
  std::set<std::string> names{first.database.campaign().name};
  for (const std::filesystem::path& other : others) {
    open.push_back(open_for_viewing(other, ""));
    const std::string name = open.back().database.campaign().name;
    if (!names.insert(name).second)
      throw InputError("", "--with", name, "must be a campaign of another name: names tell the points apart");
  }
  return open;
}

}  // namespace peclet::runner
