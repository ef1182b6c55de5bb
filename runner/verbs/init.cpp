#include "runner/verbs/init.h"

#include <fmt/format.h>

#include "contract/durable_file.h"
#include "contract/guarded_file.h"
#include "contract/input_error.h"
#include "contract/output_file.h"
#include "runner/campaign/campaign.h"
#include "runner/campaign/campaign_file.h"

namespace peclet::runner {
namespace {

// {0} is the name.
constexpr const char* text = R"({{
  "name": "{0}",
  "scene": {{
    "particles": {{
      "count": 100,
      "density": 0.1,
      "species": [
        {{ "radius": 1.0, "volume_share": 0.5 }},
        {{ "radius": 1.4, "volume_share": 0.5 }}
      ]
    }},
    "volume_fraction": 0.4,
    "peclet": 10,
    "limits": {{ "shear_rate": 0.045, "thermal_energy": 0.017 }},
    "fluid": {{ "viscosity": 0.1 }},
    "contact": {{ "normal_stiffness": 1e4, "friction": 0.5 }},
    "lubrication": {{ "form": "kim-karrila", "inner_gap": 1e-3, "outer_gap": 0.05 }},
    "duration": {{
      "equilibration": {{ "strain": 1, "brownian_times": 5 }},
      "production": {{ "strain": 2, "brownian_times": 10 }}
    }}
  }},
  "sweep": [
    {{ "set": "/peclet", "values": [10, 100, 1000] }}
  ],
  "target": {{ "observable": "relative_viscosity", "relative_tolerance": 0.05, "confidence": 0.95 }},
  "realisations": {{ "minimum": 10, "maximum": 200 }}
}}
)";

}  // namespace

std::string init_campaign(const InitOptions& options) {
  const std::filesystem::path& file = options.campaign;
  if (file.extension() != ".json") {
    throw InputError(file.string(), "", file.extension().string(), "must end in .json");
  }
  const std::string name = file.stem().string();
  check_campaign_name(name, file.string());
  if (!kind_of(file).empty()) {  // also a link to nothing
    throw InputError(file.string(), "", "", "is there already, and is left alone");
  }
  check_output(file);
  write_durably(file, fmt::format(fmt::runtime(text), name));
  return fmt::format(
      "{0} is written: 100 spheres, three Péclet numbers, to 5 %\n"
      "  peclet validate {1}\n"
      "  peclet run {1}\n",
      file.string(), words_for(file, ""));
}

}  // namespace peclet::runner
