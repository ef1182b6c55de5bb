// The program peclet-engine: its command line and exit codes.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <csignal>
#include <exception>
#include <limits>

#include "contract/errors.h"
#include "contract/frames.h"
#include "contract/named_files.h"
#include "contract/provenance.h"
#include "contract/usage_fault.h"
#include "engine/forces/configuration.h"
#include "engine/pictures/colouring.h"
#include "engine/pictures/picture.h"
#include "engine/realisation/job.h"
#include "engine/realisation/result.h"
#include "engine/scene/composition.h"
#include "engine/scene/measured_sizes.h"
#include "engine/snapshots/conversion.h"
#include "engine/state/threads.h"

namespace {

using namespace peclet;
using namespace peclet::engine;

volatile std::sig_atomic_t stop_requested = 0;

void request_stop(int signal) {
  stop_requested = 1;
  std::signal(signal, SIG_DFL);  // a second signal ends the process at once
}

// Limits of a configuration: some 100000 spheres, each with about 13 values and 200 bytes.
constexpr InputLimits configuration_limits{std::size_t{32} << 20, 1'300'000};

struct RunOptions {
  std::string scene, output, checkpoint, extended;
  std::uint64_t seed = 0;
  int threads = 1;
  bool quiet = false;
};

// Returns a check for whole numbers; the parser's own would read "-1" as the largest number.
CLI::Validator whole_number(std::uint64_t least, std::uint64_t most) {
  return {[least, most](const std::string& text) {
            std::uint64_t number = 0;
            const char* const end = text.data() + text.size();
            const auto read = std::from_chars(text.data(), end, number);
            const bool is_one =
                read.ec == std::errc() && read.ptr == end && number >= least && number <= most;
            return is_one ? std::string()
                          : fmt::format("\"{}\" must be a whole number from {} to {}", text, least, most);
          },
          ""};
}

CLI::Validator one_of(const std::vector<std::string>& names) {
  return {[names](const std::string& text) {
            const bool is_one = std::find(names.begin(), names.end(), text) != names.end();
            return is_one ? std::string()
                          : fmt::format("\"{}\" must be one of {}", text, fmt::join(names, ", "));
          },
          fmt::format("{{{}}}", fmt::join(names, ","))};
}

// Returns the prefix of the names of files beside the result: "out." for out.json, "" for a device or a pipe.
std::string files_beside(const std::filesystem::path& output) {
  const bool is_file = std::filesystem::is_regular_file(output) || !std::filesystem::exists(output);
  return output.empty() || !is_file ? "" : std::filesystem::path(output).replace_extension("").string() + '.';
}

// Returns the file that a link leads to, so that a checkpoint replaces this file and not the link.
std::filesystem::path target_of(const std::filesystem::path& path) {
  std::error_code leads_nowhere;
  const std::filesystem::path target = std::filesystem::canonical(path, leads_nowhere);
  return leads_nowhere ? path : target;
}

int run(const RunOptions& options) {
  if (!options.output.empty()) check_output(options.output);
  if (!options.checkpoint.empty()) check_output(options.checkpoint);
  JobSpecification job;
  job.header.seed = options.seed;
  job.scene = read_json_input(options.scene);
  if (job.scene.is_object() && job.scene.contains("scene")) {
    throw InputError(options.scene, "", "", "is a campaign, not a scene; `peclet run` runs campaigns");
  }
  job.scene_name = options.scene;
  job.threads = options.threads;
  job.checkpoint = target_of(options.checkpoint);
  job.extended = target_of(options.extended);
  job.files = files_beside(options.output);
  JobEvents events;
  if (!options.checkpoint.empty()) {
    std::signal(SIGINT, request_stop);
    std::signal(SIGTERM, request_stop);
    events.drain_requested = [] { return stop_requested != 0; };
  }
  const std::optional<Json> finished = run_job(job, events);
  if (!finished) {
    fmt::print(stderr, "peclet-engine: stopped; the same command continues from {}\n", options.checkpoint);
    return ExitCode::stopped;
  }
  const Json& result = *finished;
  if (options.output.empty()) {
    fmt::print("{}", result_text(result));
  } else {
    write_output(options.output, result_text(result));
  }
  const Json& ending = result.at("ending");
  const bool completed = has_results(ending.at("cause").get<std::string>());
  if (!completed) {
    fmt::print(stderr, "{}: broke off at step {} ({}): {}\n", options.scene,
               ending.at("step").get<std::uint64_t>(), ending.at("cause").get<std::string>(),
               ending.at("message").get<std::string>());
  } else if (!options.quiet) {
    fmt::print(stderr, "{}", summary(result, options.output.empty() ? "standard output" : options.output));
  }
  return completed ? ExitCode::done : ExitCode::unconverged;
}

int forces(const std::string& path) {
  const Configuration configuration = read_configuration(read_json_input(path, configuration_limits), path);
  try {
    fmt::print("{}\n", evaluate_configuration(configuration).dump());
  } catch (const std::invalid_argument& error) {
    throw InputError(path, "/state/box/lengths", "", error.what());
  }
  return ExitCode::done;
}

int done_with(const std::string& note) {
  if (!note.empty()) fmt::print(stderr, "peclet-engine: {}\n", note);
  return ExitCode::done;
}

}  // namespace

