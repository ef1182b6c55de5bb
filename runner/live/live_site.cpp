#include "runner/live/live_site.h"

#include <algorithm>
#include <cctype>
#include <exception>
#include <string>
#include <utility>

#include "runner/page/page_html.h"

namespace peclet::runner {
namespace {

HttpAnswer nothing_new() { return {.status = 204}; }

HttpAnswer page(LiveCampaign& campaign) {
  campaign.look();
  return {.type = "text/html; charset=utf-8",
          .body = campaign.page(),
          .policy = page_policy(true) + "; frame-ancestors 'none'"};
}

HttpAnswer json_or(std::shared_ptr<const std::string> text, HttpAnswer otherwise) {
  return text ? HttpAnswer{.type = "application/json", .body = std::move(text)} : std::move(otherwise);
}

}  // namespace

HttpAnswer answer(LiveCampaign& campaign, const HttpRequest& request) {
  if (!is_loopback_name(request.host)) return refusal(403);
  if (request.method != "GET" && request.method != "HEAD") return refusal(405);
  const std::size_t mark = std::min(request.target.find('?'), request.target.size());
  const std::string path = request.target.substr(0, mark);
  // The page asks with one name. Tokens and hashes have no characters that are percent-encoded.
  const auto value_of = [&](const std::string& start) {
    return request.target.compare(mark, start.size(), start) == 0 ? request.target.substr(mark + start.size())
                                                                  : "";
  };
  try {
    if (path == "/") return page(campaign);
    if (path == "/state") {
      campaign.look();
      return json_or(campaign.changes_since(value_of("?since=")), nothing_new());
    }
    if (path == "/point") return json_or(campaign.details(value_of("?hash=")), refusal(404));
  } catch (const std::exception&) {
    return refusal(500);
  }
  // Browsers ask for an icon, and complain where there is none.
  return path == "/favicon.ico" ? nothing_new() : refusal(404);
}

bool is_loopback_name(std::string_view host) {
  const std::size_t colon = host.rfind(':');
  if (colon != std::string_view::npos && host.find(']', colon) == std::string_view::npos) {
    const std::string_view port = host.substr(colon + 1);
    if (!std::all_of(port.begin(), port.end(), [](unsigned char c) { return std::isdigit(c) != 0; }))
      return false;
    host = host.substr(0, colon);
  }
  std::string name(host);
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name == "127.0.0.1" || name == "localhost" || name == "[::1]";
}

}  // namespace peclet::runner
