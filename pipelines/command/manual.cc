// SPDX-License-Identifier: MIT
#include "pipelines/command/manual.h"

#include "pipelines/base/version.h"
#include "pipelines/command/cli_help.h"

namespace sketchsplat {
namespace {

// A text as troff takes it: ASCII, no control characters of its own at the start of a line.
std::string plain(const std::string& text) {
  std::string safe;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\\')
      safe += "\\e";
    else if (c == '-')
      safe += "\\-";
    else if (text.compare(i, 3, "…") == 0)
      safe += "...", i += 2;
    else if (i == 0 && (c == '.' || c == '\''))
      safe += std::string("\\&") + c;
    else
      safe += c;
  }
  return safe;
}

std::string options(const std::vector<Field>& fields) {
  std::string text, group;
  for (const Field& field : fields) {
    if (field.group != group) text += ".PP\n.I " + plain(field.group) + "\n";
    group = field.group;
    const std::string fact = facts(field);
    text += ".TP\n.B " + plain(with_short_name(field)) + "\n" + plain(field.help) +
            (fact.empty() ? "." : " " + plain(fact) + ".") + "\n";
  }
  return text;
}

std::string examples(const std::vector<std::string>& lines) {
  std::string text = ".nf\n";
  for (const std::string& line : lines) text += plain(line) + "\n";
  return text + ".fi\n";
}

}  // namespace

std::string manual_page(const std::vector<Verb>& verbs, const std::vector<Field>& common) {
  std::string text = ".TH SKETCHSPLAT 1 \"\" \"sketchsplat " + program_version() +
                     "\" \"User Commands\"\n"
                     ".SH NAME\n"
                     "sketchsplat \\- calibrated images of a CAD object become its edges as exact "
                     "curves\n"
                     ".SH SYNOPSIS\n";
  for (const Verb& verb : verbs) text += ".B " + plain(usage_line(verb)) + "\n.br\n";
  text +=
      ".SH DESCRIPTION\n"
      "Reads a folder of calibrated images of a CAD object and writes its edges as lines, arcs,\n"
      "circles, ellipses and splines that share their corners: STEP, OBJ and JSON, and a report\n"
      "to look at. Results go to files and to standard output, everything else to standard "
      "error.\n";
  for (const Verb& verb : verbs)
    text += ".SH \"" + plain(verb.name) + "\"\n" + plain(verb.summary) + ".\n.PP\n" +
            examples(verb.examples) + options(verb.fields);
  text += ".SH OPTIONS OF ALL VERBS\n" + options(common);
  text +=
      ".SH EXIT STATUS\n"
      "0 done; 2 wrong usage; 3 the input cannot be used; 4 too little in the scene; 5 the output\n"
      "cannot be written; 6 a batch of which some scenes failed; 7 inspected and not\n"
      "all in; 1 a defect of the program.\n"
      ".SH ENVIRONMENT\n"
      ".TP\n.B NO_COLOR\nIf set, warnings and errors on a terminal have no colour.\n"
      ".TP\n.B OMP_NUM_THREADS\nThreads to use if \\-\\-threads is left out.\n";
  return text;
}

}  // namespace sketchsplat
