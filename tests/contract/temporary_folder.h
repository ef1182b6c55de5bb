// A folder that belongs to one test and is removed with it.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <string>

namespace peclet {

class TemporaryFolder : public testing::Test {
 protected:
  TemporaryFolder() : folder_(make()) {}
  ~TemporaryFolder() override { std::filesystem::remove_all(folder_); }
  std::size_t entries() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder_), std::filesystem::directory_iterator()));
  }
  const std::filesystem::path& folder() const { return folder_; }

 private:
  static std::filesystem::path make() {
    std::string pattern = (std::filesystem::temp_directory_path() / "contract_XXXXXX").string();
    return ::mkdtemp(pattern.data());
  }
  std::filesystem::path folder_;
};

}  // namespace peclet
