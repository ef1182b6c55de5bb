#include "runner/command_line/print.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

#include "contract/output_file.h"

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

}  // namespace peclet::runner
