#include "runner/page/picture.h"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "runner/engines/command.h"
#include "runner/page/figure.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (fs::temp_directory_path() / "peclet-plot-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::system_error(errno, std::generic_category(), name);
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;  // what is left of it lies where temporary files are
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

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
  std::error_code unknown;  // what cannot be looked at cannot be written either, and is said then
  if (fs::is_regular_file(script, unknown) && !is_own_script(read_file(script))) {
    throw InputError(script.string(), "", "",
                     "is there already, and is not as peclet plot wrote it: the script of the figure would "
                     "replace it; move it away, or choose another name for --output");
  }
  return script;
}

Picture drawn(const std::string& script, PictureForm form) {
  constexpr std::chrono::seconds patience(120);  // the first use of matplotlib looks through all fonts
  const ScratchFolder folder;
  const fs::path source = folder.path() / "figure.py",
                 output = folder.path() / (form == PictureForm::png   ? "figure.png"
                                           : form == PictureForm::pdf ? "figure.pdf"
                                                                      : "figure.svg");
  write_durably(source, script);
  try {
    const CommandAnswer answer = run_command({"python3", source.string(), output.string()}, patience);
    // The script itself says what cures a lack of matplotlib.
    if (!answer.succeeded()) throw NotDrawn("python3 draws no picture: " + answer.complaint());
    return {read_file(output), answer.output};
  } catch (const std::system_error& fault) {
    throw NotDrawn(
        fmt::format("pictures are drawn by the python3 in PATH, which cannot be run ({})", fault.what()));
  }
}

}  // namespace peclet::runner
