#include "contract/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <set>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "contract/durable_file.h"
#include "contract/input_error.h"

namespace peclet {

namespace {

// Deeper documents are refused: everything that walks a document recurses, and nothing of ours is deep.
constexpr int deepest_nesting = 200;

// Walks over the text and remembers how far the parser has come, so that faults that only the callback sees
// (it is told no position) can be placed too.
class TrackedIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  TrackedIterator(const char* at, const char** furthest) : at_(at), furthest_(furthest) {}
  reference operator*() const { return *at_; }
  TrackedIterator& operator++() {
    *furthest_ = ++at_;
    return *this;
  }
  bool operator==(const TrackedIterator& other) const { return at_ == other.at_; }
  bool operator!=(const TrackedIterator& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  const char** furthest_;
};

// "line 3, column 5" of the character at `offset`, both counted from 1, columns in characters, not bytes.
std::string place(std::string_view text, std::size_t offset) {
  std::size_t line = 1;
  std::size_t column = 1;
  for (const char c : text.substr(0, offset)) {
    if (c == '\n') {
      ++line;
      column = 1;
    } else if ((static_cast<unsigned char>(c) & 0xC0U) != 0x80U) {
      ++column;
    }
  }
  return fmt::format("line {}, column {}", line, column);
}

// The parser's message without its own name and the place: "[json.exception.parse_error.101] parse error at
// line 1, column 2: syntax error ..." ends as "syntax error ...". What it read last may be a part of a
// character, which no terminal can show.
std::string reason(std::string_view message) {
  const auto skip_past = [&](std::string_view mark) {
    const auto found = message.find(mark);
    if (found != std::string_view::npos) message.remove_prefix(found + mark.size());
  };
  skip_past("] ");
  if (message.starts_with("parse error")) skip_past(": ");
  const bool is_plain = std::all_of(message.begin(), message.end(),
                                    [](char c) { return static_cast<unsigned char>(c) < 0x80U; });
  return std::string(is_plain ? message : message.substr(0, message.find("; last read")));
}

// What people type who write JSON by hand or paste it from a document: the usual faults, named.
std::string usual_fault(std::string_view text, std::size_t offset) {
  const std::string_view from_here = text.substr(std::min(offset, text.size()));
  for (const std::string_view quote : {"\u201c", "\u201d", "\u201e", "\u2018", "\u2019"}) {
    // The parser stops inside of it, or behind.
    for (std::size_t back = 0; back < quote.size(); ++back) {
      if (offset >= back && text.substr(offset - back).starts_with(quote)) {
        return "; a typographic quotation mark: JSON has straight ones, \"";
      }
    }
  }
  const std::size_t before = text.substr(0, offset).find_last_not_of(" \t\r\n");
  const bool closes = from_here.starts_with("]") || from_here.starts_with("}");
  if (closes && before != std::string_view::npos && text[before] == ',') {
    return "; the comma before it is one too many";
  }
  if (from_here.starts_with("/") || from_here.starts_with("#")) return "; JSON has no comments";
  if (from_here.starts_with("'")) return "; JSON has double quotation marks, \"";
  return "";
}

void write_number(double number, std::string& out) {
  if (!std::isfinite(number))
    throw std::invalid_argument("canonical JSON has no spelling for NaN and infinity");
  constexpr double first_inexact_integer = 9007199254740992.0;  // 2^53
  if (std::trunc(number) == number && std::abs(number) < first_inexact_integer) {
    out += std::to_string(static_cast<long long>(number));
    return;
  }
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
  out.append(digits.data(), end);
}

void write_canonical(const Json& value, std::string& out) {
  if (value.is_object()) {
    out += '{';
    const char* separator = "";
    for (const auto& [key, member] : value.items()) {
      out += separator;
      out += Json(key).dump();
      out += ':';
      write_canonical(member, out);
      separator = ",";
    }
    out += '}';
  } else if (value.is_array()) {
    out += '[';
    const char* separator = "";
    for (const Json& element : value) {
      out += separator;
      write_canonical(element, out);
      separator = ",";
    }
    out += ']';
  } else if (value.is_number_float()) {
    write_number(value.get<double>(), out);
  } else {
    out += value.dump();
  }
}

}  // namespace

Json parse_json(std::string_view text, const std::string& file) {
  const char* furthest = text.data();
  const auto fault = [&](std::size_t offset, const std::string& message) {
    return InputError(file, "", "", place(text, offset) + ": " + message);
  };
  const auto here = [&] {
    const auto read = static_cast<std::size_t>(furthest - text.data());
    return read == 0 ? 0 : read - 1;
  };

  std::vector<std::set<std::string>> open_objects;
  const auto watch = [&](int depth, Json::parse_event_t event, Json& parsed) {
    if (depth > deepest_nesting) {
      throw fault(here(), fmt::format("nested more than {} deep", deepest_nesting));
    }
    if (event == Json::parse_event_t::object_start) open_objects.emplace_back();
    if (event == Json::parse_event_t::object_end) open_objects.pop_back();
    if (event == Json::parse_event_t::key && !open_objects.back().insert(parsed.get<std::string>()).second) {
      throw fault(here(), fmt::format("duplicate key {}", parsed.dump()));
    }
    return true;
  };

  try {
    const char* const end = text.data() + text.size();
    return Json::parse(TrackedIterator(text.data(), &furthest), TrackedIterator(end, &furthest), watch);
  } catch (const Json::parse_error& error) {
    const std::size_t offset = std::min(text.size(), error.byte == 0 ? 0 : error.byte - 1);
    const std::string why = reason(error.what()), usual = usual_fault(text, offset);
    // Where the fault is known, what the parser read last and expected instead says less.
    throw fault(offset, usual.empty() ? why : why.substr(0, why.find("; ")) + usual);
  } catch (const Json::exception& error) {
    throw fault(here(), reason(error.what()));
  }
}

Json read_json(const std::filesystem::path& path) {
  std::string text;
  try {
    text = read_file(path);
  } catch (const std::system_error& error) {
    throw InputError(path.string(), "", "", "cannot be read: " + error.code().message());
  }
  return parse_json(text, path.string());
}

std::string canonical_json(const Json& document) {
  std::string out;
  write_canonical(document, out);
  return out;
}

}  // namespace peclet
