// A measured quantity over a swept parameter, as numbers and as the script that draws them. Numbers are those
// of the page, which are those of `peclet export`.
#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "contract/json.h"
#include "runner/store/database.h"

namespace peclet::runner {

// What is to be drawn.
struct FigureChoice {
  std::string quantity;              // "" or a path: "pressure", "stress/total/3", "stress/total/xy"
  std::string over;                  // "" or a swept parameter: "/volume_fraction", "volume_fraction"
  std::optional<std::string> scale;  // logarithmic axes: "none", "x", "y", "xy"; those that fit unless given
  bool tolerance = false;            // a band around each mean as wide as the target asks
};

// What python/peclet/drawing.py draws (its docstring lists the members): the quantity, what is swept, and
// each point with its numbers, null where it has none. Throws InputError for a quantity that is not measured
// or a parameter that is not swept, naming those that are, and where no point has a number that the axes have
// a place for; IntegrityError.
Json figure_data(Database& database, const FigureChoice& choice);

// drawing.py with these data in it, a point a line. Ends with the SHA-256 of all before its last line. The
// same data give the same bytes.
std::string figure_script(const Json& data);

// Whether the text is what figure_script() once gave, and nobody has changed it.
bool is_own_script(std::string_view text);

// Pictures as files: which form a name asks for, and who draws it.

enum class PictureForm { svg, png, pdf, script };

// Returns the form that the end of the name asks for. Throws InputError naming those that are allowed.
PictureForm picture_form(const std::filesystem::path& output);

// Returns where the script of a picture lies: beside it, with the ending .py. Throws InputError if a file is
// there that is not a script as the program wrote it, which would be lost.
std::filesystem::path script_beside(const std::filesystem::path& output);

// No python3, or one without matplotlib; the message names the cure.
class NotDrawn : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Picture {
  std::string bytes;
  std::string said;  // what the picture leaves out, in lines
};

// The picture that python3 of PATH draws with matplotlib: runs the script in a folder of temporary files.
// Throws NotDrawn.
Picture drawn(const std::string& script, PictureForm form);

}  // namespace peclet::runner
