#include "runner/campaign/campaign_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "contract/errors.h"
#include "contract/text.h"
#include "runner/campaign/quoting.h"

namespace peclet::runner {

namespace fs = std::filesystem;

namespace {

// Returns false for a name that cannot be followed (a loop, too long); reading it reports the reason.
bool is_folder(const fs::path& given) {
  std::error_code impossible;
  return fs::is_directory(given, impossible);
}

}  // namespace

fs::path campaign_file_of(const fs::path& given) {
  if (!is_folder(given)) return given;
  fs::path file = given.has_filename() ? given : given.parent_path();  // a slash at the end
  return file.replace_extension(".json");
}

std::string words_for(const fs::path& campaign_file, const fs::path& chosen) {
  const std::string words = shell_word(campaign_file.string());
  return chosen.empty() ? words : fmt::format("{} --directory {}", words, shell_word(chosen.string()));
}

std::string similar_name(const fs::path& given) {
  const fs::path folder = given.has_parent_path() ? given.parent_path() : ".";
  std::error_code unreadable;  // no name is offered then
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, unreadable)) {
    const fs::path extension = entry.path().extension();
    if (extension == ".json" || extension == ".peclet") names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  const std::string nearest = nearest_name(given.filename().string(), names);
  if (nearest.empty()) return "";
  return fmt::format("; did you mean {}?", (given.parent_path() / nearest).string());
}

void require_campaign_file(const fs::path& given) {
  if (is_folder(given)) {
    const fs::path file = campaign_file_of(given);
    throw InputError(given.string(), "", "",
                     fs::is_regular_file(file)
                         ? fmt::format("is a folder, but must be the campaign file: {}", file.string())
                         : "is a folder, but must be a campaign file");
  }
  std::error_code impossible;
  if (!fs::exists(given, impossible) && !impossible) {
    throw InputError(given.string(), "", "", "no such file" + similar_name(given));
  }
}

fs::path home_of(const fs::path& campaign_file) {
  std::error_code impossible;
  const fs::file_type type = fs::status(campaign_file, impossible).type();
  const bool has_no_folder =
      campaign_file.empty() || type == fs::file_type::fifo || type == fs::file_type::character;
  return has_no_folder ? fs::current_path() : fs::absolute(campaign_file).parent_path();
}

namespace {

struct Span {
  std::size_t begin = 0, end = 0;
};

struct Member {
  Span key, value;  // the key with its quotes
};

// Finds tokens in a text that is known to be JSON, with or without comments.
class Walker {
 public:
  explicit Walker(const std::string& text) : text_(without_comments(text)) {}

  std::size_t skip_blanks(std::size_t at) const { return text_.find_first_not_of(" \t\r\n", at); }

  std::size_t end_of_string(std::size_t at) const {
    for (++at; text_.at(at) != '"'; ++at) {
      if (text_[at] == '\\') ++at;
    }
    return at + 1;
  }

  std::size_t end_of_value(std::size_t at) const {
    if (text_.at(at) == '"') return end_of_string(at);
    if (text_[at] != '{' && text_[at] != '[')
      return std::min(text_.find_first_of(",]} \t\r\n", at), text_.size());
    int depth = 0;
    do {
      const char c = text_.at(at);
      if (c == '"') {
        at = end_of_string(at);
        continue;
      }
      if (c == '{' || c == '[') ++depth;
      if (c == '}' || c == ']') --depth;
      ++at;
    } while (depth > 0);
    return at;
  }

  // Returns the members of the object that begins at `at`, in their order.
  std::vector<Member> members(std::size_t at) const {
    std::vector<Member> found;
    at = skip_blanks(at + 1);
    while (text_.at(at) != '}') {
      Member member;
      member.key = {at, end_of_string(at)};
      const std::size_t colon = skip_blanks(member.key.end);
      member.value.begin = skip_blanks(colon + 1);
      member.value.end = end_of_value(member.value.begin);
      found.push_back(member);
      at = skip_blanks(member.value.end);
      if (text_.at(at) == ',') at = skip_blanks(at + 1);
    }
    return found;
  }

  std::optional<Member> member(std::size_t object, const std::string& key) const {
    for (const Member& known : members(object)) {
      // A key may be spelled with escapes.
      if (Json::parse(part(known.key.begin, known.key.end)) == key) return known;
    }
    return std::nullopt;
  }

  std::string part(std::size_t begin, std::size_t end) const { return text_.substr(begin, end - begin); }

  // Returns the end of the line on which nothing but a comment follows `at`; otherwise `at`.
  std::size_t behind_comment(std::size_t at) const {
    const std::size_t next = text_.find_first_not_of(" \t", at);
    return next != std::string::npos && (text_[next] == '\r' || text_[next] == '\n') ? next : at;
  }

 private:
  std::string text_;  // blanks in the place of comments
};

std::string with_new_member(const std::string& text, std::size_t object, const std::string& key,
                            const Json& value) {
  const Walker walker(text);
  const std::vector<Member> known = walker.members(object);
  const std::string quoted = Json(key).dump();
  if (known.empty()) {
    std::string edited = text;
    return edited.insert(object + 1, quoted + ": " + value.dump());
  }
  const std::string before_key = walker.part(object + 1, known.front().key.begin);
  const std::string colon = walker.part(known.front().key.end, known.front().value.begin);
  const std::size_t last_line = before_key.rfind('\n'), end = known.back().value.end;
  const std::string member = quoted + colon + value.dump();
  std::string edited = text;
  // Members on one line are separated by one blank, whatever follows the brace.
  if (last_line == std::string::npos) return edited.insert(end, ", " + member);
  const bool is_of_windows = last_line > 0 && before_key[last_line - 1] == '\r';
  edited.insert(walker.behind_comment(end), before_key.substr(last_line - (is_of_windows ? 1 : 0)) + member);
  return edited.insert(end, ",");
}

}  // namespace

std::string with_value(const std::string& text, const std::vector<std::string>& path, const Json& value) {
  const Walker walker(text);
  std::size_t object = walker.skip_blanks(text.starts_with("\xEF\xBB\xBF") ? 3 : 0);  // a byte-order mark
  for (std::size_t depth = 0; depth < path.size(); ++depth) {
    const std::optional<Member> member = walker.member(object, path[depth]);
    const bool is_last = depth + 1 == path.size();
    if (member && is_last) {
      std::string edited = text;
      return edited.replace(member->value.begin, member->value.end - member->value.begin, value.dump());
    }
    if (is_last) return with_new_member(text, object, path[depth], value);
    if (!member || text[member->value.begin] != '{')
      throw std::invalid_argument("no object at " + path[depth]);
    object = member->value.begin;
  }
  return text;
}

}  // namespace peclet::runner
