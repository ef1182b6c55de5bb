// Pictures as files: which form a name asks for, and who draws it.
#pragma once

#include <filesystem>
#include <string>

#include "runner/figure/figure.h"

namespace peclet::runner {

enum class PictureForm { svg, png, pdf };

// By the end of the name. Throws InputError naming those that are allowed.
PictureForm picture_form(const std::filesystem::path& output);

// Where the script of a picture lies: beside it, with the ending .py. Throws InputError when a file is there
// that is not a script as the program wrote it, which would be lost.
std::filesystem::path script_beside(const std::filesystem::path& output);

// The bytes of the picture: SVG by the program itself; PNG and PDF by python3 of PATH, which runs the script
// in a folder of temporary files. Throws std::runtime_error that names the cure where there is no python3 or
// no matplotlib.
std::string picture(const Figure& figure, PictureForm form, const std::string& script);

}  // namespace peclet::runner
