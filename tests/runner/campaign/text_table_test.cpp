// Tests tables for a terminal.
#include "runner/campaign/text_table.h"

#include <gtest/gtest.h>

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

TEST(TextTable, AMarkOnALetterTakesNoColumn) {
  TextTable table;
  table.add_column("γ̇");
  table.add_column("k̂");
  table.add_row({"10", "1"});
  EXPECT_EQ(table.text(), " γ̇  k̂\n10  1\n");
}

TextTable three_columns() {
  TextTable table;
  table.add_column("point", TextTable::Align::left);
  table.add_column("mean", TextTable::Align::right, 2);
  table.add_column("cost", TextTable::Align::right, 1);
  table.add_column("verdict", TextTable::Align::left);
  table.add_row({"a", "10 ± 1", "3 h", "converged, 2 flagged"});
  return table;
}

TEST(TextTable, LeavesOutWhatMattersLeastUntilItFits) {
  const TextTable table = three_columns();
  EXPECT_EQ(table.text_within(41), table.text());  // 5 + 2 + 6 + 2 + 4 + 2 + 20
  EXPECT_EQ(table.text_within(40),
            "point    mean  verdict\n"
            "a      10 ± 1  converged, 2 flagged\n");
  EXPECT_EQ(table.text_within(34),
            "point  verdict\n"
            "a      converged, 2 flagged\n");
  EXPECT_EQ(table.left_out(41), std::vector<std::string>{});
  EXPECT_EQ(table.left_out(40), std::vector<std::string>{"cost"});
  EXPECT_EQ(table.left_out(34), (std::vector<std::string>{"mean", "cost"}));
}

TEST(TextTable, TheLastColumnGoesOnInFurtherLines) {
  EXPECT_EQ(three_columns().text_within(20),
            "point  verdict\n"
            "a      converged, 2\n"
            "       flagged\n");
  EXPECT_EQ(three_columns().text_within(16),
            "point\n"
            "  verdict\n"
            "a\n"
            "  converged, 2\n"
            "  flagged\n");
}

TEST(FoldedText, BreaksAtBlanksAndCountsCharacters) {
  EXPECT_EQ(folded("10 ± 1 of 2\nb", 6), "10 ± 1\nof 2\nb\n");
  EXPECT_EQ(folded("long-word a", 4), "long-word\na\n");
  EXPECT_EQ(folded("a\n\nb\n", 4), "a\n\nb\n");
  EXPECT_EQ(folded("", 4), "");
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
