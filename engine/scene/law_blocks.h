// The blocks of a scene that are laws of pairs, in the order of the manual. A law's keys and what they mean
// stand in its own header.
#pragma once

#include "engine/scene/attraction_block.h"
#include "engine/scene/contact_block.h"
#include "engine/scene/lubrication_block.h"
#include "engine/scene/repulsion_block.h"
#include "engine/scene/scene.h"

namespace peclet::engine {

struct LawBlock {
  const char* name;
  const char* keys;
  void (*read)(const SceneDocument& scene, Physics& physics);  // of a scene that has the block
};

inline constexpr LawBlock law_blocks[] = {
    {"contact", contact_keys,
     [](const SceneDocument& scene, Physics& physics) { physics.contact = read_contact(scene); }},
    {"lubrication", lubrication_keys,
     [](const SceneDocument& scene, Physics& physics) { physics.lubrication = read_lubrication(scene); }},
    {"repulsion", repulsion_keys,
     [](const SceneDocument& scene, Physics& physics) { physics.repulsion = read_repulsion(scene); }},
    {"attraction", attraction_keys,
     [](const SceneDocument& scene, Physics& physics) { physics.attraction = read_attraction(scene); }},
};

}  // namespace peclet::engine
