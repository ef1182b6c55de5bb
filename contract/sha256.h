// Computes SHA-256 hashes, as lower-case hexadecimal.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace peclet {

std::string sha256(std::string_view bytes);
// Returns the SHA-256 in base64, as a Content-Security-Policy needs it.
std::string sha256_base64(std::string_view bytes);

// Returns the SHA-256 of the rest of an open file, piece by piece. Throws std::system_error naming the path.
std::string sha256_of_open(int file, const std::filesystem::path& path);

// Returns the SHA-256 of a file's content. Throws std::system_error naming the path.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace peclet
