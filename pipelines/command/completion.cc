// SPDX-License-Identifier: MIT
#include "pipelines/command/completion.h"

namespace sketchsplat {
namespace {

// What may stand behind an option.
enum class Value { kNone, kChoice, kFolder, kFile, kAnything };

Value value_of(const Field& field) {
  if (std::holds_alternative<bool*>(field.value)) return Value::kNone;
  if (!field.choices.empty()) return Value::kChoice;
  if (!std::holds_alternative<std::string*>(field.value)) return Value::kAnything;
  const auto names = [&](const char* word) { return field.unit.find(word) != std::string::npos; };
  if (names("FILE") || names("json") || names("PART")) return Value::kFile;
  return names("DIR") || names("SCENE") || names("ROOT") ? Value::kFolder : Value::kAnything;
}

// "--masks" and "--no-masks", "--out", "-o"; nothing for what has no name.
std::vector<std::string> flags_of(const Field& field) {
  if (field.positional) return {};
  std::vector<std::string> flags = {"--" + field.name};
  if (value_of(field) == Value::kNone && field.initial == "true")
    flags.push_back("--no-" + field.name);
  if (!field.short_name.empty()) flags.push_back("-" + field.short_name);
  return flags;
}

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

std::string all_flags(const std::vector<Field>& fields) {
  std::vector<std::string> words;
  for (const Field& field : fields)
    for (const std::string& flag : flags_of(field)) words.push_back(flag);
  return joined(words, " ");
}

std::vector<std::string> names_of(const std::vector<Verb>& verbs) {
  std::vector<std::string> names;
  for (const Verb& verb : verbs) names.push_back(verb.name);
  return names;
}

// "maps:NAME" is completed up to the colon.
std::vector<std::string> offered(const Field& field) {
  std::vector<std::string> words;
  for (const std::string& choice : field.choices)
    words.push_back(choice.substr(0, choice.find(':') + (choice.find(':') != std::string::npos)));
  return words;
}

// ------------------------------------------------------------------------------------ bash

// Branches of a case statement for the values of options; `verb` is empty for common ones.
std::string bash_values(const std::string& verb, const std::vector<Field>& fields) {
  std::string text;
  for (const Field& field : fields) {
    const Value value = value_of(field);
    if (value == Value::kNone || field.positional) continue;
    std::vector<std::string> patterns;
    for (const std::string& flag : flags_of(field))
      patterns.push_back(verb.empty() ? "*' " + flag + "'" : "'" + verb + " " + flag + "'");
    text += "    " + joined(patterns, "|") + ") ";
    if (value == Value::kChoice)
      text += "COMPREPLY=($(compgen -W '" + joined(offered(field), " ") + "' -- \"$cur\"))";
    else if (value == Value::kFolder)
      text += "compopt -o filenames; COMPREPLY=($(compgen -d -- \"$cur\"))";
    else if (value == Value::kFile)
      text += ":";  // any file: what the shell does by itself
    else
      text += "compopt +o default";
    text += "; return ;;\n";
  }
  return text;
}

std::string bash_script(const std::vector<Verb>& verbs, const std::vector<Field>& common) {
  const std::string names = joined(names_of(verbs), " "), everywhere = all_flags(common);
  std::string text =
      "# bash completion of sketchsplat, written by `sketchsplat --completion bash`\n"
      "_sketchsplat() {\n"
      "  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]} verb= word words=\n"
      "  COMPREPLY=()\n"
      "  for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n"
      "    case $word in " +
      joined(names_of(verbs), "|") +
      ") verb=$word; break ;; esac\n"
      "  done\n"
      "  case \"$verb $prev\" in\n";
  for (const Verb& verb : verbs) text += bash_values(verb.name, verb.fields);
  text += bash_values("", common);
  text += "    *' --completion') COMPREPLY=($(compgen -W '" + joined(completion_shells(), " ") +
          "' -- \"$cur\")); return ;;\n"
          "  esac\n"
          "  case $verb in\n"
          "    '') words='" +
          names + " --help --version --man --completion' ;;\n";
  for (const Verb& verb : verbs)
    text += "    " + verb.name + ") [[ $cur == -* ]] || return; words='" + all_flags(verb.fields) +
            " --help' ;;\n";
  return text +
         "  esac\n"
         "  COMPREPLY=($(compgen -W \"$words " +
         everywhere +
         "\" -- \"$cur\"))\n"
         "}\n"
         "complete -o bashdefault -o default -F _sketchsplat sketchsplat\n";
}

// ------------------------------------------------------------------------------------- zsh

std::string zsh_escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '\'')
      safe += "'\\''";
    else if (c == '[' || c == ']' || c == ':')
      safe += std::string("\\") + c;
    else
      safe += c;
  }
  return safe;
}

