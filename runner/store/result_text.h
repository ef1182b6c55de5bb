// The texts of results as engines wrote them, deflated (zlib, RFC 1950) against an earlier result of
// their point, of which they repeat every name and most of what does not fluctuate.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "runner/store/sqlite.h"

namespace peclet::runner {

// `dictionary`: the other result, or nothing.
std::string deflated(std::string_view text, std::string_view dictionary);
// Throws IntegrityError when the bytes are not what deflated() made of some text with the same dictionary, or
// when the text exceeds what a result may have (excess_of()).
std::string inflated(std::string_view bytes, std::string_view dictionary);

// Stores the text of a result that has none yet. That of the first completed realisation becomes its point's
// dictionary, which stays for good, whatever becomes of that realisation.
void store_result_text(Connection& connection, std::int64_t point, int seed, std::string_view text,
                       bool completed);

// Whether the bytes were made with this dictionary, or with none.
bool was_deflated_with(std::string_view bytes, std::string_view dictionary);

// Returns the text of a result, from a query of `document` and `dictionary` of
// result LEFT JOIN dictionary USING (point_id), in these columns. Throws IntegrityError.
std::string result_text(const Statement& query, int document, int dictionary);

}  // namespace peclet::runner
