#include "runner/database/number_book.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <string>

#include "contract/endings.h"
#include "contract/integrity_error.h"

namespace peclet::runner {
namespace {

static_assert(std::endian::native == std::endian::little,
              "numbers are stored as little-endian machines have them");

std::string bytes_of(const std::vector<double>& numbers) {
  std::string bytes(numbers.size() * sizeof(double), '\0');
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

std::int64_t layout_row(Connection& connection, const std::string& text) {
  Statement known(connection, "SELECT layout_id FROM number_layout WHERE quantities = ?");
  if (known.bind(text).step()) {
    const std::int64_t id = known.integer(0);
    known.step();
    return id;
  }
  Statement(connection, "INSERT INTO number_layout (quantities) VALUES (?)").bind(text).run();
  return connection.last_insert_id();
}

}  // namespace

void store_numbers(Connection& connection, std::int64_t point, int seed, const Json& result) {
  const Json& mean = result.at("mean");
  if (!mean.is_object()) return;
  const NumberLayout layout(result);
  Statement(connection, "INSERT INTO numbers (point_id, seed, layout_id, numbers) VALUES (?, ?, ?, ?)")
      .bind(point)
      .bind(seed)
      .bind(layout_row(connection, layout.text()))
      .bind_blob(bytes_of(layout.numbers(result)))
      .run();
}

const NumberLayout& NumberBook::layout(std::int64_t id) {
  if (const auto known = layouts_.find(id); known != layouts_.end()) return known->second;
  Statement query(connection_, "SELECT quantities FROM number_layout WHERE layout_id = ?");
  if (!query.bind(id).step()) throw IntegrityError("the database holds numbers without their layout");
  return layouts_.emplace(id, NumberLayout::of_text(query.text(0))).first->second;
}

void NumberBook::for_each(std::int64_t point, int end, const Visit& visit) {
  Statement query(
      connection_,
      "SELECT seed, layout_id, numbers, cause FROM numbers JOIN realisation USING (point_id, seed) "
      "WHERE point_id = ? AND seed < ? ORDER BY seed");
  query.bind(point).bind(end);
  std::vector<double> numbers;
  while (query.step()) {
    const int seed = static_cast<int>(query.integer(0));
    const NumberLayout& about = layout(query.integer(1));
    const std::string bytes = query.text(2);
    if (bytes.size() != about.count() * sizeof(double)) {
      throw IntegrityError(fmt::format(
          "the stored numbers of seed {} are not as many as their layout says; see `peclet doctor`", seed));
    }
    numbers.resize(about.count());
    std::memcpy(numbers.data(), bytes.data(), bytes.size());
    visit({seed, is_jam(query.text(3)), about, numbers});
  }
}

bool NumberBook::agrees(std::int64_t point, int seed, const Json& result) {
  Statement query(
      connection_,
      "SELECT quantities, numbers FROM numbers JOIN number_layout USING (layout_id) WHERE point_id = ? AND "
      "seed = ?");
  query.bind(point).bind(seed);
  const bool has_numbers = query.step();
  if (!result.at("mean").is_object()) return !has_numbers;
  const NumberLayout layout(result);
  return has_numbers && query.text(0) == layout.text() && query.text(1) == bytes_of(layout.numbers(result));
}

}  // namespace peclet::runner
