#include "runner/page/key_names.h"

#include <map>

namespace peclet::runner {

const KeyName* key_name(const std::string& pointer) {
  static const std::map<std::string, KeyName> names{
      {"/peclet", {"Péclet number", "Pe"}},
      {"/volume_fraction", {"volume fraction", "phi"}},
      {"/flow/shear_rate", {"shear rate", "γ̇"}},
      {"/flow/extension_rate", {"extension rate", "ε̇"}},
      {"/flow/uniaxial_rate", {"uniaxial extension rate", "ε̇"}},
      {"/flow/stress", {"shear stress", "sigma"}},
      {"/flow/oscillation/amplitude", {"amplitude of the strain", "gamma_0"}},
      {"/flow/oscillation/frequency", {"angular frequency", "omega"}},
      {"/flow/cross_shear/amplitude", {"amplitude of the strain across", "gamma_0"}},
      {"/flow/cross_shear/frequency", {"angular frequency across", "omega"}},
      {"/contact/friction", {"coefficient of friction", "mu"}},
      {"/contact/kinetic_friction", {"coefficient of kinetic friction", "mu_k"}},
      {"/contact/rolling_friction", {"coefficient of rolling friction", "mu_r"}},
      {"/contact/normal_stiffness", {"normal stiffness", "k_n"}},
      {"/particles/mixture/alpha", {"share of grains in the solid volume", "alpha"}},
      {"/addition/base_volume_fraction", {"volume fraction before the addition", "phi_0"}},
      {"/particles/count", {"number of particles", "N"}},
      {"/fluid/viscosity", {"viscosity of the fluid", "eta"}},
      {"/fluid/thermal_energy", {"thermal energy", "k_B T"}},
      {"/particles/density", {"density of the particles", "rho"}}};
  const auto found = names.find(pointer);
  return found == names.end() ? nullptr : &found->second;
}

}  // namespace peclet::runner
