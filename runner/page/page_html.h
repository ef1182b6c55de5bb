// The verb `peclet report`: a campaign on one page, for an adviser or a paper's supplement.
//
// The page is a single file that needs no other and no network. It depends only on the database and on the
// process that runs the campaign; the same ones give the same bytes at any time.
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
extern const std::array<const char*, 12> page_scripts;  // in this order
// python/peclet/drawing.py. With `FIGURE = ...` and `main(FIGURE)` behind it, it draws that figure.
extern const char* const drawing_script;

// Returns the Content-Security-Policy, which allows the page its own script and a live one its own server.
std::string page_policy(bool live);
// Returns a hash of template, style and script.
std::string page_program();

// Returns the page with this document in it, which is live if it has the member "live". The page's policy
// allows no script but its own, whatever the document says.
std::string page_html(const Json& data);

// Returns the page of a campaign. Throws IntegrityError if stored stop tests and results do not agree.
std::string report_html(Database& database, std::optional<std::int64_t> owner = std::nullopt);

}  // namespace peclet::runner
