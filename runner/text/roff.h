// Text for man(1) pages.
#pragma once

#include <string>
#include <string_view>

namespace peclet::runner {

// Running text, UTF-8, of several words and lines: as it is to be read, in ASCII. What stands between
// `backticks` becomes bold.
std::string roff_text(std::string_view text);

// A word or line of a command, whose hyphens are to be copied as they are; ends without a newline.
std::string roff_code(std::string_view text);

}  // namespace peclet::runner