int main(int argc, char** argv) {
  let_waiting_threads_sleep(argv);
  CLI::App app{"The particle engine of peclet: Langevin dynamics of dense suspensions.", "peclet-engine"};
  app.require_subcommand(1);
  app.set_version_flag("--version", version() + " " + provenance().at("git_commit").get<std::string>());

  RunOptions options;
  CLI::App* run_command = app.add_subcommand(
      "run", "Run one realisation of a scene: the result as JSON, and a summary on standard error");
  run_command->add_option("scene", options.scene, "Scene, a JSON file")->required();
  run_command->add_option("--seed", options.seed, "Seed of packing and noise")
      ->capture_default_str()
      ->check(whole_number(0, std::numeric_limits<std::uint64_t>::max()));
  run_command
      ->add_option("--threads", options.threads,
                   "Largest number of threads; each gets at least 4000 particles and a processor")
      ->capture_default_str()
      ->check(whole_number(1, 1024));
  run_command->add_option("--output", options.output, "File for the result instead of standard output");
  run_command->add_option("--checkpoint", options.checkpoint,
                          "Checkpoint, written every five minutes; the run resumes from it if it exists");
  run_command->add_option(
      "--extend", options.extended,
      "Checkpoint of a shorter run (its final.checkpoint), from which this run continues");
  run_command->add_flag("--quiet", options.quiet, "No summary on standard error");
  CLI::App* serve_command = app.add_subcommand("serve", "Work for `peclet run`: frames on standard input");
  std::string configuration;
  CLI::App* forces_command =
      app.add_subcommand("forces", "Compute forces, torques and stress of one configuration, term by term");
  forces_command->add_option("configuration", configuration, "Configuration, a JSON file")->required();
  ConversionOptions conversion;
  CLI::App* trajectory_command =
      app.add_subcommand("trajectory", "Convert frames of a realisation to a text for other programs");
  trajectory_command->add_option("file", conversion.file, "GSD file or extended XYZ")->required();
  trajectory_command
      ->add_option("--format", conversion.format, "lammps (dump) or xyz; else by the output's name")
      ->check(one_of({"lammps", "xyz"}));
  trajectory_command->add_option("--output", conversion.output,
                                 "File for the text instead of standard output");
  trajectory_command
      ->add_option("--frames", conversion.frames, "FIRST:LAST:STEP or one frame; -1 is the last one")
      ->capture_default_str();
  PictureOptions picture;
  picture.threads = std::min(omp_get_num_procs(), 8);
  CLI::App* snapshot_command = app.add_subcommand("snapshot", "Draw a frame as a picture");
  snapshot_command->add_option("file", picture.file, "GSD file or extended XYZ")->required();
  snapshot_command->add_option("--output", picture.output, "PNG file")->required();
  snapshot_command->add_option("--frame", picture.frame, "Number of the frame; -1 is the last one")
      ->capture_default_str();
  snapshot_command->add_option("--colour", picture.colour, "Quantity that the colours of spheres show")
      ->capture_default_str()
      ->check(one_of(names_of_colourings()));
  snapshot_command->add_flag("--chains", picture.chains,
                             "Draw contacts, as wide as their normal force, in transparent spheres");
  snapshot_command
      ->add_option("--view", picture.view, "corner; x, y or z to look along; or AZIMUTH,ELEVATION in degrees")
      ->capture_default_str();
  snapshot_command->add_option("--size", picture.size, "WIDTHxHEIGHT in pixels")->capture_default_str();
  SizesOptions sizes;
  CLI::App* sizes_command = app.add_subcommand(
      "sizes",
      "Choose the species of a scene from a measured size distribution; tells how many spheres they take");
  sizes_command->add_option("file", sizes.file, "Table of sizes and shares, as an instrument saves it")
      ->required();
  sizes_command->add_option("--sizes", sizes.sizes, "Meaning of the sizes: radius or diameter")
      ->required()
      ->check(one_of({"radius", "diameter"}));
  sizes_command->add_option("--shares", sizes.shares, "Meaning of the shares: volume or number")
      ->required()
      ->check(one_of({"volume", "number"}));
  sizes_command->add_option("--columns", sizes.columns,
                            "Columns of size and share, such as 1,3, if there are more than two");
  sizes_command
      ->add_option("--count", sizes.count,
                   "Number of spheres of the scene: rare sizes are merged until each has one sphere")
      ->check(whole_number(1, most_particles));
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (words == std::vector<std::string>{"version"}) words.front() = "--version";
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // as the parser wants them
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // help or version
    fmt::print(stderr, "peclet-engine: {}\n", usage_fault(app, words, error));
    return ExitCode::usage;
  }

  try {
    if (*run_command) return run(options);
    if (*serve_command) return serve(0);
    if (*forces_command) return forces(configuration);
    if (*trajectory_command) return done_with(convert_trajectory(conversion));
    if (*snapshot_command) return done_with(draw_picture(picture));
    if (*sizes_command) {
      const SizesAnswer answer = choose_sizes(sizes);
      fmt::print(stderr, "{}", answer.remarks);
      fmt::print("{}", answer.block);
      return ExitCode::done;
    }
  } catch (const InputError& error) {
    fmt::print(stderr, "peclet-engine: {}\n", error.what());
    return ExitCode::usage;
  } catch (const FrameError& error) {
    fmt::print(stderr, "peclet-engine: {}\n", error.what());
    return ExitCode::usage;
  } catch (const IntegrityError& error) {
    fmt::print(stderr, "peclet-engine: {}\n", error.what());
    return ExitCode::integrity;
  } catch (const std::exception& error) {
    fmt::print(stderr, "peclet-engine: {}\n", error.what());
    return is_impossible_name(error) ? ExitCode::usage : ExitCode::error;
  }
  return ExitCode::error;
}
