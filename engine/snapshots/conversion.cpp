#include "engine/snapshots/conversion.h"

#include <fmt/format.h>

#include <filesystem>

#include "contract/input_error.h"
#include "contract/output_file.h"
#include "engine/snapshots/snapshot_file.h"
#include "engine/snapshots/snapshot_text.h"

namespace peclet::engine {
namespace {

using FrameText = std::string (*)(const Snapshot&);

FrameText text_of(const ConversionOptions& options) {
  if (options.format == "lammps") return lammps_frame;
  if (options.format == "xyz") return xyz_frame;
  const std::string ending = std::filesystem::path(options.output).extension().string();
  if (ending == ".lammpstrj" || ending == ".dump") return lammps_frame;
  if (ending == ".xyz" || ending == ".extxyz") return xyz_frame;
  throw InputError(options.output.empty() ? "--format" : "--output", "",
                   options.output.empty() ? "missing" : options.output,
                   "must end in .lammpstrj, .dump, .xyz or .extxyz, or --format must be lammps or xyz");
}

}  // namespace

std::string convert_trajectory(const ConversionOptions& options) {
  const FrameText text = text_of(options);
  const std::filesystem::path output = options.output.empty() ? "/dev/stdout" : options.output;
  check_output(output);
  const SnapshotFile file(options.file);
  const std::vector<std::uint64_t> frames = chosen_frames(options.frames, file, "--frames");
  bool has_sizes = true;
  for (const std::uint64_t frame : frames) {
    const Snapshot snapshot = file.read(frame);
    has_sizes = has_sizes && snapshot.has_sizes;
    if (text == lammps_frame && is_turned(snapshot)) {
      throw InputError(options.file, "", "",
                       "has a cell whose first edge is not along x, which a dump of LAMMPS cannot hold: "
                       "--format must be xyz");
    }
  }
  auto next = frames.begin();
  write_output(output, [&] { return next == frames.end() ? std::string() : text(file.read(*next++)); });
  return has_sizes ? "" : note_on_sizes(options.file);
}

}  // namespace peclet::engine
