// A scene: what is simulated, checked for form (the table of keys) and then for meaning.
//
// A block that is absent is physics that is not computed; std::optional says so here.
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

// The physics of a scene without its particles: all that forces depend on. Of each conservative law it has an
// optional.
struct Physics : EachConservativeLaw<std::optional> {
  double viscosity = 0;
  double thermal_energy = 0;  // k_B T
  ImposedFlow flow;
  std::optional<ContactParameters> contact;
  std::optional<LubricationParameters> lubrication;
};

// Stresses are in units of viscosity times rate where one rate is steady, else in the scene's.
inline double unit_of_stress(const Physics& physics) {
  return physics.flow.steady_rate() > 0 ? physics.viscosity * physics.flow.steady_rate() : 1;
}
inline const char* name_of_stress_unit(const Physics& physics) {
  return physics.flow.steady_rate() > 0 ? "η γ̇" : "stress";
}

// Why there is no equilibrium whose probabilities are known to be exp(-H / kT); empty where there is one.
std::string lacking_equilibrium(const Physics& physics);
inline bool has_known_equilibrium(const Physics& physics) { return lacking_equilibrium(physics).empty(); }

// Of the residual of implicit steps, where the document gives none. With noise errors average out.
inline constexpr double usual_tolerance = 2e-3, usual_tolerance_with_noise = 4e-3;

// Ends with the first of its limits that is reached; infinity where there is none or where the scene cannot
// reach it (strain without shear, Brownian times without temperature). One at least is finite. A limit of 0
// in the document makes time 0 and the others infinite. Cycles are a least time.
struct Duration {
  double strain = std::numeric_limits<double>::infinity();
  double brownian_times = std::numeric_limits<double>::infinity();  // units of eta a^3 / kT
  double time = std::numeric_limits<double>::infinity();
  double least_time = 0;
  double period = 0;  // of which it lasts a whole number; 0: of none
};

// Limits that end a realisation with a named cause, and one beyond which its result is flagged.
struct Guard {
  double largest_overlap = 0.05;       // of the smaller radius of the pair
  double largest_displacement = 0.05;  // per step, of the smallest radius of all
  // Beyond these there is only a warning.
  double energy_imbalance = 0.3;       // of the flow's work
  double half_step_difference = 0.03;  // of the stress
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

// Where spheres begin, if not in a packing: at a frame of one file, or of one from a list for each seed.
struct Start {
  bool is_list = false;
  std::string path, sha256;
  std::int64_t frame = -1;

  const char* pointer() const { return is_list ? "/start/list" : "/start/file"; }
};

class Observable;
struct Scene;
struct Window;
// Makes an observable that a scene lists, with its settings. `file` names the scene in messages. Throws
// InputError where box or window are too small.
using MakeObservable = std::function<std::unique_ptr<Observable>(const Scene& scene, const Window& window,
                                                                 const std::string& file)>;

struct Scene {
  Particles particles;
  double volume_fraction = 0;
  std::optional<double> height;  // of the box along y; absent: a cube
  Physics physics;
  Method method = Method::explicit_steps;
  std::optional<double> timestep;             // absent: "auto"
  double solver_tolerance = usual_tolerance;  // of implicit steps
  Duration equilibration, production;
  std::map<std::string, MakeObservable> observables;  // besides the stress
  Guard guard;
  std::optional<Start> start;
  bool final_configuration = false, final_checkpoint = false;  // are left beside the result
  Json document;                                               // as given, defaults filled
};

// Edges of the box that is as large as a cube of this edge.
Vector3 box_lengths(const Scene& scene, double cube_edge);

// The time, from then on, after which the first of the limits is reached.
double time_of(const Duration& duration, const Scene& scene, double from = 0);

// Returns every key of a scene, the one list behind validation, schema/scene.schema.json and the manual's
// page. The rows of its observables are given.
KeyTable scene_keys_with(const std::string& keys_of_observables);

// Reads a document whose keys are valid, all but its observables. `file` names it in messages. Throws
// InputError.
Scene read_without_observables(const Json& document, const std::string& file);

// Reads a duration at this pointer. Throws InputError if it would never end.
Duration read_duration(const SceneDocument& document, const std::string& pointer, const Physics& physics);

// The blocks that read_physics() reads: fluid, flow and those of the laws.
std::vector<std::string> blocks_of_physics();

// Reads these blocks alone (a configuration's "scene").
Physics read_physics(const Json& document, const std::string& file, const std::string& pointer);

// The blocks fluid, flow and limits of a scene, and its Peclet number: how the solvent moves.
std::string flow_keys();

// Sets the flow of a scene whose fluid and laws have been read; rate and temperature where they follow from a
// Peclet number within limits. Throws InputError where no flow is given.
void set_flow(const SceneDocument& scene, const Particles& particles, double volume_fraction,
              Physics& physics);

}  // namespace peclet::engine
