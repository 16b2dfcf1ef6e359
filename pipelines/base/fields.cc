// SPDX-License-Identifier: MIT
#include "pipelines/base/fields.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "sketches/io/json.h"

namespace sketchsplat {
namespace {

// Shortest text that reads back as the same number, whatever the locale.
std::string number_text(double value) {
  char buffer[32];
  if (std::nearbyint(value) == value && std::abs(value) < 1e7) return std::to_string(int(value));
  const auto result = std::to_chars(buffer, buffer + sizeof(buffer), value);
  return std::string(buffer, result.ptr);
}

template <typename T>
bool parse_number(const std::string& text, T* value) {
  const char* begin = text.data();
  const char* end = begin + text.size();
  if (begin != end && *begin == '+') ++begin;
  const auto result = std::from_chars(begin, end, *value);
  return result.ec == std::errc() && result.ptr == end;
}

std::string range_text(const Field& field) {
  const bool low = std::isfinite(field.low), high = std::isfinite(field.high);
  if (low && high) return number_text(field.low) + " to " + number_text(field.high);
  if (low) return "at least " + number_text(field.low);
  if (high) return "at most " + number_text(field.high);
  return "";
}

// Index of the choice that a text matches, or -1.
int match_choice(const std::vector<std::string>& choices, const std::string& text) {
  for (size_t i = 0; i < choices.size(); ++i) {
    if (choices[i] == text) return int(i);
    const size_t colon = choices[i].find(':');
    if (colon == std::string::npos) continue;
    if (text.size() > colon + 1 && text.compare(0, colon + 1, choices[i], 0, colon + 1) == 0)
      return int(i);
  }
  return -1;
}

std::string flag_of(const Field& field) {
  return field.positional ? field.unit : "--" + field.name;
}

[[noreturn]] void refuse(const Field& field, const std::string& text) {
  throw UsageError(flag_of(field) + ": expected " + allowed(field) + ", got '" + text + "'");
}

template <typename T>
void assign_number(const Field& field, const std::string& text, T* target) {
  T value;
  if (!parse_number(text, &value) || !std::isfinite(double(value)) || value < field.low ||
      value > field.high)
    refuse(field, text);
  *target = value;
}

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words(1);
  for (const char c : text) {
    if (c == ',' || c == '\n')
      words.emplace_back();
    else
      words.back() += c;
  }
  return words;
}

// In the order of the choices, so that equal sets are equal texts.
void assign_words(const Field& field, const std::string& text, std::string* target) {
  const std::vector<std::string> words = words_of(text), &all = field.choices;
  for (const std::string& word : words) {
    const bool none = word == "none" && words.size() == 1;
    if (!none && std::find(all.begin(), all.end(), word) == all.end()) refuse(field, word);
  }
  std::string sorted;
  for (const std::string& choice : all)
    if (picked(text, choice)) sorted += (sorted.empty() ? "" : ",") + choice;
  *target = sorted.empty() ? "none" : sorted;
}

void assign_text(const Field& field, const std::string& text, std::string* target) {
  if (field.many) return assign_words(field, text, target);
  if (text.empty() || (!field.choices.empty() && match_choice(field.choices, text) < 0))
    refuse(field, text);
  *target = text;
}

size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t above = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
      diagonal = above;
    }
  }
  return row[b.size()];
}

}  // namespace

Field& Fields::push(const std::string& name, decltype(Field::value) value,
                    const std::vector<std::string>& choices, const std::string& help) {
  Field field;
  field.name = name;
  field.value = std::move(value);
  field.choices = choices;
  field.help = help;
  field.group = group_;
  field.expert = expert_;
  field.initial = text_of(field);
  list.push_back(std::move(field));
  return list.back();
}

Field& Fields::add(const std::string& name, std::variant<int*, double*> value,
                   const std::string& unit, double low, double high, const std::string& help) {
  const auto any = std::visit([](auto* v) -> decltype(Field::value) { return v; }, value);
  Field& field = push(name, any, {}, help);
  field.unit = unit;
  field.low = low;
  field.high = high;
  return field;
}

Field& Fields::add(const std::string& name, bool* value, const std::string& help) {
  return push(name, value, {}, help);
}

Field& Fields::add(const std::string& name, std::string* value, const std::string& placeholder,
                   const std::string& help) {
  Field& field = push(name, value, {}, help);
  field.unit = placeholder;
  return field;
}

Field& Fields::choose(const std::string& name, std::string* value,
                      const std::vector<std::string>& choices, const std::string& help) {
  return push(name, value, choices, help);
}

