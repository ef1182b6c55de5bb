// The program peclet-engine: its command line and exit codes.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <limits>
#include <mutex>

#include "contract/documents.h"
#include "contract/errors.h"
#include "contract/frames.h"
#include "contract/named_files.h"
#include "contract/provenance.h"
#include "contract/scene_script.h"
#include "contract/usage_fault.h"
#include "engine/forces/configuration.h"
#include "engine/pictures/colouring.h"
#include "engine/pictures/film.h"
#include "engine/pictures/picture.h"
#include "engine/realisation/crew.h"
#include "engine/realisation/job.h"
#include "engine/realisation/result.h"
#include "engine/realisation/serve.h"
#include "engine/realisation/start_block.h"
#include "engine/scene/composition.h"
#include "engine/scene/measured_sizes.h"
#include "engine/snapshots/conversion.h"
#include "engine/state/threads.h"

namespace {

using namespace peclet;
using namespace peclet::engine;

std::atomic<bool> stop_requested = false;

void request_stop(int signal) {
  stop_requested = true;
  std::signal(signal, SIG_DFL);  // a second signal ends the process at once
}

// Limits of a configuration: some 100000 spheres, each with about 13 values and 200 bytes.
constexpr InputLimits configuration_limits{std::size_t{32} << 20, 1'300'000};

struct RunOptions {
  std::string scene, output, checkpoint, extended;
  std::uint64_t seed = 0;
  std::string seeds;  // FIRST..LAST; empty: one seed
  std::string device = "none";
  int threads = 1;
  bool quiet = false;
};

constexpr std::uint64_t largest_seed = std::numeric_limits<std::uint64_t>::max();

// Returns the whole number that a text is, if it is one.
std::optional<std::uint64_t> whole(std::string_view text) {
  std::uint64_t number = 0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, number);
  return read.ec == std::errc() && read.ptr == end ? std::optional(number) : std::nullopt;
}

