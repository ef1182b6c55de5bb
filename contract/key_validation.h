// Checks a document against a table of keys and fills in its defaults.
#pragma once

#include <string>

#include "contract/key_table.h"

namespace peclet {

// Checks `document` and fills in its defaults, with the arguments of KeyTable::validate(). Throws InputError.
void validate_keys(const KeyTable& table, const std::string& file, const std::string& root, Json& document);

}  // namespace peclet
