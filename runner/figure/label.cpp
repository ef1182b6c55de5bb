#include "runner/figure/label.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <string_view>

namespace peclet::runner {
namespace {

const std::map<std::string, std::string, std::less<>> greek{
    {"alpha", "α"},  {"beta", "β"},  {"gamma", "γ"},  {"delta", "δ"}, {"epsilon", "ε"}, {"eta", "η"},
    {"theta", "θ"},  {"kappa", "κ"}, {"lambda", "λ"}, {"mu", "μ"},    {"nu", "ν"},      {"xi", "ξ"},
    {"pi", "π"},     {"rho", "ρ"},   {"sigma", "σ"},  {"tau", "τ"},   {"phi", "φ"},     {"chi", "χ"},
    {"psi", "ψ"},    {"omega", "ω"}, {"rate", "γ̇"},   {"Gamma", "Γ"}, {"Delta", "Δ"},   {"Theta", "Θ"},
    {"Lambda", "Λ"}, {"Sigma", "Σ"}, {"Phi", "Φ"},    {"Psi", "Ψ"},   {"Omega", "Ω"}};

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

std::string with_greek(std::string_view text) {
  std::string translated;
  while (!text.empty()) {
    const auto end = std::find_if_not(text.begin(), text.end(), is_letter);
    const auto size = std::max<std::size_t>(1, static_cast<std::size_t>(end - text.begin()));
    const auto letter = greek.find(text.substr(0, size));
    translated += letter == greek.end() ? std::string(text.substr(0, size)) : letter->second;
    text.remove_prefix(size);
  }
  return translated;
}

std::string words_of(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  std::string words;
  for (const char c : name) words += c == '/' ? std::string(", ") : std::string(1, c);
  return words;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() || word.empty() ? "" : " ") + word;
  return text;
}

Label title(const std::string& words, const Label& symbol, const std::string& unit) {
  Label label{{words}};
  if (!symbol.empty()) {
    label.push_back({" "});
    label.insert(label.end(), symbol.begin(), symbol.end());
  }
  if (!unit.empty()) label.push_back({" [" + unit + ']'});
  return label;
}

// Whether a unit is made of dimensions alone, such as "stress" or "length^2 / time^2": that of the scene.
bool is_of_scene(const std::string& unit) {
  static const std::set<std::string, std::less<>> dimensions{"stress", "energy", "time",     "length",
                                                             "mass",   "force",  "viscosity"};
  bool has_dimension = false;
  for (auto at = unit.begin(); at != unit.end();) {
    if (!is_letter(*at)) {
      ++at;
      continue;
    }
    const auto end = std::find_if_not(at, unit.end(), is_letter);
    if (!dimensions.contains(std::string(at, end))) return false;
    has_dimension = true;
    at = end;
  }
  return has_dimension;
}

// Names of scales, such as "viscosity * shear_rate", in the letters of the field; nothing of a pure number.
std::string unit_text(const std::string& unit) {
  if (unit == "1") return "";
  if (is_of_scene(unit)) return "scene units";
  std::string text;
  for (std::size_t at = 0; at < unit.size();) {
    const std::size_t end = std::min(unit.find(" * ", at), unit.size());
    const std::string word = unit.substr(at, end - at);
    text += text.empty() ? "" : " ";
    text += word == "viscosity" ? "η" : word == "shear_rate" ? "γ̇" : words_of(word);
    at = end + 3;
  }
  return text;
}

// A key that has a symbol of its own, else its last step; of an element of a list the last two.
std::string words_of_parameter(const Json& parameter) {
  if (parameter.contains("words")) return parameter["words"].get<std::string>();
  const std::string pointer = parameter.at("pointer").get<std::string>();
  const std::size_t last = pointer.rfind('/');
  const bool is_index = pointer.find_first_not_of("0123456789", last + 1) == std::string::npos;
  const std::size_t begin = is_index && last > 0 ? pointer.rfind('/', last - 1) : last;
  std::string steps = pointer.substr(begin + 1);
  std::replace(steps.begin(), steps.end(), '/', ' ');
  return words_of(steps);
}

Label symbol_of_parameter(const Json& parameter) {
  const std::string symbol = parameter.value("symbol", "");
  if (symbol.empty() || !symbol.ends_with(" T")) return symbol.empty() ? Label{} : symbol_label(symbol);
  Label label = symbol_label(symbol.substr(0, symbol.size() - 2));  // k_B T
  label.push_back({"T"});
  return label;
}

// The schema writes units in brackets at the end.
std::string unit_of_parameter(const Json& parameter) {
  const std::string meaning = parameter.value("meaning", "");
  const std::size_t begin = meaning.rfind('[');
  if (begin == std::string::npos || !meaning.ends_with(']')) return "";
  return unit_text(meaning.substr(begin + 1, meaning.size() - begin - 2));
}

std::string raised(int power) {
  static const std::array<const char*, 10> digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text;
  for (const char c : std::to_string(power)) {
    text += c == '-' ? "⁻" : digits.at(static_cast<std::size_t>(c - '0'));
  }
  return text;
}

// A formula in words, such as "<|F_t| / (mu F_n)>": a mean, and what stands lowered behind each underscore.
Label formula_label(std::string text) {
  if (text.starts_with('<') && text.ends_with('>')) text = "⟨" + text.substr(1, text.size() - 2) + "⟩";
  Label label;
  while (!text.empty()) {
    const std::size_t floor = std::min(text.find('_'), text.size());
    if (floor > 0) label.push_back({with_greek(text.substr(0, floor))});
    text.erase(0, floor + 1);
    const auto end =
        static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), is_letter) - text.begin());
    if (end > 0) label.push_back({with_greek(text.substr(0, end)), -1});
    text.erase(0, end);
  }
  return label;
}

}  // namespace

