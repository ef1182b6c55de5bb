// SHA-256 of bytes, as lower-case hexadecimal.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace peclet {

std::string sha256(std::string_view bytes);
// The same in base64, as web browsers want it.
std::string sha256_base64(std::string_view bytes);

// Of what is left to read of an open file, which need not fit into memory. Throws std::system_error naming
// the path.
std::string sha256_of_open(int file, const std::filesystem::path& path);

// Of a file's content. Throws std::system_error when it cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace peclet
