// All flows: the one list of them, and what a scene may say of any.
#pragma once

#include "engine/flow/flow_kind.h"

namespace peclet::engine {

// The first is the flow of a scene that asks for no other: shear at a rate, or a fluid at rest.
const std::vector<FlowKind>& flow_kinds();

// Returns the keys of the flows that have this unit of durations: "/flow/oscillation or /flow/cross_shear".
std::string flows_with(const std::string& unit);

// Returns the kind of flow that the scene asks for. Throws InputError where keys of another one stand beside
// it.
const FlowKind& flow_kind_of(const SceneDocument& scene);

ImposedFlow read_flow(const FlowSource& source);

// Keys of a duration, by limits that `limit` makes; some of them are known to some flows alone.
Keys duration_keys(const std::string& pointer, const std::string& meaning,
                   Key (*limit)(std::string, std::string, std::string, bool), bool is_required = required);

// Throws InputError where the duration at this place has a limit that the flow does not know.
void check_duration(const SceneDocument& scene, const FlowKind& flow, const std::string& pointer);

}  // namespace peclet::engine
