// Text in HTML.
#pragma once

#include <string>
#include <string_view>

namespace peclet::runner {

// `text` as it is to be read, inside an element or an attribute in quotes. Control characters that HTML does
// not allow become U+FFFD.
std::string escaped(std::string_view text);

}  // namespace peclet::runner
