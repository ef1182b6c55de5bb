// Fuzz target for the payload of checkpoints; each input gets a fitting checksum.
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "contract/durable_file.h"
#include "contract/json.h"
#include "contract/sha256.h"
#include "engine/observables/scene_reading.h"
#include "engine/realisation/checkpoint.h"
#include "engine/realisation/schedule.h"
#include "tests/fuzz/fuzz_target.h"

namespace {

using namespace peclet;
using namespace peclet::engine;

namespace fs = std::filesystem;

const CheckpointIdentity belonging = {"a scene", 7, "a binary"};

const Scene& scene() {
  static const Scene read = read_scene(Json::parse(R"({
    "particles": {"count": 20, "density": 0.1, "species": [{"radius": 1}]},
    "volume_fraction": 0.3,
    "fluid": {"viscosity": 0.1, "thermal_energy": 0.02},
    "flow": {"shear_rate": 2},
    "contact": {"normal_stiffness": 1e4, "friction": 0.5},
    "lubrication": {"form": "kim-karrila", "inner_gap": 0.03, "outer_gap": 0.1},
    "integrator": {"method": "explicit", "timestep": 0.002},
    "guard": {"largest_overlap": 0.2, "largest_displacement": 0.2},
    "observables": ["stress", "mean_squared_displacement"],
    "duration": {"equilibration": {"time": 0.02}, "production": {"time": 0.4}}})"),
                                       "scene");
  return read;
}

Simulation fresh() { return Simulation(scene(), make_schedule(scene(), ""), 7, 1, ""); }

// A file of this process alone.
struct CheckpointFile {
  CheckpointFile() : path(fs::temp_directory_path() / ("fuzz-checkpoint-" + std::to_string(::getpid()))) {}
  ~CheckpointFile() { fs::remove(path); }
  fs::path path;
};
const fs::path& path() {
  static const CheckpointFile file;
  return file.path;
}

constexpr std::size_t before_length = 12, before_payload = 20, after_payload = 64;

// Returns the bytes of checkpoints after 2 and 30 steps.
const std::vector<std::string>& written() {
  static const std::vector<std::string> files = [] {
    std::vector<std::string> all;
    Simulation simulation = fresh();
    simulation.start();
    for (const std::uint64_t steps : {2U, 28U}) {
      simulation.advance(steps);
      write_checkpoint(path(), belonging, {}, simulation);
      all.push_back(read_file(path()));
    }
    return all;
  }();
  return files;
}

}  // namespace

std::size_t inputs_accepted = 0;

// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string payload(data, data + size);
  std::string bytes = written().front().substr(0, before_length);
  const std::uint64_t length = size;
  bytes.append(reinterpret_cast<const char*>(&length), sizeof length);
  std::ofstream(path(), std::ios::binary) << bytes + payload + sha256(payload);
  try {
    Simulation simulation = fresh();
    read_checkpoint(path(), belonging, simulation);
    ++inputs_accepted;
  } catch (const CheckpointError&) {  // refused with a message
  }
  return 0;
}

std::vector<std::string> valid_inputs() {
  std::vector<std::string> inputs;
  for (const std::string& whole : written()) {
    inputs.push_back(whole.substr(before_payload, whole.size() - before_payload - after_payload));
  }
  return inputs;
}
