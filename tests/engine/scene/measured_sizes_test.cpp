// Tables of sizes as instruments, spreadsheets and people save them.
#include "engine/scene/measured_sizes.h"

#include <gtest/gtest.h>

#include "contract/errors.h"

namespace peclet::engine {
namespace {

std::string text_of(const std::vector<MeasuredSize>& sizes) {
  std::string text;
  for (const MeasuredSize& one : sizes)
    text += std::to_string(one.size).substr(0, 4) + " " + std::to_string(one.share).substr(0, 4) + "; ";
  return text;
}

TEST(MeasuredSizes, AreReadInEveryDialect) {
  for (const char* text : {
           "1.0 10\n1.4 20\n",
           "1.4 20\n1.0 10",  // descending
           "\xef\xbb\xbf"
           "1.0 10\r\n1.4 20\r\n\r\n",
           "Size;Share\n1,0;10\n1,4;20\n",  // a spreadsheet with decimal commas
           "\"1,0\";\"10\"\n\"1,4\";\"20\"",
           "Instrument 7\nSample: No. 3\nd [um]\tq3 [%]\n\n1,0\t10\n1,4\t20\n", "1.0,10\n1.4,20\n",
           "1.0, 10\n1.4, 20\n", "1.0;10;\n1.4;20;\n", "+1,0 10\n1,4 +20,0\n",
           "0.9 0\n1.0 10\n1.4 20\n1.6 0\n",  // empty classes
       }) {
    EXPECT_EQ(text_of(measured_sizes(text, "s.txt")), "1.00 10.0; 1.40 20.0; ") << text;
  }
  EXPECT_EQ(text_of(measured_sizes("a;b;c\n5;1;10\n15;1,4;20", "s.txt", {2, 3})), "1.00 10.0; 1.40 20.0; ");
}

TEST(MeasuredSizes, ThatAreNotPlainAreRefused) {
  for (const auto& [text, reason] : std::vector<std::pair<std::string, std::string>>{
           {"", "s.txt: must have a line of a size and its share"},
           {"size share\n", "must have a line of a size"},
           {"1 0\n2 0\n", "must have a line of a size"},
           {"1 10\n2\n", "line 2: \"2\": must be a size and its share"},
           {"1,5,20\n", "line 1: \"1,5,20\": has 3 columns: --columns must name"},
           {"x;y;z\n1;2;3\n", "line 2: \"1;2;3\": has 3 columns"},
           {"1 10\n-2 10\n", "line 2: \"-2 10\": must have a size > 0"},
           {"1 10\n2 -10\n", "must have a share >= 0"},
           {"1 10\n2 1e999\n", "must have a share >= 0"},
           {"1 10\nTotal 10\n", "line 2: \"Total 10\": must have a size > 0"},
           {"1.000,5;10\n", "must have a size > 0"},
           {"1 10\n1.0 20\n", "size 1: must be there once"},
           {"1 0\n2 40\n3 100\n", "as those of a cumulative curve"},
           {"1 1\n2 0.4\n3 0\n", "as those of a cumulative curve"}}) {
    try {
      measured_sizes(text, "s.txt");
      ADD_FAILURE() << "taken: " << text;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace peclet::engine
