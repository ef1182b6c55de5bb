// Tests of what runs Python.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace peclet {

// Puts Debian's python3, which has NumPy and SciPy, first in PATH.
class PythonOfDebian : public testing::Test {
 protected:
  PythonOfDebian() {
    setenv("PATH", ("/usr/bin:" + path_).c_str(), 1);  // NOLINT(concurrency-mt-unsafe): there is one thread
  }
  ~PythonOfDebian() override { setenv("PATH", path_.c_str(), 1); }  // NOLINT(concurrency-mt-unsafe)

 private:
  const std::string path_ = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe)
};

}  // namespace peclet
