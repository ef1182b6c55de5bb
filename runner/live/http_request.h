// What a browser asks for: the head of an HTTP/1.1 request (RFC 9110, RFC 9112), as far as looking needs it.
//
// There is no HTTP library in it: Debian has cpp-httplib as a shared library with OpenSSL behind it, which
// programs without shared libraries cannot have, and every verb would load.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <variant>

namespace peclet::runner {

struct HttpRequest {
  std::string method;                        // "GET"
  std::string path;                          // "/state", decoded
  std::map<std::string, std::string> query;  // decoded; of a name that comes twice the first value
  std::string host;                          // as the browser calls this server, with its port
};

// Longest head of a request, in bytes.
constexpr std::size_t longest_head = 8192;

// Where the head ends, behind its empty line; npos when it is not all there yet.
std::size_t end_of_head(std::string_view text);

// Of a whole head: the request, or the status of the answer that refuses it: 400 for what is no request, 505
// for another HTTP. Bodies are no part of it.
std::variant<HttpRequest, int> read_head(std::string_view head);

// Whether a request calls this machine by a name that only this machine has. A page from elsewhere whose name
// was made to lead here (DNS rebinding) calls it by its own. Any port will do: it may be one that ssh
// forwards.
bool is_loopback_name(std::string_view host);

}  // namespace peclet::runner
