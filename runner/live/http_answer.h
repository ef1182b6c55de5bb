// What is answered to a browser.
#pragma once

#include <memory>
#include <string>

namespace peclet::runner {

struct HttpAnswer {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::shared_ptr<const std::string> body;  // shared by all that ask for the same; null: none
  // Of a page: what it may do. Everything else may do nothing.
  std::string policy = "default-src 'none'; frame-ancestors 'none'";
};

// A page, JSON and the like.
HttpAnswer with_body(std::string body, std::string type);
// A line of text that says why not.
HttpAnswer refusal(int status);

// The head of the answer, with the empty line that ends it. One request a connection; nothing is kept by
// anybody, shown in a frame, guessed at, or told to another site.
std::string head_text(const HttpAnswer& answer);

}  // namespace peclet::runner
