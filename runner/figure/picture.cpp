#include "runner/figure/picture.h"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include "contract/durable_file.h"
#include "contract/input_error.h"
#include "runner/engines/command.h"
#include "runner/figure/figure_script.h"
#include "runner/figure/svg_figure.h"

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

// The script itself says what cures a lack of matplotlib.
[[noreturn]] void refuse(const std::string& why) {
  throw std::runtime_error(
      fmt::format("{}; a file that ends in .svg needs neither python3 nor matplotlib", why));
}

CommandAnswer run_python(const fs::path& script, const fs::path& drawn) {
  constexpr std::chrono::seconds patience(120);  // the first use of matplotlib looks through all fonts
  try {
    return run_command({"python3", script.string(), drawn.string()}, patience);
  } catch (const std::system_error& fault) {
    refuse(
        fmt::format("PNG and PDF are drawn by the python3 in PATH, which cannot be run ({})", fault.what()));
  }
}

std::string drawn_by_matplotlib(const std::string& script, const char* ending) {
  const ScratchFolder folder;
  const fs::path source = folder.path() / "figure.py", drawn = folder.path() / ending;
  write_durably(source, script);
  const CommandAnswer answer = run_python(source, drawn);
  if (!answer.succeeded()) refuse("python3 has not drawn the figure: " + answer.complaint());
  return read_file(drawn);
}

}  // namespace

PictureForm picture_form(const fs::path& output) {
  const std::string ending = output.extension().string();
  if (ending == ".svg") return PictureForm::svg;
  if (ending == ".png") return PictureForm::png;
  if (ending == ".pdf") return PictureForm::pdf;
  throw InputError("", "--output", output.string(), "must end in .svg, .png or .pdf");
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

std::string picture(const Figure& figure, PictureForm form, const std::string& script) {
  if (form == PictureForm::svg) return svg_figure(figure);
  return drawn_by_matplotlib(script, form == PictureForm::png ? "figure.png" : "figure.pdf");
}

}  // namespace peclet::runner
