#include "engine/kernels/instruction_set.h"

#include <array>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>

#include "contract/errors.h"

namespace peclet::engine {
namespace {

constexpr std::array every_set = {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512};

const char* wanted_set() { return std::getenv("PECLET_INSTRUCTION_SET"); }

}  // namespace

const char* name_of(InstructionSet set) {
  switch (set) {
    case InstructionSet::baseline:
      return "baseline";
    case InstructionSet::avx2:
      return "avx2";
    case InstructionSet::avx512:
      return "avx512";
  }
  return "";
}

bool is_available(InstructionSet set) {
#ifdef PECLET_NEWER_SETS
  // The instructions that engine/CMakeLists.txt allows the compiler to use.
  const bool has_fma = __builtin_cpu_supports("fma") != 0;
  switch (set) {
    case InstructionSet::baseline:
      return true;
    case InstructionSet::avx2:
      return has_fma && __builtin_cpu_supports("avx2") != 0;
    case InstructionSet::avx512:
      return has_fma && __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
             __builtin_cpu_supports("avx512vl") != 0;
  }
#endif
  return set == InstructionSet::baseline;
}

bool emulated_card_is_chosen() {
  const char* const wanted = wanted_set();
  return wanted != nullptr && std::string_view(wanted) == "emulated";
}

InstructionSet chosen_instruction_set() {
  const char* const wanted = wanted_set();
  InstructionSet widest = InstructionSet::baseline;
  std::string available;
  for (const InstructionSet set : every_set) {
    if (!is_available(set)) continue;
    widest = set;
    available += (available.empty() ? "" : ", ") + std::string(name_of(set));
    if (wanted != nullptr && std::string_view(wanted) == name_of(set)) return set;
  }
  if (emulated_card_is_chosen()) {
    throw InputError(
        "PECLET_INSTRUCTION_SET", "", wanted,
        "must be an instruction set; PECLET_DEVICE=emulated makes `peclet-engine serve` emulate a card");
  }
  if (wanted != nullptr && *wanted != '\0') {
    throw InputError("PECLET_INSTRUCTION_SET", "", wanted,
                     "must be one that this processor has: " + available);
  }
  return widest;
}

PairKernel pair_kernel(InstructionSet set, const Terms& terms) {
  const unsigned code = code_of(compiled_terms(terms));
  const PairKernelTable* table = &baseline_pair_kernels;
#ifdef PECLET_NEWER_SETS
  if (set != InstructionSet::baseline) {
    table = set == InstructionSet::avx2 ? &avx2_pair_kernels : &avx512_pair_kernels;
  }
#endif
  if (table->kernel[code] == nullptr || !is_available(set)) {
    throw std::invalid_argument("no kernel is compiled for this combination of terms or instruction set");
  }
  return table->kernel[code];
}

FillNormals fill_normals([[maybe_unused]] InstructionSet set) {
#ifdef PECLET_NEWER_SETS
  switch (set) {
    case InstructionSet::avx2:
      return &avx2::fill_normals;
    case InstructionSet::avx512:
      return &avx512::fill_normals;
    case InstructionSet::baseline:
      break;
  }
#endif
  return &baseline::fill_normals;
}

const LinkKernels& link_kernels([[maybe_unused]] InstructionSet set) {
#ifdef PECLET_NEWER_SETS
  if (set != InstructionSet::baseline) {
    return set == InstructionSet::avx2 ? avx2_link_kernels : avx512_link_kernels;
  }
#endif
  return baseline_link_kernels;
}

const OneBodyKernels& one_body_kernels([[maybe_unused]] InstructionSet set) {
#ifdef PECLET_NEWER_SETS
  if (set != InstructionSet::baseline) return avx2_one_body_kernels;
#endif
  return baseline_one_body_kernels;
}

}  // namespace peclet::engine
