#include "runner/page/figure.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <system_error>
#include <vector>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/own_folder.h"
#include "contract/sha256.h"
#include "runner/engines/engine_process.h"
#include "runner/page/page_html.h"
#include "runner/store/campaign_directory.h"

namespace peclet::runner {
namespace {

constexpr std::string_view seal = "# sha256 of all above: ";

}  // namespace

std::string figure_script(const Json& data) {
  // One line for each member and each point, for people who read or change them. JSON cannot end the raw
  // string: it has a backslash before every quotation mark within a text, and never three in a row.
  std::vector<std::string> lines, points;
  for (const auto& [name, value] : data.items()) {
    if (name != "points") lines.push_back(fmt::format("\"{}\": {}", name, canonical_json(value)));
  }
  if (data.contains("points")) {
    for (const Json& point : data["points"]) points.push_back("  " + canonical_json(point));
    lines.push_back(fmt::format("\"points\": [\n{}]", fmt::join(points, ",\n")));
  }
  std::string script = drawing_script;
  script += fmt::format(
      "\n\nFIGURE = json.loads(r\"\"\"{{{}}}\"\"\")\n\nif __name__ == \"__main__\":\n    main(FIGURE)\n",
      fmt::join(lines, ",\n "));
  return script + std::string(seal) + sha256(script) + '\n';
}

bool is_own_script(std::string_view text) {
  const std::size_t last = text.rfind(seal);
  if (last == std::string_view::npos) return false;
  return text.substr(last + seal.size()) == sha256(text.substr(0, last)) + '\n';
}

namespace {

namespace fs = std::filesystem;

}  // namespace

PictureForm picture_form(const fs::path& output) {
  const std::string ending = output.extension().string();
  if (ending == ".svg") return PictureForm::svg;
  if (ending == ".png") return PictureForm::png;
  if (ending == ".pdf") return PictureForm::pdf;
  if (ending == ".py") return PictureForm::script;
  throw InputError("", "--output", output.string(), "must end in .svg, .png, .pdf or .py");
}

fs::path script_beside(const fs::path& output) {
  fs::path script = output;
  script.replace_extension(".py");
  std::error_code unknown;  // ignored: a file that cannot be examined is refused when it is written
  if (fs::is_regular_file(script, unknown) && !is_own_script(read_file(script))) {
    throw InputError(script.string(), "", "",
                     "is there already, and is not a script as `peclet plot` writes it: the script of the "
                     "figure would replace it; move it away, or choose another name for --output");
  }
  return script;
}

Picture drawn(const std::string& script, PictureForm form) {
  constexpr std::chrono::seconds patience(120);  // the first use of matplotlib looks through all fonts
  const ScratchFolder folder("peclet-plot");
  const fs::path source = folder.path() / "figure.py",
                 output = folder.path() / (form == PictureForm::png   ? "figure.png"
                                           : form == PictureForm::pdf ? "figure.pdf"
                                                                      : "figure.svg");
  write_durably(source, script);
  try {
    const CommandAnswer answer = run_command({own_python(), source.string(), output.string()}, patience);
    // The script itself says what cures a lack of matplotlib.
    if (!answer.succeeded()) throw NotDrawn("python3 could not draw the picture: " + answer.complaint());
    return {read_file(output), answer.output};
  } catch (const std::system_error& fault) {
    throw NotDrawn(
        fmt::format("pictures are drawn by the python3 in PATH, which cannot be run ({})", fault.what()));
  }
}

}  // namespace peclet::runner
