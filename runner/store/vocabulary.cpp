#include "runner/store/vocabulary.h"

#include <algorithm>

namespace peclet::runner {
namespace {

// Returns "" unless the member is text.
std::string text_in(const Json& object, const char* member) {
  const auto found = object.find(member);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

// The schema of what lies one step below; null unless it is described.
const Json* below(const Json& schema, const std::string& step) {
  if (const auto items = schema.find("items"); items != schema.end()) return &*items;
  const auto properties = schema.find("properties");
  if (properties == schema.end() || !properties->is_object()) return nullptr;
  const auto found = properties->find(step);
  return found == properties->end() ? nullptr : &*found;
}

}  // namespace

Vocabulary::Vocabulary(const Json& hello) {
  for (const char* const member : {"scene_schema", "derived"}) {
    if (hello.contains(member)) document_[member] = hello[member];
  }
}

Json Vocabulary::key(const std::string& pointer) const {
  static const Json unknown = Json::object();
  const Json* schema = document_.contains("scene_schema") ? &document_["scene_schema"] : &unknown;
  for (std::size_t at = 1; at <= pointer.size() && schema->is_object();) {
    const std::size_t end = std::min(pointer.find('/', at), pointer.size());
    const Json* const next = below(*schema, pointer.substr(at, end - at));
    schema = next == nullptr ? &unknown : next;
    at = end + 1;
  }
  if (!schema->is_object()) schema = &unknown;
  return {{"pointer", pointer},
          {"words", text_in(*schema, "title")},
          {"symbol", text_in(*schema, "symbol")},
          {"unit", text_in(*schema, "unit")},
          {"meaning", text_in(*schema, "description")}};
}

void keep_vocabulary(Database& database, const Vocabulary& vocabulary) {
  Connection& connection = database.connection();
  Transaction transaction(connection);
  connection.run("DELETE FROM vocabulary");
  connection.run("INSERT INTO vocabulary (document) VALUES (?)", vocabulary.document().dump());
  transaction.commit();
}

Vocabulary kept_vocabulary(Database& database) {
  Statement kept(database.connection(), "SELECT document FROM vocabulary");
  return kept.step() ? Vocabulary(Json::parse(kept.text(0))) : Vocabulary();
}

}  // namespace peclet::runner