// Returns a check for whole numbers; the parser's own would read "-1" as the largest number.
CLI::Validator whole_number(std::uint64_t least, std::uint64_t most) {
  return {[least, most](const std::string& text) {
            const std::optional<std::uint64_t> number = whole(text);
            const bool is_one = number && *number >= least && *number <= most;
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

// Returns the name of one seed's file: out.SEED.json for out.json.
std::string file_of_seed(const std::filesystem::path& path, std::uint64_t seed) {
  if (path.empty()) return "";
  return std::filesystem::path(path).replace_extension(fmt::format("{}{}", seed, path.extension().string()));
}

// Returns the options of each seed. Throws InputError for options that do not go together.
std::vector<RunOptions> each_seed(const RunOptions& options) {
  if (options.seeds.empty()) return {options};
  const std::size_t dots = options.seeds.find("..");
  const bool has_dots = dots != std::string::npos;
  const std::string_view text = options.seeds;
  const auto first = has_dots ? whole(text.substr(0, dots)) : std::nullopt;
  const auto last = has_dots ? whole(text.substr(dots + 2)) : std::nullopt;
  if (!first || !last || *last < *first || *last - *first >= std::uint64_t{most_realisations}) {
    throw InputError("--seeds", "", options.seeds,
                     fmt::format("must be FIRST..LAST, {} seeds at most", most_realisations));
  }
  if (options.output.empty()) {
    throw InputError("--seeds", "", options.seeds, "needs --output, after which the results are named");
  }
  std::vector<RunOptions> all(*last - *first + 1, options);
  for (std::size_t k = 0; k < all.size(); ++k) {
    all[k].seed = *first + k;
    all[k].output = file_of_seed(options.output, all[k].seed);
    all[k].checkpoint = file_of_seed(options.checkpoint, all[k].seed);
  }
  return all;
}

// Runs one seed, with a crew if there is one. Returns the exit code.
int run_seed(const RunOptions& options, const Json& scene, Crew* crew) {
  JobSpecification job;
  job.header.seed = options.seed;
  job.scene = scene;
  job.scene_name = options.scene;
  job.threads = options.threads;
  job.checkpoint = target_of(options.checkpoint);
  job.extended = target_of(options.extended);
  job.files = files_beside(options.output);
  JobEvents events;
  if (!options.checkpoint.empty()) events.drain_requested = [] { return stop_requested.load(); };
  const std::optional<Json> finished = crew != nullptr ? crew->run(job, events) : run_job(job, events);
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

// Runs seeds side by side. Returns the gravest of their exit codes.
int run_together(const std::vector<RunOptions>& seeds, const Json& scene, Ensemble& ensemble, Device device) {
  std::mutex mutex;  // guards the next two
  int gravest = ExitCode::done;
  std::exception_ptr error;
  Crew crew(ensemble, device);
  const auto run_one = [&](const RunOptions& options) {
    int code = ExitCode::error;
    std::exception_ptr thrown;
    try {
      code = run_seed(options, scene, &crew);
    } catch (...) {
      thrown = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    gravest = std::max(gravest, code);
    if (!error) error = thrown;
  };
  for (std::size_t next = 0;;) {
    bool is_ending = stop_requested;
    {
      const std::lock_guard lock(mutex);
      is_ending = is_ending || error;
    }
    for (; !is_ending && next < seeds.size() && crew.active() < ensemble.jobs(); ++next) {
      crew.begin([&run_one, &options = seeds[next]] { run_one(options); });
    }
    if (crew.active() == 0) {
      if (error) std::rethrow_exception(error);
      return next < seeds.size() ? std::max<int>(gravest, ExitCode::stopped) : gravest;
    }
    if (stop_requested) crew.drain();
    crew.turn();
  }
}

// Returns the number of the card that the environment chooses.
int device_number() {
  const char* const wanted = std::getenv("PECLET_DEVICE_NUMBER");
  if (wanted == nullptr || *wanted == '\0') return 0;
  constexpr std::uint64_t most = 1023;
  const std::optional<std::uint64_t> number = whole(wanted);
  if (!number || *number > most) {
    throw InputError("PECLET_DEVICE_NUMBER", "", wanted,
                     fmt::format("must be a whole number from 0 to {}", most));
  }
  return static_cast<int>(*number);
}

int run(const RunOptions& options) {
  const std::vector<RunOptions> seeds = each_seed(options);
  for (const RunOptions& one : seeds) {
    if (!one.output.empty()) check_output(one.output);
    if (!one.checkpoint.empty()) check_output(one.checkpoint);
  }
  Json scene = read_json_input(options.scene);
  if (scene.is_object() && scene.contains("scene")) {
    throw InputError(options.scene, "", "", "is a campaign, not a scene; `peclet run` runs campaigns");
  }
  add_script(scene, std::filesystem::path(options.scene).parent_path(), options.scene, "");
  std::unique_ptr<Ensemble> ensemble;
  Device device = Device::processor;
  if (options.device != "none") {
    device = device_named(options.device, "--device");
    ensemble = make_ensemble(device, device_number(), "--device");
  }
  if (!options.checkpoint.empty()) {
    std::signal(SIGINT, request_stop);
    std::signal(SIGTERM, request_stop);
  }
  if (ensemble) return run_together(seeds, scene, *ensemble, device);
  int gravest = ExitCode::done;
  for (const RunOptions& one : seeds) {
    if (stop_requested) return std::max<int>(gravest, ExitCode::stopped);
    gravest = std::max(gravest, run_seed(one, scene, nullptr));
  }
  return gravest;
}

int serve_on_device() {
  const char* const wanted = std::getenv("PECLET_DEVICE");
  if (wanted == nullptr || *wanted == '\0') return serve(0);
  const Device device = device_named(wanted, "PECLET_DEVICE");
  const std::unique_ptr<Ensemble> ensemble = make_ensemble(device, device_number(), "PECLET_DEVICE");
  return serve(0, ensemble.get(), device);
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

int done_with(const WrittenKeys& keys) {
  fmt::print(stderr, "{}", keys.remarks);
  fmt::print("{}", keys.block);
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
      ->check(whole_number(0, largest_seed));
  run_command
      ->add_option("--seeds", options.seeds,
                   "Seeds FIRST..LAST; for --output out.json the results are out.SEED.json, and "
                   "checkpoints likewise")
      ->excludes("--seed");
  run_command
      ->add_option("--device", options.device,
                   "What makes the steps: none (the processor), cuda (a card, with many seeds side by side), "
                   "auto (a card if there is one and it can run the scene), "
                   "emulated (the processor as a card, slowly, for tests)")
      ->capture_default_str()
      ->check(one_of({"none", "cuda", "auto", "emulated"}));
  run_command
      ->add_option("--threads", options.threads,
                   "Largest number of threads; each gets at least 4000 particles and a processor")
      ->capture_default_str()
      ->check(whole_number(1, 1024));
  run_command->add_option("--output", options.output, "File for the result instead of standard output");
  run_command->add_option("--checkpoint", options.checkpoint,
                          "Checkpoint, written every five minutes; the run resumes from it if it exists");
  run_command
      ->add_option("--extend", options.extended,
                   "Checkpoint of a shorter run (its final.checkpoint), from which this run continues")
      ->excludes("--seeds");
  run_command->add_flag("--quiet", options.quiet, "No summary on standard error");
  CLI::App* serve_command = app.add_subcommand("serve", "Work for `peclet run`: frames on standard input");
  std::string configuration;
  CLI::App* forces_command =
      app.add_subcommand("forces", "Compute forces, torques and stress of one configuration, term by term");
  forces_command->add_option("configuration", configuration, "Configuration, a JSON file")->required();
  ConversionOptions conversion;
  CLI::App* trajectory_command =
      app.add_subcommand("trajectory", "Convert frames of a realisation to a text for other programs");
  trajectory_command->add_option("file", conversion.file, "GSD, extended XYZ, or a file of LAMMPS or LF_DEM")
      ->required();
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
  CLI::App* snapshot_command =
      app.add_subcommand("snapshot", "Draw a frame as a picture, or frames as a film");
  snapshot_command->add_option("file", picture.file, "GSD, extended XYZ, or a file of LAMMPS or LF_DEM")
      ->required();
  snapshot_command
      ->add_option("--output", picture.output,
                   "PNG file; with --frames film.png stands for film-00000.png ... and film.mp4")
      ->required();
  CLI::Option* const one_frame =
      snapshot_command->add_option("--frame", picture.frame, "Number of the frame; -1 is the last one")
          ->capture_default_str();
  snapshot_command
      ->add_option("--frames", picture.frames,
                   "Frames of a film, FIRST:LAST:STEP; : are all. ffmpeg makes the film of their pictures")
      ->excludes(one_frame);
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
  StartOptions start;
  CLI::App* start_command = app.add_subcommand(
      "start",
      "Write the keys of a scene that begins with the spheres of a file, or of a file for each seed");
  start_command->add_option("file", start.files, "GSD, extended XYZ, or a file of LAMMPS or LF_DEM")
      ->required();
  start_command->add_option("--list", start.list, "List to write, from which seed k begins at the k-th file");
  start_command->add_option("--frame", start.frame, "Number of the frame; -1 is the last one")
      ->capture_default_str();
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
    if (*serve_command) return serve_on_device();
    if (*forces_command) return forces(configuration);
    if (*trajectory_command) return done_with(convert_trajectory(conversion));
    if (*snapshot_command) return done_with(picture.frames ? draw_film(picture) : draw_picture(picture));
    if (*sizes_command) return done_with(choose_sizes(sizes));
    if (*start_command) return done_with(start_block(start));
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
