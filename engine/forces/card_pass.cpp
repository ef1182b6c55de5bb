#include "engine/forces/card_pass.h"

#include <algorithm>
#include <array>
#include <utility>

#include "engine/card/card_pairs.h"

namespace peclet::engine {
namespace {

// Kernels for cards have all terms; a law that is absent has no parameters.
Physics with_only(const Terms& terms, Physics physics) {
  if (!terms.lubrication) physics.lubrication.reset();
  if (!terms.contact) physics.contact.reset();
  if (physics.contact) {
    if (!terms.damping) physics.contact->normal_damping = 0;
    if (!terms.friction) physics.contact->friction = 0;
    if (!terms.rolling) physics.contact->rolling_stiffness = 0;
  }
  if (!terms.conservative) {
    for_each_conservative_law([](StressTerm /*part*/, auto& law) { law.reset(); }, physics);
  }
  return physics;
}

template <Terms terms>
void add_stress(const CardTotals& totals, PairSums& sums) {
  for (std::size_t t = 0; t < count_of_stress_terms; ++t) {
    if (!CardStresses<terms>::has(t)) continue;
    const double* const from = totals.sum + CardStresses<terms>::place(t);
    sums.stress[t] += SymmetricTensor{from[0], from[1], from[2], from[3], from[4], from[5]};
  }
}

// Evaluates the terms of a variant, and the noise of pairs if `normals` are given.
template <Terms terms>
PairSums evaluate_variant(const CardPairs& pairs, const CardLevel& level,
                          const std::vector<NormalPair>* normals, VectorField& force, VectorField& torque) {
  using Forces = CardForces<terms>;
  const CardTeam team{};
  const Forces forces(pairs.scene(), pairs.own(), pairs.progress(), team);
  const auto moment = pairs.moment<terms>(level);
  const auto add_rows = [&] {
    for (std::uint32_t i = 0; i < pairs.scene().particles; ++i) {
      const auto [f, t] = forces.pairs_of_row(i);
      force.add(i, {f.x.v, f.y.v, f.z.v});
      torque.add(i, {t.x.v, t.y.v, t.z.v});
    }
  };
  PairSums sums;
  add_stress<terms>(forces.evaluate(moment, CardField::whole), sums);
  add_rows();
  if (normals == nullptr) return sums;
  const auto given = [&](std::uint32_t p) {
    const auto vector = [](const Vector3& v) { return CardVector{v.x, v.y, v.z}; };
    const NormalPair& of_pair = (*normals)[p];
    return PairNormalsOf<CardNumber>{vector(of_pair.first), vector(of_pair.second)};
  };
  add_stress<Forces::noise_terms>(forces.evaluate_noise_of(moment, given), sums);
  add_rows();
  return sums;
}

using Evaluate = decltype(&evaluate_variant<Terms{}>);

template <unsigned... numbers>
constexpr std::array<Evaluate, sizeof...(numbers)> every_variant(
    std::integer_sequence<unsigned, numbers...> /*numbers*/) {
  return {&evaluate_variant<card_variant(numbers).terms()>...};
}

}  // namespace

std::optional<InputError> refusal_by_card(const Physics& physics, const NeighbourList& list) {
  const auto refuse = [](const char* allowed) {
    return InputError("PECLET_INSTRUCTION_SET", "", "emulated", allowed);
  };
  if (dynamic_cast<const SteadyShear*>(&physics.flow.deformation()) == nullptr || physics.flow.varies()) {
    return refuse("must be absent in this flow: kernels for cards have steady shear without waves");
  }
  if (!std::ranges::all_of(list.images(), &CardPairs::has_room_for)) {
    return refuse("must be absent here: kernels for cards have images within 127 cells");
  }
  return std::nullopt;
}

PairSums evaluate_as_card(const Physics& physics, const Terms& terms, const PairPassInput& input,
                          SpringField& springs, VectorField& force, VectorField& torque) {
  constexpr auto evaluate = every_variant(std::make_integer_sequence<unsigned, count_of_card_variants>{});
  const Physics own = with_only(terms, physics);
  CardPairs pairs(own, input.particles, input.list, input.box);
  pairs.set_springs(springs);
  CardLevel level{};
  PairParameters parameters = card_parameters(own, 0);
  parameters.spring_timestep = input.parameters.spring_timestep;
  parameters.noise_amplitude = input.parameters.noise_amplitude;
  level.field[static_cast<std::size_t>(CardField::whole)] = parameters;
  // As in a step that inertia does not carry: the resistance is among the other forces.
  parameters.step_resistance.part = StepResistance::Part::none;
  level.field[static_cast<std::size_t>(CardField::with_noise)] = parameters;
  const PairSums sums = evaluate[card_variant_of(own).number()](
      pairs, level, terms.noise ? input.given_noise : nullptr, force, torque);
  if (terms.friction) pairs.get_springs_after(springs);
  return sums;
}

}  // namespace peclet::engine
