// Values put where somebody else parses them: one function for each reader.
#pragma once

#include <string>

namespace peclet::runner {

// Consists of characters that shells and batch systems take as they are.
bool is_plain(const std::string& text);

// Some character below space, or DEL: nothing that a path in a line of text may have.
bool has_control_characters(const std::string& text);

// One word of a shell; plain text stays as it is. Control characters become $'...', which bash, zsh and ksh
// know.
std::string shell_word(const std::string& text);

// The value of an option in a line `#SBATCH ...`, or a part of it, in which % begins a pattern (%a) of
// Slurm's. (sbatch keeps a blank between double quotes, and not behind a backslash.) Requires neither control
// characters nor a backslash, after which Slurm replaces no pattern at all.
std::string sbatch_word(const std::string& text);

}  // namespace peclet::runner
