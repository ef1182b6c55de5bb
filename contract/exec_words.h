// Words of a command as exec(3) takes them.
#pragma once

#include <string>
#include <vector>

namespace peclet {

// Returns pointers to the words and a null pointer at the end; valid as long as `words`.
inline std::vector<char*> exec_words(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

}  // namespace peclet
