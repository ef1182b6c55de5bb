#include "runner/live/live_site.h"

#include <exception>

#include "runner/page/page_html.h"

namespace peclet::runner {
namespace {

HttpAnswer with(std::shared_ptr<const std::string> body, const char* type) {
  HttpAnswer answer;
  answer.type = type;
  answer.body = std::move(body);
  return answer;
}

HttpAnswer nothing_new() {
  HttpAnswer answer;
  answer.status = 204;
  return answer;
}

std::string value_of(const HttpRequest& request, const char* name) {
  const auto found = request.query.find(name);
  return found == request.query.end() ? "" : found->second;
}

HttpAnswer page(LiveCampaign& campaign) {
  campaign.look();
  HttpAnswer answer = with(campaign.page(), "text/html; charset=utf-8");
  answer.policy = page_policy(true) + "; frame-ancestors 'none'";
  return answer;
}

HttpAnswer json_or(std::shared_ptr<const std::string> text, HttpAnswer otherwise) {
  return text ? with(std::move(text), "application/json") : std::move(otherwise);
}

}  // namespace

HttpAnswer answer(LiveCampaign& campaign, const HttpRequest& request) {
  if (!is_loopback_name(request.host)) return refusal(403);
  if (request.method != "GET" && request.method != "HEAD") return refusal(405);
  try {
    if (request.path == "/") return page(campaign);
    if (request.path == "/state") {
      campaign.look();
      return json_or(campaign.changes_since(value_of(request, "since")), nothing_new());
    }
    if (request.path == "/point") return json_or(campaign.details(value_of(request, "hash")), refusal(404));
  } catch (const std::exception&) {
    return refusal(500);
  }
  // Browsers ask for an icon, and complain where there is none.
  return request.path == "/favicon.ico" ? nothing_new() : refusal(404);
}

}  // namespace peclet::runner
