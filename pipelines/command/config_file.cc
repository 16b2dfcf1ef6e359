// SPDX-License-Identifier: MIT
#include "pipelines/command/config_file.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <sstream>

#include "datasets/types/errors.h"
#include "pipelines/command/cli_help.h"

namespace sketchsplat {
namespace {

constexpr std::uintmax_t kMostBytes = 1 << 20;

// Belongs to one run, not to a way of working.
bool is_of_one_run(const Field& field) {
  return field.positional || field.required || field.alone || field.name == "config" ||
         field.name == "save-config" || field.name == "log" || field.name == "dry-run";
}

std::vector<CLI::ConfigItem> items_of(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (!fs::is_regular_file(path, error)) throw InputError(path, "a file of options", "none");
  const std::uintmax_t bytes = fs::file_size(path, error);
  if (error || bytes > kMostBytes)
    throw InputError(path, "a file of options of at most 1 MB", std::to_string(bytes) + " bytes");
  try {
    return CLI::ConfigTOML().from_file(path);
  } catch (const CLI::Error& e) {
    throw InputError(path, "lines of the form \"name = value\"", e.what());
  }
}

std::string joined(const std::vector<std::string>& texts) {
  std::string out;
  for (const std::string& text : texts) out += (out.empty() ? "" : "\n") + text;
  return out;
}

const Field& field_of(const std::string& path, const std::string& name,
                      const std::vector<Field>& fields) {
  const Field* field = find_field(fields, name);
  if (field && !is_of_one_run(*field)) return *field;
  std::vector<std::string> names;
  for (const Field& f : fields)
    if (!is_of_one_run(f)) names.push_back(f.name);
  const std::string now = successor(fields, name), near = nearest_word(name, names);
  throw InputError(path, "the name of an option",
                   "'" + name + "'" +
                       (!now.empty()            ? ", replaced by --" + now
                        : field || near.empty() ? ""
                                                : ", did you mean " + near + "?"));
}

// Text between quotation marks that it does not hold.
std::string quoted(const std::string& name, const std::string& text) {
  const bool twice = text.find('"') != std::string::npos;
  if (text.find('\n') != std::string::npos || (twice && text.find('\'') != std::string::npos))
    throw UsageError("--" + name + ": a text with line breaks or both kinds of quotation marks " +
                     "cannot be saved");
  const std::string mark = twice ? "'" : "\"";
  return mark + text + mark;
}

std::string value_text(const Field& field) {
  const std::string text = text_of(field);
  const bool is_text = std::holds_alternative<std::string*>(field.value) ||
                       std::holds_alternative<Choice>(field.value);
  if (!is_text) return text;
  if (!field.several) return quoted(field.name, text);
  std::string out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line, field.many ? ',' : '\n');)
    out += (out.empty() ? "" : ", ") + quoted(field.name, line);
  return "[" + out + "]";
}

}  // namespace

std::map<std::string, std::string> read_config(const std::string& path, const std::string& verb,
                                               const std::vector<Field>& fields) {
  std::map<std::string, std::string> out;
  for (const CLI::ConfigItem& item : items_of(path)) {
    // CLI11 marks where sections begin and end.
    if (item.name == "++" || item.name == "--") continue;
    if (!item.parents.empty() && item.parents != std::vector<std::string>{verb}) continue;
    const Field& field = field_of(path, item.name, fields);
    if (item.inputs.size() != 1 && !field.several)
      throw InputError(path, "one value of " + item.name, std::to_string(item.inputs.size()));
    out[item.name] = joined(item.inputs);
  }
  return out;
}

std::string config_text(const std::string& verb, const std::vector<Field>& fields) {
  std::string out = "[" + verb + "]\n";
  for (const Field& field : fields)
    if (!is_of_one_run(field) && text_of(field) != field.initial)
      out += field.name + " = " + value_text(field) + "\n";
  return out;
}

}  // namespace sketchsplat
