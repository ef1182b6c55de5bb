#include "runner/command_line/manual.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <utility>

#include "contract/input_error.h"
#include "contract/provenance.h"
#include "runner/text/roff.h"

namespace peclet::runner {
namespace {

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
  return text;
}

std::string heading(const std::string& name, const std::string& summary) {
  return fmt::format(".TH {} 1 \"\" \"peclet {}\" \"Peclet manual\"\n.SH NAME\n{} \\- {}\n",
                     upper(roff_code(name)), version(), roff_code(name), roff_text(summary));
}

// "\fB\-\-workers\fR \fINUMBER\fR"
std::string term(const CommandOption& option) {
  if (option.positional) return "\\fI" + roff_code(option.name) + "\\fR";
  std::string text = "\\fB" + roff_code(option.name) + "\\fR";
  if (!option.short_name.empty()) text = "\\fB" + roff_code(option.short_name) + "\\fR, " + text;
  return option.takes_value() ? text + " \\fI" + roff_code(option.value) + "\\fR" : text;
}

std::string options_section(const std::vector<CommandOption>& options) {
  std::string text = ".SH OPTIONS\n";
  for (const bool positional : {true, false}) {
    for (const CommandOption& option : options) {
      if (option.positional != positional) continue;
      text += ".TP\n" + term(option) + '\n' + roff_text(option.meaning);
      if (option.repeatable) text += "; may be repeated";
      for (std::size_t i = 0; i < option.choices.size(); ++i) {
        text += (i == 0 ? ": " : ", ") + roff_code(option.choices[i]);
      }
      if (!option.default_value.empty()) text += " (" + roff_code(option.default_value) + " unless given)";
      text += ".\n";
    }
  }
  return text;
}

std::string exit_section(const std::vector<int>& codes) {
  std::string text = ".SH EXIT STATUS\n";
  for (const auto& [code, meaning] : exit_codes()) {
    const bool listed = codes.empty() || std::find(codes.begin(), codes.end(), code) != codes.end();
    if (listed) text += fmt::format(".TP\n.B {}\n{}.\n", code, roff_text(meaning));
  }
  return text;
}

std::string files_section() {
  std::string text = ".SH FILES\n";
  for (const auto& [file, meaning] : std::vector<std::pair<const char*, const char*>>{
           {"NAME.json", "the campaign: scene, sweep and target"},
           {"NAME.peclet/campaign.db", "its database, which one process at a time writes"},
           {"NAME.peclet/checkpoints/", "realisations that have not ended"},
           {"NAME.peclet/files/", "what realisations have left beside their results"},
           {"NAME.peclet/spool/", "results on their way into the database"},
           {"NAME.peclet/failures/", "the last state of realisations that failed"},
           {"NAME.peclet/logs/", "of the run (`peclet.log`) and of every worker"},
           {"NAME.peclet/backup/", "the last two backups of the database, and of files"}}) {
    text += ".TP\n.I " + roff_code(file) + '\n' + roff_text(meaning) + ".\n";
  }
  return text;
}

std::string example_lines(const std::string& command) {
  std::string text = ".nf\n";
  std::istringstream lines(command);
  for (std::string line; std::getline(lines, line);) text += roff_code(line) + '\n';
  return text + ".fi\n";
}

std::string examples_section(const std::string& example, const std::vector<VerbExample>& more) {
  std::string text = ".SH EXAMPLES\n" + example_lines(example);
  for (const VerbExample& another : more) {
    text += ".PP\n";
    if (!another.purpose.empty()) text += roff_text(another.purpose) + ":\n.PP\n";
    text += example_lines(another.command);
  }
  return text;
}

std::string see_also(const CommandTree& tree, const std::string& but) {
  std::string text = ".SH SEE ALSO\n";
  std::vector<std::string> names;
  if (!but.empty()) names.emplace_back("peclet");
  for (const CommandVerb& verb : tree.verbs) {
    if (verb.name != but) names.push_back("peclet-" + verb.name);
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += ".BR " + roff_code(names[i]) + " (1)" + (i + 1 < names.size() ? "," : "") + '\n';
  }
  return text;
}

std::string synopsis(const CommandVerb& verb) {
  std::string text = ".SH SYNOPSIS\n.B peclet " + roff_code(verb.name) + "\n[\\fIoptions\\fR]";
  for (const CommandOption& word : verb.positionals()) {
    text += word.required ? " " + term(word) : " [" + term(word) + "]";
  }
  return text + '\n';
}

std::string verb_manual(const CommandTree& tree, const CommandVerb& verb) {
  const VerbPage& page = verb.page;
  std::string text = heading("peclet-" + verb.name, verb.summary) + synopsis(verb);
  text += ".SH DESCRIPTION\n" + roff_text(verb.summary) + ".\n";
  for (const std::string& paragraph : page.paragraphs) text += ".PP\n" + roff_text(paragraph) + '\n';
  return text + options_section(verb.options) + exit_section(page.exit_codes) + files_section() +
         examples_section(verb.example, page.examples) + see_also(tree, verb.name);
}

std::string main_manual(const CommandTree& tree) {
  std::string text = heading("peclet", tree.summary);
  text += ".SH SYNOPSIS\n.B peclet\n\\fIverb\\fR [\\fIoptions\\fR] ...\n.SH DESCRIPTION\n";
  text += roff_text(
      "A campaign is a scene, what is varied in it, and how well a mean is to be known at every point. "
      "Realisations of every point are run with different seeds until the confidence interval of the mean "
      "is within the tolerance, and everything is kept in one database, from which a campaign goes on "
      "whenever it was stopped. Data go to standard output, everything else to standard error; colours only "
      "to a terminal, and not where `NO_COLOR` is set.");
  text += "\n.SH VERBS\n";
  for (const CommandVerb& verb : tree.verbs) {
    text += ".TP\n.BR peclet\\-" + roff_code(verb.name) + " (1)\n" + roff_text(verb.summary) + ".\n";
  }
  return text + options_section(tree.options) + exit_section({}) + files_section() +
         examples_section(
             "peclet init flow-curve.json\npeclet run flow-curve.json\npeclet status flow-curve.json\n"
             "peclet report flow-curve.json --output flow-curve.html",
             {}) +
         see_also(tree, "");
}

}  // namespace

std::string manual_page(const CommandTree& tree, const std::string& verb) {
  if (verb.empty()) return main_manual(tree);
  for (const CommandVerb& known : tree.verbs) {
    if (known.name == verb) return verb_manual(tree, known);
  }
  throw InputError("", "", verb, "must be one of the verbs that `peclet --help` lists");
}

std::map<std::string, std::string> manual_pages(const CommandTree& tree) {
  std::map<std::string, std::string> pages{{"peclet.1", manual_page(tree, "")}};
  for (const CommandVerb& verb : tree.verbs)
    pages["peclet-" + verb.name + ".1"] = manual_page(tree, verb.name);
  return pages;
}

}  // namespace peclet::runner