std::string zsh_action(const Field& field) {
  const std::string name = zsh_escaped(field.unit.empty() ? "value" : field.unit);
  switch (value_of(field)) {
    case Value::kNone:
      return "";
    case Value::kChoice: {
      std::vector<std::string> words;
      for (const std::string& word : offered(field)) words.push_back(zsh_escaped(word));
      return ":value:(" + joined(words, " ") + ")";
    }
    case Value::kFolder:
      return ":" + name + ":_files -/";
    case Value::kFile:
      return ":" + name + ":_files";
    case Value::kAnything:
      return ":" + name + ": ";
  }
  return "";
}

std::string zsh_arguments(const std::vector<Field>& fields) {
  std::string text;
  for (const Field& field : fields) {
    const std::string action = zsh_action(field), several = field.several ? "*" : "";
    if (field.positional) text += " \\\n        '" + several + action + "'";
    for (const std::string& flag : flags_of(field))
      text += " \\\n        '" + several + flag + "[" + zsh_escaped(field.help) + "]" +
              (field.value_optional ? ":" : "") + action + "'";
  }
  return text;
}

std::string zsh_script(const std::vector<Verb>& verbs, const std::vector<Field>& common) {
  std::string text =
      "#compdef sketchsplat\n"
      "# zsh completion of sketchsplat, written by `sketchsplat --completion zsh`\n"
      "_sketchsplat() {\n"
      "  local curcontext=$curcontext state line\n"
      "  local -a verbs=(\n";
  for (const Verb& verb : verbs)
    text += "    '" + verb.name + ":" + zsh_escaped(verb.summary) + "'\n";
  text += "  )\n  _arguments -C '--help[Show help]' '--version[Show the version]'" +
          std::string(" '--man[Show the manual page]' '--completion[Show this]:shell:(") +
          joined(completion_shells(), " ") + ")'" + zsh_arguments(common) +
          " \\\n        '1:verb:->verb' '*::argument:->argument'\n"
          "  case $state in\n"
          "    verb) _describe verb verbs ;;\n"
          "    argument) case $words[1] in\n";
  for (const Verb& verb : verbs)
    text += "      " + verb.name + ") _arguments '--help[Show help]'" + zsh_arguments(verb.fields) +
            zsh_arguments(common) + " ;;\n";
  // Called as a file of $fpath, it is the function's first call.
  return text +
         "    esac ;;\n  esac\n}\n"
         "if [[ ${funcstack[1]} = _sketchsplat ]]; then\n  _sketchsplat \"$@\"\n"
         "else\n  compdef _sketchsplat sketchsplat\nfi\n";
}

// ------------------------------------------------------------------------------------ fish

std::string fish_quoted(const std::string& text) {
  std::string safe = "'";
  for (const char c : text)
    safe += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return safe + "'";
}

std::string fish_options(const std::string& condition, const std::vector<Field>& fields) {
  std::string text;
  for (const Field& field : fields) {
    const Value value = value_of(field);
    std::string end = " -d " + fish_quoted(field.help) + "\n";
    if (value == Value::kChoice)
      end = " -x -a " + fish_quoted(joined(offered(field), " ")) + end;
    else if (value == Value::kFile)
      end = (field.value_optional ? " -F" : " -r -F") + end;
    else if (value == Value::kFolder)
      end = " -x -a '(__fish_complete_directories)'" + end;
    else if (value == Value::kAnything)
      end = " -x" + end;
    for (const std::string& flag : flags_of(field))
      text += "complete -c sketchsplat" + condition +
              (flag[1] == '-' ? " -l " + flag.substr(2) : " -s " + flag.substr(1)) + end;
  }
  return text;
}

std::string fish_script(const std::vector<Verb>& verbs, const std::vector<Field>& common) {
  std::string text =
      "# fish completion of sketchsplat, written by `sketchsplat --completion fish`\n"
      "complete -c sketchsplat -n __fish_use_subcommand -f\n"
      "complete -c sketchsplat -l help -d 'Show help'\n"
      "complete -c sketchsplat -n __fish_use_subcommand -l version -d 'Show the version'\n"
      "complete -c sketchsplat -n __fish_use_subcommand -l man -d 'Show the manual page'\n"
      "complete -c sketchsplat -n __fish_use_subcommand -l completion -x -a '" +
      joined(completion_shells(), " ") + "'\n";
  for (const Verb& verb : verbs)
    text += "complete -c sketchsplat -n __fish_use_subcommand -a " + verb.name + " -d " +
            fish_quoted(verb.summary) + "\n";
  text += fish_options("", common);
  for (const Verb& verb : verbs)
    text += fish_options(" -n '__fish_seen_subcommand_from " + verb.name + "'", verb.fields);
  return text;
}

}  // namespace

const std::vector<std::string>& completion_shells() {
  static const std::vector<std::string> shells = {"bash", "zsh", "fish"};
  return shells;
}

std::string completion_script(const std::string& shell, const std::vector<Verb>& verbs,
                              const std::vector<Field>& common) {
  if (shell == "zsh") return zsh_script(verbs, common);
  return shell == "fish" ? fish_script(verbs, common) : bash_script(verbs, common);
}

}  // namespace sketchsplat
