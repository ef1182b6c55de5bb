#include "runner/stores/vocabulary_store.h"

namespace peclet::runner {

void keep_vocabulary(Database& database, const Vocabulary& vocabulary) {
  Connection& connection = database.connection();
  Transaction transaction(connection);
  Statement(connection, "DELETE FROM vocabulary").run();
  Statement(connection, "INSERT INTO vocabulary (document) VALUES (?)")
      .bind(vocabulary.document().dump())
      .run();
  transaction.commit();
}

Vocabulary kept_vocabulary(Database& database) {
  Statement kept(database.connection(), "SELECT document FROM vocabulary");
  return kept.step() ? Vocabulary(Json::parse(kept.text(0))) : Vocabulary();
}

}  // namespace peclet::runner
