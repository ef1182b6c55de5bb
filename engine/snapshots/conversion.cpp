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

void convert_trajectory(const ConversionOptions& options) {
  const FrameText text = text_of(options);
  const std::filesystem::path output = options.output.empty() ? "/dev/stdout" : options.output;
  check_output(output);
  const SnapshotFile file(options.file);
  const std::vector<std::uint64_t> frames = chosen_frames(options.frames, file, "--frames");
  for (const std::uint64_t frame : frames) file.read(frame);
  auto next = frames.begin();
  write_output(output, [&] { return next == frames.end() ? std::string() : text(file.read(*next++)); });
}

}  // namespace peclet::engine
