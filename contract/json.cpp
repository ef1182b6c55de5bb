#include "contract/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/named_files.h"
#include "contract/text.h"

namespace peclet {

namespace {

// Largest depth of a document: functions that walk a document recurse.
constexpr std::size_t deepest_nesting = 200;

// Iterator over the text that records how far the parser has come: the place of faults that the callbacks
// find, which get no position.
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

// Returns "line 3, column 5" for the character at byte `offset`. Lines and columns [characters] count from 1.
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

// Returns the parser's message without the exception's name and place: "[json.exception.parse_error.101]
// parse error at line 1, column 2: syntax error while parsing value - unexpected ..." becomes "must be JSON:
// unexpected ...". Drops "last read" if that is not ASCII, because it may end inside a character.
std::string reason(std::string_view message) {
  const auto skip_past = [&](std::string_view mark) {
    const auto found = message.find(mark);
    if (found != std::string_view::npos) message.remove_prefix(found + mark.size());
  };
  skip_past("] ");
  if (message.starts_with("parse error")) skip_past(": ");
  const bool is_syntax = message.starts_with("syntax error");
  if (is_syntax) skip_past(" - ");
  const bool is_plain = std::all_of(message.begin(), message.end(),
                                    [](char c) { return static_cast<unsigned char>(c) < 0x80U; });
  return (is_syntax ? "must be JSON: " : "") +
         std::string(is_plain ? message : message.substr(0, message.find("; last read")));
}

// Returns an explanation of a usual fault of JSON written by hand at byte `offset`; "" for other faults.
std::string usual_fault(std::string_view text, std::size_t offset) {
  const std::string_view from_here = text.substr(std::min(offset, text.size()));
  for (const std::string_view quote : {"\u201c", "\u201d", "\u201e", "\u2018", "\u2019"}) {
    // The parser stops inside the mark, or behind it.
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
  // A number where a key should be, as in "a": 0,5.
  const std::size_t sign = text.substr(0, offset + 1).find_last_not_of("0123456789");
  if (sign != std::string_view::npos && sign > 0 && sign < offset && text[sign] == ',' &&
      text[sign - 1] >= '0' && text[sign - 1] <= '9') {
    return "; decimals have a point, 0.5, and no comma";
  }
  if (from_here.starts_with("//")) return "; JSON has no comments";
  if (from_here.starts_with("/") || from_here.starts_with("#")) return "; comments begin with //";
  if (from_here.starts_with("'")) return "; JSON has double quotation marks, \"";
  return "";
}

// Builds the document from the parser's callbacks. Throws Fault, without a place, for too many values,
// duplicate keys and too deep nesting.
class Builder {
 public:
  struct Fault {
    std::string what;
  };

  explicit Builder(std::size_t most_values) : most_values_(most_values) {}

  Json take() { return std::move(root_); }

  // Callbacks of the parser.
  // NOLINTBEGIN(readability-identifier-naming)
  bool null() { return add(nullptr); }
  bool boolean(bool value) { return add(value); }
  bool number_integer(Json::number_integer_t value) { return add(value); }
  bool number_unsigned(Json::number_unsigned_t value) { return add(value); }
  bool number_float(Json::number_float_t value, const std::string& /*spelt*/) { return add(value); }
  bool string(std::string& value) { return add(std::move(value)); }
  bool binary(Json::binary_t& value) { return add(std::move(value)); }
  bool start_object(std::size_t /*size*/) { return open(Json::object()); }
  bool start_array(std::size_t /*size*/) { return open(Json::array()); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  bool key(std::string& name) {
    const auto [member, is_new] = open_.back()->get_ref<Json::object_t&>().try_emplace(name);
    if (!is_new) throw Fault{fmt::format("duplicate key {}", shortened_key(name))};
    member_ = &member->second;
    return true;
  }
  [[noreturn]] bool parse_error(std::size_t /*place*/, const std::string& /*last*/,
                                const Json::exception& error) {
    if (const auto* fault = dynamic_cast<const Json::parse_error*>(&error)) throw *fault;
    throw Fault{reason(error.what())};  // a number that is too large
  }
  // NOLINTEND(readability-identifier-naming)

 private:
  static std::string shortened_key(const std::string& name) { return printable(Json(name).dump(), 60); }

  Json& put(Json value) {
    if (++values_ > most_values_) throw Fault{fmt::format("more than {} values", most_values_)};
    if (open_.empty()) return root_ = std::move(value);
    if (open_.back()->is_array()) {
      return open_.back()->get_ref<Json::array_t&>().emplace_back(std::move(value));
    }
    return *member_ = std::move(value);
  }
  bool add(Json value) {
    put(std::move(value));
    return true;
  }
  bool open(Json empty) {
    if (open_.size() >= deepest_nesting)
      throw Fault{fmt::format("nested more than {} deep", deepest_nesting)};
    open_.push_back(&put(std::move(empty)));
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }

  std::size_t most_values_, values_ = 0;
  Json root_;
  std::vector<Json*> open_;  // the innermost object or array last
  Json* member_ = nullptr;   // of the innermost open object, named by the last key
};

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

// Replaces comments by blanks. Returns where one begins that is never closed, or npos.
std::size_t blank_comments(std::string& text) {
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] == '"') {
      for (++at; at < text.size() && text[at] != '"'; ++at) {
        if (text[at] == '\\') ++at;
      }
      continue;
    }
    const bool is_block = text.compare(at, 2, "/*") == 0;
    if (!is_block && text.compare(at, 2, "//") != 0) continue;
    const std::size_t mark = is_block ? text.find("*/", at + 2) : text.find_first_of("\r\n", at);
    if (is_block && mark == std::string::npos) return at;
    const std::size_t end = is_block ? mark + 2 : std::min(mark, text.size());
    std::fill(text.begin() + static_cast<std::ptrdiff_t>(at), text.begin() + static_cast<std::ptrdiff_t>(end),
              ' ');
    at = end - 1;
  }
  return std::string::npos;
}

Json parsed(std::string_view text, const std::string& file, std::size_t most_values, bool has_comments) {
  const char* furthest = text.data();
  const auto fault = [&](std::size_t offset, const std::string& message) {
    return InputError(file, "", "", place(text, offset) + ": " + message);
  };
  const auto here = [&] {
    const auto read = static_cast<std::size_t>(furthest - text.data());
    return read == 0 ? 0 : read - 1;
  };

  // The parser would take a NUL for the end of the text.
  if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos) {
    throw fault(nul, "a NUL character; JSON is plain text in UTF-8");
  }
  Builder builder(most_values);
  try {
    const char* const end = text.data() + text.size();
    Json::sax_parse(TrackedIterator(text.data(), &furthest), TrackedIterator(end, &furthest), &builder,
                    Json::input_format_t::json, true, has_comments);
    return builder.take();
  } catch (const Json::parse_error& error) {
    const std::size_t offset = std::min(text.size(), error.byte == 0 ? 0 : error.byte - 1);
    const std::string why = reason(error.what());
    std::string plain(text);
    const std::size_t open = has_comments ? blank_comments(plain) : std::string::npos;
    const bool is_open = why.find("missing closing '*/'") != std::string::npos;
    if (is_open && open != std::string::npos) throw fault(open, "must be JSON: the comment is not closed");
    const std::string usual = usual_fault(plain, offset);
    // The explanation of a usual fault replaces what the parser read last and expected.
    throw fault(offset, usual.empty() ? why : why.substr(0, why.find("; ")) + usual);
  } catch (const Builder::Fault& refused) {
    throw fault(here(), refused.what);
  }
}

}  // namespace

std::string without_comments(std::string text) {
  blank_comments(text);
  return text;
}

Json parse_json(std::string_view text, const std::string& file) {
  return parsed(text, file, std::numeric_limits<std::size_t>::max(), false);
}

Json parse_json_input(std::string_view text, const std::string& file, std::size_t most_values) {
  return parsed(text, file, most_values, true);
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
