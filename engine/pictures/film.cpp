#include "engine/pictures/film.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "contract/errors.h"
#include "contract/named_files.h"
#include "contract/shell_word.h"

namespace peclet::engine {
namespace {

// Returns the output without its ending. Throws InputError unless that is .png.
std::string stem_of(const std::string& output) {
  const std::filesystem::path path(output);
  if (path.extension() == ".png") return std::filesystem::path(path).replace_extension().string();
  throw InputError("--output", "", output,
                   "must end in .png with --frames: film.png stands for film-00000.png, film-00001.png ...");
}

std::string name_of_picture(const std::string& output, std::size_t number) {
  return fmt::format("{}-{:05}.png", stem_of(output), number);
}

// Runs a program that PATH has, and waits for its end. Returns false if no such program may be run. Throws
// std::runtime_error if it fails.
bool run_program(std::vector<std::string> words) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t process = 0;
  const int fault = posix_spawnp(&process, arguments.front(), nullptr, nullptr, arguments.data(), environ);
  if (fault == ENOENT || fault == EACCES) return false;
  if (fault != 0) throw std::system_error(fault, std::generic_category(), words.front());
  int status = 0;
  while (waitpid(process, &status, 0) < 0) {
    if (errno != EINTR) throw std::system_error(errno, std::generic_category(), words.front());
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return true;
  throw std::runtime_error(fmt::format("{} failed; the pictures are complete", words.front()));
}

// Returns what the pictures of these frames have in common.
FilmFraming framing_of(const SnapshotFile& file, const std::vector<std::uint64_t>& frames,
                       const PictureOptions& options) {
  FilmFraming framing;
  for (const std::uint64_t frame : frames) {
    const Snapshot snapshot = file.read(frame);
    const Colouring colouring = colouring_of(snapshot, options.colour, options.file);
    if (framing.scale.empty()) framing.scale = colouring.scale;
    if (!framing.scale.empty() && !colouring.scale.empty()) {
      framing.scale.front().low = std::min(framing.scale.front().low, colouring.scale.front().low);
      framing.scale.front().high = std::max(framing.scale.front().high, colouring.scale.front().high);
    }
    // Spheres have their centres in the cell, so that balls at its corners bound them.
    const double largest = *std::ranges::max_element(snapshot.radius);
    for (const double x : {0.0, 1.0}) {
      for (const double y : {0.0, 1.0}) {
        for (const double z : {0.0, 1.0}) {
          framing.bounds.balls.push_back(
              {snapshot.corner + snapshot.lattice * Vector3{x, y, z}, largest, {}});
        }
      }
    }
  }
  return framing;
}

// Returns the words of the command that makes the film of this number of pictures.
std::vector<std::string> film_command(const std::string& output, std::size_t pictures) {
  std::string pattern;  // in which % begins the number
  for (const char c : stem_of(output)) pattern += c == '%' ? std::string("%%") : std::string(1, c);
  // H.264 in the form that all players read needs an even width and height.
  return {"ffmpeg",
          "-y",
          "-nostdin",
          "-loglevel",
          "error",
          "-framerate",
          "25",
          "-i",
          "file:" + pattern + "-%05d.png",
          "-frames:v",
          std::to_string(pictures),
          "-vf",
          "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white",
          "-pix_fmt",
          "yuv420p",
          "file:" + stem_of(output) + ".mp4"};
}

}  // namespace

std::string draw_film(const PictureOptions& options) {
  const SnapshotFile file(options.file);
  const std::vector<std::uint64_t> frames = chosen_frames(options.frames.value(), file, "--frames");
  check_output(name_of_picture(options.output, 0));
  const FilmFraming framing = framing_of(file, frames, options);
  std::vector<std::string> notes;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const Snapshot snapshot = file.read(frames[k]);
    if (notes.empty() && !snapshot.has_sizes) notes.push_back(note_on_sizes(options.file));
    write_output(name_of_picture(options.output, k), png(picture_of(snapshot, options, &framing)));
  }
  const std::vector<std::string> command = film_command(options.output, frames.size());
  if (!run_program(command)) {
    std::string text = "there is no ffmpeg in PATH; with it this command makes the film:\n ";
    for (const std::string& word : command) text += " " + shell_word(word);
    notes.push_back(text);
  }
  return fmt::format("{}", fmt::join(notes, "\n"));
}

}  // namespace peclet::engine
