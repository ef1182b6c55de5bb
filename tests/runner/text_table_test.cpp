// Tables for a terminal.
#include "runner/text_table.h"

#include <gtest/gtest.h>

#include "runner/point_columns.h"

namespace peclet::runner {
namespace {

TEST(TextTable, AlignsCharactersNotBytes) {
  TextTable table;
  table.add_column("point", TextTable::Align::left);
  table.add_column("mean");
  table.add_column("verdict", TextTable::Align::left);
  table.add_row({"a", "10.0 ± 1.2", "open"});
  table.add_row({"bb", "-", "converged"});
  EXPECT_EQ(table.text(),
            "point        mean  verdict\n"
            "a      10.0 ± 1.2  open\n"
            "bb              -  converged\n");
  EXPECT_TRUE(table.text("  ").starts_with("  point"));
}

std::string header(const std::vector<std::string>& labels) {
  TextTable table;
  PointColumns(labels).add_to(table);
  return table.text();
}

TEST(PointColumns, LabelsOfTheSameNamesFallApart) {
  const std::vector<std::string> labels{"peclet=1 volume_fraction=0.45", "peclet=10 volume_fraction=0.5"};
  EXPECT_EQ(header(labels), "peclet  volume_fraction\n");
  EXPECT_EQ(PointColumns(labels).cells(1), (std::vector<std::string>{"10", "0.5"}));
}

TEST(PointColumns, OtherLabelsStayWhole) {
  const std::vector<std::string> labels{"peclet=1", "flow-curve", "form=a b"};
  EXPECT_EQ(header(labels), "point\n");
  EXPECT_EQ(PointColumns(labels).cells(2), std::vector<std::string>{"form=a b"});
  EXPECT_EQ(header({"peclet=1", "volume_fraction=1"}), "point\n");
}

}  // namespace
}  // namespace peclet::runner