Field& Fields::pick(const std::string& name, std::string* value,
                    const std::vector<std::string>& choices, const std::string& help) {
  Field& field = push(name, value, choices, help);
  for (const std::string& choice : choices)
    field.help += (&choice == &choices.front() ? ", with commas between: " : ", ") + choice;
  field.unit = "NAME,...";
  field.many = field.several = true;
  return field;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string text_of(const Field& field) {
  if (const auto* b = std::get_if<bool*>(&field.value)) return **b ? "true" : "false";
  if (const auto* i = std::get_if<int*>(&field.value)) return std::to_string(**i);
  if (const auto* d = std::get_if<double*>(&field.value)) return number_text(**d);
  if (const auto* s = std::get_if<std::string*>(&field.value)) return **s;
  return field.choices.at(std::get<Choice>(field.value).get());
}

void assign(const Field& field, const std::string& text) {
  if (const auto* b = std::get_if<bool*>(&field.value)) {
    if (text != "true" && text != "false") refuse(field, text);
    **b = text == "true";
  } else if (const auto* i = std::get_if<int*>(&field.value)) {
    assign_number(field, text, *i);
  } else if (const auto* d = std::get_if<double*>(&field.value)) {
    assign_number(field, text, *d);
  } else if (const auto* s = std::get_if<std::string*>(&field.value)) {
    assign_text(field, text, *s);
  } else {
    const int index = match_choice(field.choices, text);
    if (index < 0) refuse(field, text);
    std::get<Choice>(field.value).set(index);
  }
}

std::string allowed(const Field& field) {
  if (!field.choices.empty()) {
    std::string words = field.many ? "none or some of " : "one of ";
    for (size_t i = 0; i < field.choices.size(); ++i)
      words += (i > 0 ? ", " : "") + field.choices[i];
    return words;
  }
  if (std::holds_alternative<bool*>(field.value)) return "true or false";
  if (std::holds_alternative<std::string*>(field.value)) return "a text that is not empty";
  const std::string range = range_text(field);
  const std::string unit = field.unit.empty() ? "" : " " + field.unit;
  const std::string noun =
      std::holds_alternative<int*>(field.value) ? "a whole number" : "a number";
  const bool both = std::isfinite(field.low) && std::isfinite(field.high);
  return range.empty() ? noun : noun + (both ? " from " : " of ") + range + unit;
}

std::string facts(const Field& field) {
  if (std::holds_alternative<bool*>(field.value))
    return "[default " + std::string(field.initial == "true" ? "on" : "off") + "]";
  std::vector<std::string> parts;
  const bool number =
      std::holds_alternative<int*>(field.value) || std::holds_alternative<double*>(field.value);
  if (number && !field.unit.empty()) parts.push_back(field.unit);
  if (number && !range_text(field).empty()) parts.push_back(range_text(field));
  if (field.required)
    parts.push_back("required");
  else if (!field.initial.empty())
    parts.push_back("default " + field.initial);
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "[" : ", ") + part;
  return text.empty() ? text : text + "]";
}

const Field* find_field(const std::vector<Field>& fields, const std::string& name) {
  for (const Field& field : fields)
    if (field.name == name) return &field;
  return nullptr;
}

bool picked(const std::string& text, const std::string& word) {
  const std::vector<std::string> words = words_of(text);
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates) {
  std::string best;
  size_t smallest = std::max<size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const size_t distance = edit_distance(word, candidate);
    if (distance < smallest) {
      smallest = distance;
      best = candidate;
    }
  }
  return best;
}

std::string unknown_option(const std::vector<Field>& fields, const std::string& given,
                           const std::string& verb) {
  const std::string flag = given.substr(0, given.find('='));
  const std::string dashes = flag[0] == '-' ? "--" : "", no = dashes + "no-";
  const bool negated = flag.rfind(no, 0) == 0;
  const std::string word = flag.substr(negated ? no.size() : std::min(dashes.size(), flag.size()));
  std::vector<std::string> names = {dashes + "help", dashes + "help-all"};
  std::string hint;
  for (const Field& field : fields) {
    const std::vector<std::string>& all = field.choices;
    if (field.many && std::find(all.begin(), all.end(), word) != all.end())
      hint = ", replaced by " + dashes + field.name + " " + word;
    if (!field.positional) names.push_back(dashes + field.name);
  }
  const std::string near = nearest_word(flag, names);
  if (hint.empty() && !near.empty()) hint = ", did you mean " + near + "?";
  return "unknown option " + given + hint + " (see sketchsplat " + verb + " --help-all)";
}

std::string fields_json(const std::vector<Field>& fields) {
  Json json = Json::object();
  for (const Field& field : fields) {
    if (const auto* b = std::get_if<bool*>(&field.value))
      json[field.name] = **b;
    else if (const auto* i = std::get_if<int*>(&field.value))
      json[field.name] = **i;
    else if (const auto* d = std::get_if<double*>(&field.value))
      json[field.name] = **d;
    else
      json[field.name] = text_of(field);
  }
  return json_text(json);
}

}  // namespace sketchsplat
