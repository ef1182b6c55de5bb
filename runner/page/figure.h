// Measured quantities over a swept parameter, or along an axis of their own, as numbers and as the script
// that draws them. Numbers are those of `peclet export`.
#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "contract/json.h"
#include "runner/page/swept.h"
#include "runner/store/database.h"

namespace peclet::runner {

struct FigureChoice {
  // The target, or quantities of one unit: "pressure", "stress/total/xy", "transient/shear_stress".
  std::vector<std::string> quantities{};
  // A swept parameter, a derived number or a measured one: "/volume_fraction", "volume_fraction", "peclet",
  // "shear_rate"; chosen if empty.
  std::string over{};
  std::vector<std::string> where{};  // as in read_sweep()
  std::string scale_x{}, scale_y{};  // as in DerivedNumbers::scale(); "": not scaled
  std::optional<std::string> log{};  // logarithmic axes: "none", "x", "y", "xy"; those that fit unless given
  bool tolerance = false;            // draw the tolerance as a band around each mean
};

// Returns the document that python/peclet/drawing.py draws (over_sweep() and over_axis() list the members):
// the quantities, the swept parameters, and the numbers of each point, null if it has none. Throws InputError
// for a quantity that is not measured or a parameter that is not swept, and names the possible ones; also if
// the axes can show no point. Throws IntegrityError.
Json figure_data(Database& database, const FigureChoice& choice);

// Returns one such document of the points of several campaigns. Their names are a parameter, "campaign". A
// parameter that one of them does not sweep has the value of its scene there, or null if the scene has none.
// Throws as figure_data(), and InputError for campaigns without the same quantities, confidence and axis, or
// without values on the axis.
Json figure_data_of_several(const std::vector<NamedCampaign>& sources, FigureChoice choice);

// Returns drawing.py with these data in it, one line for each member and each point. The last line has the
// SHA-256 of all before it. The same data give the same bytes.
std::string figure_script(const Json& data);

// True if figure_script() has made the text and it has not been changed since.
bool is_own_script(std::string_view text);

enum class PictureForm { svg, png, pdf, script };

// Returns the form of a picture by the ending of its name. Throws InputError with the allowed endings.
PictureForm picture_form(const std::filesystem::path& output);

// Returns the path of a picture's script: beside the picture, with the ending .py. Throws InputError if
// another file is there, or a script that was changed, because it would be lost.
std::filesystem::path script_beside(const std::filesystem::path& output);

// Thrown if python3 or matplotlib is missing; the message names the cure.
class NotDrawn : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Picture {
  std::string bytes;
  std::string said;  // lines about points that the picture omits
};

// Draws the picture: runs the script with the python3 in PATH, in a temporary folder. Throws NotDrawn.
Picture drawn(const std::string& script, PictureForm form);

}  // namespace peclet::runner
