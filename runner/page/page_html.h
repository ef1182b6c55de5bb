// The verb `peclet report`: a campaign on one page, for an adviser or a paper's supplement.
//
// The page is a single file that needs no other and no network. It depends on the database alone, and on who
// runs the campaign: the same one gives the same bytes at any time.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "contract/json.h"
#include "runner/store/database.h"

namespace peclet::runner {

// The files of runner/page/assets, and the script that draws figures.
extern const char* const page_template;  // with @STYLE@, @SCRIPT@ and others where they go
extern const char* const page_style;
extern const std::array<const char*, 11> page_scripts;  // in this order
// python/peclet/drawing.py. With `FIGURE = ...` and `main(FIGURE)` behind it, it draws that figure.
extern const char* const drawing_script;

// What the page may do, as a Content-Security-Policy: run its own script; a live one also ask its own server.
std::string page_policy(bool live);
// A word for what the page is made of, but for its document.
std::string page_program();

// The page with this document in it, which is live when it says so. Its policy lets nothing run but its own
// script, whatever the document says.
std::string page_html(const Json& data);

// Throws IntegrityError when stored stop tests are not what the stored results say.
std::string report_html(Database& database, std::optional<std::int64_t> owner = std::nullopt);

}  // namespace peclet::runner
