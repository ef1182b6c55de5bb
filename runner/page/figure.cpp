#include "runner/page/figure.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>
#include <system_error>
#include <vector>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/sha256.h"
#include "runner/engines/engine_process.h"
#include "runner/page/page_html.h"
#include "runner/page/swept.h"
#include "runner/store/campaign_directory.h"

namespace peclet::runner {
namespace {

constexpr std::string_view seal = "# sha256 of all above: ";

void require_tolerance(const Target& target, const std::string& path) {
  for (const Criterion& criterion : target.criteria()) {
    if (target.has_tolerance() && bare(criterion.observable) == path) return;
  }
  throw InputError("", "--band", path, "has no tolerance: it is not a target of the campaign");
}

// Returns "converged" for a point that is converged or complete, "undecided" for one that has ended
// otherwise, "provisional" for an open one.
const char* state_of(const Json& point) {
  if (!point.at("decided").get<bool>()) return "provisional";
  const std::optional<Verdict> verdict = verdict_of(point.at("state").get<std::string>());
  return verdict && is_reached(*verdict) ? "converged" : "undecided";
}

// True if the point has a number of the quantity. If the point has jammed, a mean over half of its seeds or
// fewer does not count, because it is that of the seeds that happened to flow.
bool has_number(const Json& point, const Json& estimate) {
  if (estimate.is_null() || !estimate[0].is_number()) return false;
  const Json& endings = point.at("endings");
  return !endings.at("has_jammed").get<bool>() || 2 * estimate[3].get<int>() > endings.at("ended").get<int>();
}

Json point_json(const Json& point, const Json& estimate, const std::string& path) {
  const bool is_known = has_number(point, estimate);
  const auto number = [&](std::size_t place) { return is_known ? estimate[place] : Json(nullptr); };
  return {{"label", point.at("label")},
          {"settings", point.at("settings")},
          {"mean", number(0)},
          {"standard_error", number(1)},
          {"half_width", number(2)},
          {"good_enough", is_known ? point.at("good_enough").value(path, Json()) : Json(nullptr)},
          {"curve", point.at("curve").value(path, Json())},
          {"count", is_known ? estimate[3] : point.at("endings").at("ended")},
          {"state", state_of(point)},
          {"jammed", point.at("endings").at("has_jammed")}};
}

void require_numbers(const Json& points, const Swept& axis, const FigureChoice& choice,
                     const std::string& quantity) {
  const auto is_log = [&](char name) {
    return choice.scale && choice.scale->find(name) != std::string::npos;
  };
  bool has_number = false, has_jammed = false;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Json& mean = points[i].at("mean");
    has_jammed = has_jammed || points[i].at("jammed").get<bool>();
    if (!mean.is_number()) continue;
    has_number = true;
    const bool is_hidden =
        (is_log('y') && mean.get<double>() <= 0) || (is_log('x') && axis.numeric && axis.numbers[i] <= 0);
    if (!is_hidden) return;
  }
  throw InputError("", "--quantity", quantity,
                   has_number   ? "has no number that a logarithmic axis can show"
                   : has_jammed ? "has no number at any point: all points that have ended have jammed"
                                : "has no number at any point yet");
}

}  // namespace

Json figure_data(Database& database, const FigureChoice& choice) {
  const MeasuredSweep sweep = read_sweep(database);
  const CampaignRecord& campaign = sweep.status.campaign;
  const Target& target = campaign.target.target;
  const std::string wanted = bare(choice.quantity.empty() ? target.observable : choice.quantity);
  const std::size_t column = chosen_column(sweep.page.drawables, wanted);
  const Drawable& quantity = sweep.page.drawables[column];
  if (choice.tolerance) require_tolerance(target, quantity.path);
  const Swept& axis = chosen_axis(sweep.swept, choice.over);
  Json points = Json::array();
  for (const Json& point : sweep.page.points) {
    points.push_back(point_json(point, point.at("estimates")[column], quantity.path));
  }
  require_numbers(points, axis, choice, quantity.path);
  return {{"campaign", campaign.name},
          {"quantity", to_json(quantity)},
          {"over", axis.pointer},
          {"confidence", target.confidence},
          {"log", choice.scale ? Json(*choice.scale) : Json(nullptr)},
          {"tolerance", choice.tolerance},
          {"parameters", sweep.parameters},
          {"points", points}};
}

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
    const CommandAnswer answer = run_command({"python3", source.string(), output.string()}, patience);
    // The script itself says what cures a lack of matplotlib.
    if (!answer.succeeded()) throw NotDrawn("python3 could not draw the picture: " + answer.complaint());
    return {read_file(output), answer.output};
  } catch (const std::system_error& fault) {
    throw NotDrawn(
        fmt::format("pictures are drawn by the python3 in PATH, which cannot be run ({})", fault.what()));
  }
}

}  // namespace peclet::runner
