// A measured quantity over a swept parameter, as it is to be drawn: by the program itself (svg_figure.h) or
// by matplotlib (figure_script.h). Numbers are those of the page, which are those of `peclet export`.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "runner/figure/axis.h"
#include "runner/figure/label.h"
#include "runner/store/database.h"

namespace peclet::runner {

// What is to be drawn.
struct FigureChoice {
  std::string quantity;              // "" or a path: "pressure", "stress/total/3", "stress/total/xy"
  std::string over;                  // "" or a swept parameter: "/volume_fraction", "volume_fraction"
  std::optional<std::string> scale;  // logarithmic axes: "none", "x", "y", "xy"; those that fit unless given
  bool tolerance = false;            // a band around each mean as wide as the target asks
};

// How sure a number is: of a point that has converged or is complete, of one that has ended otherwise, of one
// still open.
enum class Standing { converged, undecided, provisional };

// Where the mark of a point that has jammed stands: at its number; where it has none, at the upper edge of
// the frame; where a logarithmic axis has no place for it, as for the rate 0, at the lower one. No line leads
// to it.
enum class Jam { none, at_number, above, below };

struct Mark {
  std::string label;  // of the point
  double x = 0, mean = 0;
  double standard_error = 0, half_width = 0;  // NaN where there is none
  std::optional<double> good_enough{};        // half-width that the target asks for
  int count = 0;                              // seeds
  Standing standing = Standing::provisional;
  Jam jam = Jam::none;

  bool has_place() const { return jam == Jam::none || jam == Jam::at_number; }
};

struct Curve {
  Label name;               // empty where it is the only one
  std::vector<Mark> marks;  // in order of x
};

struct FigureAxis {
  Label title;
  AxisRange range;
  std::vector<std::string> words;  // in the place of numbers
};

struct Figure {
  std::string campaign, quantity, over;
  double confidence = 0.95;
  FigureAxis x{}, y{};
  std::vector<Curve> curves{};
  bool tolerance = false;  // bands are drawn
  // What is not drawn: points without the number yet, and numbers that a logarithmic axis has no place for.
  int absent = 0, hidden = 0;

  bool has(Standing standing) const;  // among marks that have not jammed
  bool has_jammed() const;
  bool has_tolerance() const;  // a mark of it has one, which it has from the first look on
};

// Throws InputError for a quantity that is not measured or a parameter that is not swept, naming those that
// are, and where no point has the quantity yet; IntegrityError.
Figure make_figure(Database& database, const FigureChoice& choice);

// "Left out: 2 points without a number of pressure yet." or nothing.
std::string left_out(const Figure& figure);

}  // namespace peclet::runner
