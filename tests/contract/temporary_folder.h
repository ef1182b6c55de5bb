// A folder that belongs to one test and is removed with it.
#pragma once

#include <gtest/gtest.h>

#include <iterator>

#include "tests/engine/temporary_folder.h"

namespace peclet {

class FolderOfTest : public testing::Test {
 protected:
  std::size_t entries() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder()), std::filesystem::directory_iterator()));
  }
  const std::filesystem::path& folder() const { return folder_.path(); }

 private:
  const TemporaryFolder folder_;
};

}  // namespace peclet
