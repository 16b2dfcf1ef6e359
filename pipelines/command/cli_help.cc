// SPDX-License-Identifier: MIT
#include "pipelines/command/cli_help.h"

#include <algorithm>

#include "datasets/readers/open_options.h"
#include "datasets/readers/scene.h"

namespace sketchsplat {
namespace {

constexpr size_t kColumn = 30;  // where help lines start
constexpr size_t kWidth = 100;

std::string placeholder(const Field& field) {
  if (!field.choices.empty() && !field.many) {
    std::string words;
    for (const std::string& choice : field.choices) words += (words.empty() ? "" : "|") + choice;
    return words;
  }
  if (std::holds_alternative<int*>(field.value)) return "N";
  if (std::holds_alternative<double*>(field.value)) return "X";
  return field.unit;
}

// "--out DIR"; a switch that is on by default shows how to turn it off.
std::string flag_text(const Field& field) {
  if (field.positional) return field.unit;
  if (std::holds_alternative<bool*>(field.value))
    return (field.initial == "true" ? "--[no-]" : "--") + field.name;
  const std::string value = placeholder(field);
  return "--" + field.name + " " + (field.value_optional ? "[" + value + "]" : value);
}

// One option: flag, help, facts, broken into lines; the facts are not torn apart.
std::string option_lines(const Field& field) {
  std::vector<std::string> words;
  for (size_t at = 0, end; at < field.help.size(); at = end + 1) {
    end = std::min(field.help.find(' ', at), field.help.size());
    words.push_back(field.help.substr(at, end - at));
  }
  const std::string fact = facts(field);
  if (!fact.empty()) words.push_back(fact);

  std::string line = "  " + with_short_name(field), text;
  if (line.size() + 2 > kColumn) {
    text = line + "\n";
    line.clear();
  }
  line.resize(kColumn - 1, ' ');
  for (const std::string& word : words) {
    if (line.size() + 1 + word.size() > kWidth && line.size() > kColumn) {
      text += line + "\n";
      line.assign(kColumn - 1, ' ');
    }
    line += " " + word;
  }
  return text + line + "\n";
}

std::string option_groups(const std::vector<Field>& fields, bool all) {
  std::string text, group;
  for (const Field& field : fields) {
    if (field.expert && !all) continue;
    if (field.group != group) text += "\n" + field.group + ":\n";
    group = field.group;
    text += option_lines(field);
  }
  return text;
}

std::string examples(const std::vector<std::string>& lines) {
  std::string text = "Examples:\n";
  for (const std::string& line : lines) text += "  " + line + "\n";
  return text;
}

}  // namespace

std::string with_short_name(const Field& field) {
  return (field.short_name.empty() ? "" : "-" + field.short_name + ", ") + flag_text(field);
}

std::string usage_line(const Verb& verb) {
  std::string line = "sketchsplat " + verb.name;
  for (const Field& field : verb.fields) {
    if (!field.positional && !field.required) continue;
    std::string text = flag_text(field) + (field.several ? "…" : "");
    if (const Field* other = find_field(verb.fields, field.unless))
      text = "(" + text + " | " + flag_text(*other) + ")";
    line += field.required ? " " + text : " [" + text + "]";
  }
  return line + " [options]";
}

std::string program_help(const std::vector<Verb>& verbs, const std::vector<Field>& common) {
  std::vector<std::string> first;
  for (const Verb& verb : verbs)
    if (!verb.examples.empty()) first.push_back(verb.examples.front());
  std::string text = examples(first);
  text += "\nCalibrated images of a CAD object become its edges as exact curves.\n\nVerbs:\n";
  for (const Verb& verb : verbs) {
    std::string line = "  " + verb.name;
    line.resize(std::max(kColumn / 2, line.size() + 1), ' ');
    text += line + verb.summary + "\n";
  }
  text += "  (sketchsplat VERB --help shows the options of a verb)\n";
  text += option_groups(common, true);
  text += "  -h, --help                  Show this, or the help of a verb\n";
  text += "  --version                   Show the version, the commit and the libraries\n";
  text +=
      "\nExit status: 0 done, 2 wrong usage, 3 unusable input, 4 too little in the scene,\n"
      "5 output cannot be written, 6 a batch of which some scenes failed, 7 inspected and not all "
      "in,\n"
      "1 a defect of the program.\n";
  return text;
}

std::string verb_help(const Verb& verb, const std::vector<Field>& common, bool all) {
  const auto experts = std::count_if(verb.fields.begin(), verb.fields.end(),
                                     [](const Field& field) { return field.expert; });
  std::string text = examples(verb.examples) + "\n" + verb.summary +
                     ".\n\nUsage: " + usage_line(verb) + "\n" + option_groups(verb.fields, all);
  if (experts == 0 || all) return text + option_groups(common, true);
  text += "\nEverywhere:";  // a line for all of them: sketchsplat --help explains them
  for (const Field& field : common) text += " " + with_short_name(field);
  return text + "\n--help-all shows " + std::to_string(experts) +
         " more options, for experts, and explains these.\n";
}

std::string options_markdown(const std::vector<Verb>& verbs) {
  std::string text;
  for (const Verb& verb : verbs) {
    text += "`" + usage_line(verb) +
            "`\n\n| option | meaning | unit, range, default |\n|---|---|---|\n";
    for (const Field& field : verb.fields) {
      std::string flag = with_short_name(field);
      for (size_t at = 0; (at = flag.find('|', at)) != std::string::npos; at += 2)
        flag.insert(at, "\\");
      std::string fact = facts(field);
      if (!fact.empty()) fact = fact.substr(1, fact.size() - 2);
      text += "| `" + flag + "` | " + field.help + " | " + fact + " |\n";
    }
    text += "\n";
  }
  return text;
}

void list_open_fields(OpenOptions* options, Fields* f) {
  Field& format = f->choose("format", &options->format, scene_formats(),
                            "Format of the scene; default: by its files");
  format.expert = true;
  Field& outside = f->add("allow-outside", &options->allow_outside,
                          "Also read images outside of the scene folder");
  outside.expert = true;
}

}  // namespace sketchsplat
