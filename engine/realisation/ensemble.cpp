#include "engine/realisation/ensemble.h"

#include <omp.h>

#include <cstdio>

#include "engine/card/card_ptx.h"
#include "engine/card/cuda_driver.h"
#include "engine/realisation/card_ensemble.h"

namespace peclet::engine {

Device device_named(const std::string& text, const std::string& asked) {
  if (text == "cuda") return Device::cuda;
  if (text == "auto") return Device::automatic;
  if (text == "emulated") return Device::emulated;
  throw InputError(asked, "", text, "must be cuda or auto; or emulated, for tests");
}

std::unique_ptr<Ensemble> make_ensemble(Device device, int number, const std::string& asked) {
  if (device == Device::processor) return nullptr;
  if (device == Device::emulated) {
    return std::make_unique<CardEnsemble>(emulated_card(static_cast<std::size_t>(omp_get_num_procs())));
  }
  std::optional<std::string> lack = why_no_card();
  if (!lack && card_ptx(0).empty())
    lack = "this program was built without clang, which compiles kernels for cards";
  if (!lack) {
    try {
      return std::make_unique<CardEnsemble>(cuda_card(number));
    } catch (const CardError& error) {
      lack = error.what();
    }
  }
  if (device == Device::cuda) throw InputError(asked, "", "cuda", "no card: " + *lack);
  std::fprintf(stderr, "%s: no card: %s; the processor runs the scenes\n", asked.c_str(), lack->c_str());
  return nullptr;
}

}  // namespace peclet::engine
