// The output and exit code of a command in a shell.
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace peclet::runner {

struct Answer {
  int code = -1;
  std::string text;  // both outputs
};

inline Answer shell(const std::string& command) {
  FILE* const pipe = popen(("(" + command + ") 2>&1").c_str(), "r");
  Answer answer;
  std::array<char, 4096> chunk{};
  while (const std::size_t count = fread(chunk.data(), 1, chunk.size(), pipe))
    answer.text.append(chunk.data(), count);
  answer.code = WEXITSTATUS(pclose(pipe));
  return answer;
}

}  // namespace peclet::runner
