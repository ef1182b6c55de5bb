#include "runner/figure/figure_script.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "contract/sha256.h"
#include "runner/figure/figure_assets.h"
#include "runner/figure/svg_figure.h"

namespace peclet::runner {
namespace {

constexpr std::string_view seal = "# sha256 of all above: ";

const char* word_of(Standing standing) {
  switch (standing) {
    case Standing::converged:
      return "converged";
    case Standing::undecided:
      return "undecided";
    case Standing::provisional:
      return "provisional";
  }
  throw std::logic_error("a standing that is none");
}

Json jam_word(Jam jam) {
  switch (jam) {
    case Jam::none:
      return nullptr;
    case Jam::at_number:
      return "at its number";
    case Jam::above:
      return "upper edge";
    case Jam::below:
      return "lower edge";
  }
  throw std::logic_error("a jam that is none");
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

// One text of JSON, numbers spelt as `peclet export` spells them. Between r""" and """ nothing in it ends the
// string: JSON has a backslash before every quotation mark within a text, and never three around one.
std::string text(const Json& json) { return canonical_json(json); }

Json axis_json(const FigureAxis& about, const Axis& axis) {
  Json ticks = Json::array(), minor = Json::array();
  const std::vector<double> places = axis.ticks();
  for (std::size_t i = 0; i < places.size(); ++i) {
    ticks.push_back({places[i], about.words.empty() ? plain_number(places[i]) : about.words[i]});
  }
  for (const double place : axis.minor_ticks()) minor.push_back(place);
  return {{"title", mathtext_of(about.title)},
          {"log", axis.is_log()},
          {"limits", {axis.low(), axis.high()}},
          {"ticks", ticks},
          {"minor_ticks", minor}};
}

// A line for each mark, so that people can read and change them.
std::string data(const Figure& figure) {
  const FigureLayout layout = figure_layout(figure);
  std::string lines = fmt::format("{{\"campaign\": {}, \"quantity\": {}, \"over\": {},\n",
                                  text(figure.campaign), text(figure.quantity), text(figure.over));
  lines += fmt::format(" \"confidence\": {}, \"tolerance\": {}, \"legend\": {},\n", text(figure.confidence),
                       text(figure.tolerance), text(layout.legend));
  lines += fmt::format(" \"x\": {},\n \"y\": {},\n", text(axis_json(figure.x, layout.x)),
                       text(axis_json(figure.y, layout.y)));
  lines +=
      " \"columns\": [\"label\", \"x\", \"mean\", \"standard_error\", \"half_width\", \"good_enough\", "
      "\"count\", \"standing\", \"jammed\"],\n \"curves\": [";
  const char* separator = "\n";
  for (const Curve& curve : figure.curves) {
    lines += fmt::format("{}  {{\"name\": {}, \"marks\": [", separator, text(mathtext_of(curve.name)));
    separator = "\n";
    for (const Mark& mark : curve.marks) {
      const Json row{mark.label,
                     mark.x,
                     number(mark.mean),
                     number(mark.standard_error),
                     number(mark.half_width),
                     mark.good_enough ? Json(*mark.good_enough) : Json(nullptr),
                     mark.count,
                     word_of(mark.standing),
                     jam_word(mark.jam)};
      lines += separator + ("   " + text(row));
      separator = ",\n";
    }
    lines += "]}";
    separator = ",\n";
  }
  return lines + "]}";
}

}  // namespace

std::string figure_script(const Figure& figure) {
  constexpr std::string_view mark = "@FIGURE@";
  std::string script = figure_script_template;
  script.replace(script.find(mark), mark.size(), data(figure));
  return script + std::string(seal) + sha256(script) + '\n';
}

bool is_own_script(std::string_view text) {
  const std::size_t last = text.rfind(seal);
  if (last == std::string_view::npos) return false;
  return text.substr(last + seal.size()) == sha256(text.substr(0, last)) + '\n';
}

}  // namespace peclet::runner
