// Pictures as files: which form a name asks for, and who draws it.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace peclet::runner {

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
