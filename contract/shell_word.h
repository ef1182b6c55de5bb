// Quotes texts for a shell.
#pragma once

#include <string>

namespace peclet {

// Returns true if shells and batch systems take all characters of the text as they are; false for "".
bool is_plain(const std::string& text);

// Returns true if the text has a character below space, or DEL. A path on a line of text must not have one.
bool has_control_characters(const std::string& text);

// Returns the text as one word of a shell; plain text stays as it is. A text with control characters becomes
// $'...', which bash, zsh and ksh know.
std::string shell_word(const std::string& text);

}  // namespace peclet
