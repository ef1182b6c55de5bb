// Requests from which the fuzzer of the live server makes others, and pieces that it puts into them.
#pragma once

#include <array>
#include <string_view>

namespace peclet::runner {

using namespace std::string_view_literals;

// POINT and TOKEN stand for the hash of a point and for the token of the state.
constexpr std::array http_corpus{
    "GET / HTTP/1.1\r\nHost: localhost:7325\r\n\r\n"sv,
    "HEAD / HTTP/1.0\r\nHost: 127.0.0.1\r\nConnection: keep-alive\r\n\r\n"sv,
    "GET /state?since= HTTP/1.1\r\nHost: [::1]:1\r\nAccept: */*\r\n\r\n"sv,
    "GET /state?since=TOKEN HTTP/1.1\r\nHost: localhost\r\n\r\n"sv,
    "GET /point?hash=POINT HTTP/1.1\r\nHost: localhost\r\n\r\n"sv,
    "GET /p%6Fint?x=1&hash=POINT&hash=2#f HTTP/1.1\r\nhOST:\t LOCALHOST:80 \r\n\r\n"sv,
    "GET /favicon.ico HTTP/1.1\r\nHost: localhost\r\nCookie: a=b; c=d\r\n\r\n"sv,
    "GET /../../etc/passwd HTTP/1.1\r\nHost: localhost\r\n\r\n"sv,
    "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\n\r\nhello"sv,
    "POST /state HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n5\r\nhello\r\n0\r\n\r\n"sv,
    "GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n"sv,
    "GET / HTTP/1.1\r\nHost: localhost\r\nHost: localhost\r\n\r\n"sv,
    "GET http://localhost/ HTTP/1.1\r\nHost: localhost\r\n\r\n"sv,
    "OPTIONS * HTTP/1.1\r\nHost: localhost\r\n\r\n"sv,
    "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"sv,
    "GET / HTTP/1.1\r\nHost: localhost\r\n folded\r\n\r\n"sv,
    "GET /%00%ff%zz HTTP/1.1\r\nHost: localhost\r\n\r\n"sv,
    "\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n"sv,
    "\r\n\r\n"sv,
    "GET /\r\n\r\n"sv,
};

constexpr std::array http_pieces{"\r\n"sv,
                                 "\r\n\r\n"sv,
                                 "\n"sv,
                                 "\r"sv,
                                 "\0"sv,
                                 " "sv,
                                 "\t"sv,
                                 ":"sv,
                                 "?"sv,
                                 "&"sv,
                                 "="sv,
                                 "%"sv,
                                 "%0d%0a"sv,
                                 "%2e%2e%2f"sv,
                                 "HTTP/1.1"sv,
                                 "HTTP/1.0"sv,
                                 "HTTP/9"sv,
                                 "GET "sv,
                                 "HEAD "sv,
                                 "POST "sv,
                                 "Host: localhost\r\n"sv,
                                 "/state"sv,
                                 "/point"sv,
                                 "since="sv,
                                 "hash="sv,
                                 "TOKEN"sv,
                                 "POINT"sv,
                                 "-1"sv,
                                 "2147483648"sv,
                                 "18446744073709551616"sv,
                                 "localhost"sv,
                                 "127.0.0.1"sv,
                                 "[::1]"sv,
                                 "\xc3\xa9"sv,
                                 "\x7f"sv,
                                 "Content-Length: -1\r\n"sv,
                                 "\xff\xff\xff\xff"sv,
                                 "X: y\r\n"sv};

}  // namespace peclet::runner
