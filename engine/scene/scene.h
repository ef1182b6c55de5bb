// Scene holds what is simulated, checked for form (the table of keys) and then for meaning. Physics whose
// block is absent is not computed: its std::optional is empty.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contract/json.h"
#include "contract/key_table.h"
#include "engine/flow/scene_document.h"
#include "engine/flow/shear.h"
#include "engine/scene/composition.h"
#include "engine/terms/contact.h"
#include "engine/terms/laws.h"
#include "engine/terms/lubrication.h"

namespace peclet::engine {

// Physics holds all that forces depend on, except for particles; each conservative law is optional.
struct Physics : EachConservativeLaw<std::optional> {
  double viscosity = 0;
  double thermal_energy = 0;  // k_B T
  ImposedFlow flow;
  std::optional<ContactParameters> contact;
  std::optional<LubricationParameters> lubrication;
};

// Name of the viscous stress, the product of viscosity and shear rate.
inline constexpr const char* viscous_stress_symbol = "η γ̇";

// Return the unit of stresses: viscosity times rate if the flow has a steady part, else the scene's.
inline double unit_of_stress(const Physics& physics) {
  return physics.flow.steady_rate() > 0 ? physics.viscosity * physics.flow.steady_rate() : 1;
}
inline const char* name_of_stress_unit(const Physics& physics) {
  return physics.flow.steady_rate() > 0 ? viscous_stress_symbol : "stress";
}

// Returns why the equilibrium at rest does not have the probabilities exp(-H / kT); empty if it has.
std::string lacking_equilibrium(const Physics& physics);
inline bool has_known_equilibrium(const Physics& physics) { return lacking_equilibrium(physics).empty(); }

// Default tolerances of the residual of implicit steps. With noise errors average out.
inline constexpr double usual_tolerance = 2e-3, usual_tolerance_with_noise = 4e-3;

// Duration ends at the first of its limits. A limit is infinite if it is not given or cannot be reached
// (strain without shear, Brownian times without temperature); at least one is finite. A limit of 0 in the
// document makes time 0 and the others infinite. Cycles become least_time.
struct Duration {
  double strain = std::numeric_limits<double>::infinity();
  double brownian_times = std::numeric_limits<double>::infinity();  // [eta a^3 / kT]
  double time = std::numeric_limits<double>::infinity();
  double least_time = 0;
  double period = 0;  // the duration is a whole number of these; 0: it has any length
};

// Guard holds limits that end a realisation with a named cause, or give its result a warning.
struct Guard {
  double largest_overlap = 0.05;       // over the smaller radius of the pair
  double largest_displacement = 0.05;  // per step, over the smallest radius of all
  // Warnings only:
  double energy_imbalance = 0.3;       // over the work of the flow
  double half_step_difference = 0.03;  // relative difference of the stress
};

struct Warning {
  std::string code;  // "inertia-shear", "inertia-thermal", "composition", "patience", "overlap" ...
  std::string message;

  friend void to_json(Json& json, const Warning& warning) {
    json = {{"code", warning.code}, {"message", warning.message}};
  }
};

// How the equations of motion are solved.
enum class Method { explicit_steps, implicit_steps };

// Start is a frame of a file where spheres begin, of one file for all seeds or of a list with one for each.
struct Start {
  bool is_list = false;
  std::string path, sha256;
  std::int64_t frame = -1;

  const char* pointer() const { return is_list ? "/start/list" : "/start/file"; }
};

class Observable;
struct Scene;
struct Window;
// Makes an observable with its settings. `file` names the scene in messages. Throws InputError if box or
// window is too small.
using MakeObservable = std::function<std::unique_ptr<Observable>(const Scene& scene, const Window& window,
                                                                 const std::string& file)>;

struct Scene {
  Particles particles;
  double volume_fraction = 0;
  std::optional<double> height;  // edge of the box along y; empty: a cube
  Physics physics;
  Method method = Method::explicit_steps;
  std::optional<double> timestep;             // empty: "auto"
  double solver_tolerance = usual_tolerance;  // residual of implicit steps
  Duration equilibration, production;
  std::map<std::string, MakeObservable> observables;  // besides the stress
  Guard guard;
  std::optional<Start> start;
  bool seeds_in_common = false;  // true: a seed has the same packing and noise in every such scene
  bool final_configuration = false, final_checkpoint = false;  // true: the file is left beside the result
  Json document;                                               // the scene with its defaults
};

// Returns the edges of the scene's box, whose volume is that of a cube of this edge.
Vector3 box_lengths(const Scene& scene, double cube_edge);

// Returns the length of a duration that begins at the time `from` [time].
double time_of(const Duration& duration, const Scene& scene, double from = 0);

// Returns every key of a scene: the one list behind validation, schema/scene.schema.json and the manual. The
// argument has the rows of the observables.
KeyTable scene_keys_with(const std::string& keys_of_observables);

// Reads a document whose keys are valid, except for its observables. `file` names it in messages. Throws
// InputError if values contradict each other.
Scene read_without_observables(const Json& document, const std::string& file);

// Reads a duration at this pointer. Throws InputError if it would never end.
Duration read_duration(const SceneDocument& document, const std::string& pointer, const Physics& physics);

// Returns the names of the blocks that read_physics() reads: fluid, flow and those of the laws.
std::vector<std::string> blocks_of_physics();

// Reads these blocks of a document. `file` and `pointer` name its place in messages. Throws InputError.
Physics read_physics(const Json& document, const std::string& file, const std::string& pointer);

// Returns the rows of /fluid, /flow, /peclet and /limits.
std::string flow_keys();

// Sets the flow of a scene whose fluid and laws have been read, and rate and temperature if a Peclet number
// gives them. Throws InputError if the scene has no flow, or keys that contradict it.
void set_flow(const SceneDocument& scene, const Particles& particles, double volume_fraction,
              Physics& physics);

}  // namespace peclet::engine