Label symbol_label(const std::string& symbol, const std::string& element) {
  if (element.empty() && symbol.find_first_of("<(|") != std::string::npos) return formula_label(symbol);
  const std::size_t roof = symbol.find('^'), floor = symbol.substr(0, roof).find('_');
  const std::string base = symbol.substr(0, std::min(floor, roof));
  const std::string below = floor == std::string::npos ? "" : symbol.substr(floor + 1, roof - floor - 1);
  std::string above = roof == std::string::npos ? "" : symbol.substr(roof + 1), tail;
  const std::size_t last = above.rfind('_');
  if (element.empty() && last != std::string::npos) {
    const std::string end = above.substr(last + 1);
    if (!end.empty() && end.size() <= 2 && std::all_of(end.begin(), end.end(), is_word)) {
      tail = end;
      above.resize(last);
    }
  }
  std::replace(above.begin(), above.end(), '_', ' ');
  Label label;
  for (const auto& [text, level] :
       {LabelPart{base, 0}, LabelPart{joined({below, tail, element}), -1}, LabelPart{above, 1}}) {
    if (!text.empty()) label.push_back({with_greek(text), level});
  }
  return label;
}

Label title_of(const Drawable& quantity) {
  const std::string words =
      words_of(quantity.name) + (quantity.element.empty() ? "" : ", " + quantity.element);
  return title(words, quantity.symbol.empty() ? Label{} : symbol_label(quantity.symbol, quantity.element),
               unit_text(quantity.unit));
}

Label title_of(const Json& parameter) {
  return title(words_of_parameter(parameter), symbol_of_parameter(parameter), unit_of_parameter(parameter));
}

Label short_name_of(const Json& parameter) {
  const Label symbol = symbol_of_parameter(parameter);
  return symbol.empty() ? Label{{words_of_parameter(parameter)}} : symbol;
}

std::string text_of(const Label& label) {
  std::string text;
  for (const LabelPart& part : label) text += part.text;
  return text;
}

std::string mathtext_of(const Label& label) {
  std::string text;
  for (const LabelPart& part : label) {
    if (part.level == 0) {
      for (const char c : part.text) text += c == '$' ? std::string("\\$") : std::string(1, c);
      continue;
    }
    text += part.level > 0 ? "$^{\\mathrm{" : "$_{\\mathrm{";
    for (const char c : part.text) {
      if (std::string_view("\\${}^_%#&~").find(c) != std::string_view::npos) continue;
      text += c == ' ' ? std::string("\\ ") : std::string(1, c);
    }
    text += "}}$";
  }
  return text;
}

std::string plain_number(double value) {
  const double size = std::abs(value);
  if (value == 0 || (size >= 1e-3 && size < 1e5)) {
    const std::string digits = fmt::format("{:.4g}", value);
    return digits.find('e') == std::string::npos ? digits : fmt::format("{:.0f}", std::stod(digits));
  }
  const int power = static_cast<int>(std::floor(std::log10(size) + 1e-9));
  const double leading = value / std::pow(10.0, power);
  return (std::abs(leading - 1) < 1e-9 ? "10" : fmt::format("{:.4g}·10", leading)) + raised(power);
}

}  // namespace peclet::runner
