#include "runner/command_line/open_to_look.h"

#include <fmt/format.h>

#include "runner/command_line/print.h"

namespace peclet::runner {

OpenCampaign open_to_look(const std::filesystem::path& given, const std::filesystem::path& chosen) {
  OpenCampaign open = open_campaign(given, chosen);
  if (is_frozen_for_us(open.directory.database())) {
    say(fmt::format(
        "note: {} may not be written by you: it is read as it is, as if nobody ran the campaign\n",
        open.directory.root().string()));
  }
  return open;
}

}  // namespace peclet::runner
