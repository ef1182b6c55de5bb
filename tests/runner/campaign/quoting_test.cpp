#include "runner/campaign/quoting.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "contract/errors.h"
#include "runner/batch/batch_system.h"
#include "runner/engines/engine_process.h"

namespace peclet::runner {
namespace {

const std::vector<std::string> odd{
    "",        "a b",   "it's",  "say \"hi\"", "$HOME `id` $(id)",        "a\\b", "~", "#",
    "a;b&c|d", "*?[x]", "100 %", "\n",         "tab\tand\nline's \\ end", "\x01"};

TEST(Quoting, AShellReadsAWordAsItWas) {
  for (const std::string& text : odd) {
    const CommandAnswer said =
        run_command({"bash", "-c", "printf '%s|' " + shell_word(text)}, std::chrono::seconds(60));
    EXPECT_EQ(said.output, text + "|") << shell_word(text);
  }
}

TEST(Quoting, APlainPathStaysAsItIs) {
  EXPECT_EQ(shell_word("/scratch/me/flow-curve_2.json"), "/scratch/me/flow-curve_2.json");
  EXPECT_EQ(shell_word("Péclet"), "Péclet");
  EXPECT_EQ(sbatch_word("/scratch/me"), "/scratch/me");
}

// sbatch of Slurm 22.05 reads these words as intended; `slurm_drill.py --only odd_folder` tests it.
TEST(Quoting, ADirectiveOfSlurmHasNoPatternButItsOwn) {
  EXPECT_EQ(sbatch_word("/a b/%j"), "\"/a b/%%j\"");
  EXPECT_EQ(sbatch_word("say \"hi\""), "\"say \\\"hi\\\"\"");
}

std::string filled(const std::string& text, const std::string& value) {
  return fill_in(text, {{"FOLDER", value}}, "job.sh");
}

TEST(BatchTemplate, ValuesAreQuotedForWhereTheyStand) {
  EXPECT_EQ(filled("#SBATCH --output=@FOLDER@/%a\ncd @FOLDER@/logs\n", "/a b/100 %"),
            "#SBATCH --output=\"/a b/100 %%\"/%a\ncd '/a b/100 %'/logs\n");
  EXPECT_EQ(filled("#PBS -o @FOLDER@\ncd \"@FOLDER@\"", "/a/b"), "#PBS -o /a/b\ncd \"/a/b\"") << "as ever";
}

TEST(BatchTemplate, WhatCannotBeQuotedIsRefused) {
  for (const char* const place : {"cd @FOLDER@", "#SBATCH -o @FOLDER@", "#PBS -o @FOLDER@"}) {
    EXPECT_THROW(filled(place, "/a\nb"), InputError) << place;
  }
  EXPECT_THROW(filled("#SBATCH -o @FOLDER@/%a", "/a\\b"), InputError) << "no %a after a backslash";
  EXPECT_THROW(filled("#PBS -o @FOLDER@", "/a b"), InputError);
  EXPECT_THROW(filled("cd \"@FOLDER@\"", "/a b"), InputError);
  EXPECT_THROW(filled("cd '@FOLDER@'", "/a b"), InputError);
}

}  // namespace
}  // namespace peclet::runner
