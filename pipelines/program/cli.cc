// SPDX-License-Identifier: MIT
#include "pipelines/command/cli.h"

#include <cxxabi.h>
#include <omp.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <map>
#include <memory>
#include <opencv2/core.hpp>
#include <typeinfo>

#include "datasets/types/errors.h"
#include "pipelines/base/atomic_file.h"
#include "pipelines/base/version.h"
#include "pipelines/batch/run.h"
#include "pipelines/command/cli_help.h"
#include "pipelines/command/completion.h"
#include "pipelines/command/config_file.h"
#include "pipelines/command/manual.h"

namespace sketchsplat {
namespace {

constexpr char kOutOfMemory[] = "out of memory";

using Texts = std::map<std::string, std::string>;  // option -> what the user gave

// Lets CLI11 collect the texts of these fields; values are parsed by assign(), in one place.
void register_fields(CLI::App* app, const std::vector<Field>& fields, Texts* texts) {
  for (const Field& field : fields) {
    const std::string name = field.name;
    if (std::holds_alternative<bool*>(field.value)) {
      const std::string short_flag = field.short_name.empty() ? "" : "-" + field.short_name + ",";
      app->add_flag_callback(short_flag + "--" + name, [=] { (*texts)[name] = "true"; });
      app->add_flag_callback("--no-" + name, [=] { (*texts)[name] = "false"; });
      continue;
    }
    std::string flags = field.positional ? name : "--" + name;
    if (!field.short_name.empty()) flags = "-" + field.short_name + "," + flags;
    if (field.several || field.value_optional) {
      CLI::Option* option = app->add_option_function<std::vector<std::string>>(
          flags, [=](const std::vector<std::string>& given) {
            std::string& all = (*texts)[name];
            for (const std::string& text : given) all += (all.empty() ? "" : "\n") + text;
            if (field.value_optional && all.empty()) all = "-";
          });
      option->allow_extra_args(field.positional || field.takes_more);
      if (field.value_optional) option->expected(0, 1)->take_last();
      continue;
    }
    CLI::Option* option = app->add_option_function<std::string>(
        flags, [=](const std::string& text) { (*texts)[name] = text; });
    option->take_last()->type_name("value");
  }
}

void assign_texts(const std::vector<Field>& fields, const Texts& texts) {
  for (const Field& field : fields) {
    const auto given = texts.find(field.name);
    if (given == texts.end()) continue;
    assign(field, given->second);
    if (field.applied) field.applied();
  }
}

// What --config names comes first, so that the command line has the last word.
void assign_all(const CommonOptions& common, const Verb& verb,
                const std::vector<Field>& common_fields, const Texts& texts,
                const Texts& common_texts) {
  assign_texts(common_fields, common_texts);
  if (!common.config.empty()) {
    const std::string config = common.config;
    std::vector<Field> fields = common_fields;
    fields.insert(fields.end(), verb.fields.begin(), verb.fields.end());
    try {
      assign_texts(fields, read_config(config, verb.name, fields));
    } catch (const UsageError& e) {
      throw InputError(config, "options as on the command line", e.what());
    }
    assign_texts(common_fields, common_texts);
  }
  assign_texts(verb.fields, texts);
  if (common.save_config.empty()) return;
  const std::string text = config_text(verb.name, verb.fields);
  write_atomically(common.save_config, [&](std::ostream& out) { out << text; });
}

void check_required(const Verb& verb, const Texts& texts) {
  for (const Field& field : verb.fields)
    if (field.alone && texts.count(field.name)) return;
  for (const Field& field : verb.fields) {
    if (!field.required || texts.count(field.name) || texts.count(field.unless)) continue;
    std::string what = field.positional ? field.unit : "--" + field.name + " " + field.unit;
    if (const Field* other = find_field(verb.fields, field.unless))
      what += " or --" + other->name + " " + other->unit;
    throw UsageError(verb.name + " needs " + what + "; usage: " + usage_line(verb));
  }
}

// CLI11 leaves what it does not know in remaining().
[[noreturn]] void refuse_extra(const std::string& extra, const std::vector<Field>& fields,
                               const std::string& verb) {
  std::vector<std::string> flags = {"--help", "--help-all", "--version"};
  for (const Field& field : fields)
    if (!field.positional) flags.push_back("--" + field.name);
  const bool is_flag = extra.size() > 1 && extra[0] == '-';
  const std::string flag = extra.substr(0, extra.find('='));
  const std::string near = is_flag ? nearest_word(flag, flags) : "";
  const std::string now = flag.rfind("--", 0) == 0 ? successor(fields, flag.substr(2)) : "";
  throw UsageError((is_flag ? "unknown option " : "unexpected argument ") + extra +
                   (!now.empty()   ? ", replaced by --" + now
                    : near.empty() ? ""
                                   : ", did you mean " + near + "?") +
                   " (see sketchsplat " + (verb.empty() ? "" : verb + " ") + "--help)");
}

std::string verb_names(const std::vector<Verb>& verbs) {
  std::string names;
  for (const Verb& verb : verbs) names += (names.empty() ? "" : ", ") + verb.name;
  return names;
}

[[noreturn]] void refuse_verb(const std::string& word, const std::vector<Verb>& verbs) {
  std::vector<std::string> names;
  for (const Verb& verb : verbs) names.push_back(verb.name);
  const std::string near = nearest_word(word, names);
  throw UsageError("unknown verb " + word + (near.empty() ? "" : ", did you mean " + near + "?") +
                   " (the verbs are " + verb_names(verbs) + ")");
}

Progress::Mode progress_mode(const CommonOptions& common) {
  if (common.quiet) return Progress::Mode::kSilent;
  return Progress::stderr_is_terminal() ? Progress::Mode::kBar : Progress::Mode::kLines;
}

// The parser of the whole program; its shape is the verbs'.
struct Parser {
  CLI::App app;
  Texts texts, common_texts;  // of the verb, of all verbs: they may share names
  bool help = false, help_all = false, version = false, markdown = false, manual = false;
  std::string completion;  // a shell
  std::vector<CLI::App*> subcommands;

  Parser(const std::vector<Verb>& verbs, const std::vector<Field>& common) {
    app.set_help_flag();
    app.add_flag("-h,--help", help);
    app.add_flag("--help-all", help_all);
    app.add_flag("--version", version);
    app.add_flag("--options-markdown", markdown);
    app.add_flag("--man", manual);
    app.add_option("--completion", completion);
    app.allow_extras();
    register_fields(&app, common, &common_texts);
    for (const Verb& verb : verbs) {
      CLI::App* sub = app.add_subcommand(verb.name);
      sub->set_help_flag();
      sub->fallthrough();
      register_fields(sub, verb.fields, &texts);
      subcommands.push_back(sub);
    }
  }
};

void run(int argc, const char* const* argv, const std::vector<Verb>& verbs) {
  CommonOptions common;
  Fields common_fields;
  list_fields(&common, &common_fields);
  Parser parser(verbs, common_fields.list);
  parser.app.parse(argc, argv);

  const Verb* verb = nullptr;
  for (size_t i = 0; i < verbs.size(); ++i)
    if (parser.subcommands[i]->parsed()) verb = &verbs[i];
  const std::vector<std::string> extras = parser.app.remaining(true);
  // "sketchsplat help reconstruct", as in COLMAP.
  const bool help_word = argc > 1 && std::string(argv[1]) == "help";

  if (parser.version) {
    std::cout << "sketchsplat " << program_version() << "\ncommit " << program_commit() << "\nwith "
              << library_versions() << "\n";
  } else if (parser.markdown) {
    std::cout << options_markdown(verbs);
  } else if (parser.manual) {
    std::cout << manual_page(verbs, common_fields.list);
  } else if (!parser.completion.empty()) {
    const std::vector<std::string>& shells = completion_shells();
    if (std::find(shells.begin(), shells.end(), parser.completion) == shells.end())
      throw UsageError("--completion: expected bash, zsh or fish, got '" + parser.completion + "'");
    std::cout << completion_script(parser.completion, verbs, common_fields.list);
  } else if ((parser.help || parser.help_all || help_word) && verb) {
    std::cout << verb_help(*verb, common_fields.list, parser.help_all);
  } else if (((parser.help || parser.help_all) && extras.empty()) ||
             (help_word && extras.size() == 1)) {
    std::cout << program_help(verbs, common_fields.list);
  } else if (!verb) {
    if (extras.empty()) throw UsageError("expected a verb: " + verb_names(verbs));
    if (extras[0][0] == '-') refuse_extra(extras[0], common_fields.list, "");
    refuse_verb(extras[help_word ? 1 : 0], verbs);
  } else {
    if (!extras.empty()) {
      std::vector<Field> known = verb->fields;
      known.insert(known.end(), common_fields.list.begin(), common_fields.list.end());
      refuse_extra(extras[0], known, verb->name);
    }
    check_required(*verb, parser.texts);
    assign_all(common, *verb, common_fields.list, parser.texts, parser.common_texts);
    if (common.threads > 0) omp_set_num_threads(common.threads);
    Progress progress(progress_mode(common), common.verbose && !common.quiet);
    progress.use_color(Progress::stderr_has_color());
    if (!common.log.empty()) progress.log_to(common.log);
    try {
      verb->run(common, &progress);
    } catch (const std::exception& e) {
      progress.log(e.what());
      throw;
    }
    progress.repeat_warnings();
  }
}

int complain(ExitStatus status, const std::string& text) {
  const bool color = Progress::stderr_has_color();
  std::fprintf(stderr, color ? "\033[31msketchsplat:\033[0m %s\n" : "sketchsplat: %s\n",
               one_line(text).c_str());
  return status;
}

// Some libraries ask for memory in destructors (Open CASCADE's sessions, JSON, Ceres' timers),
// which no exception can leave: this is what is left to say then. The compiler does not always
// tell which exception it was. All else is a defect, and worth a core.
[[noreturn]] void end_without_memory() {
  const std::type_info* const type = abi::__cxa_current_exception_type();
  const char* const name = type ? type->name() : "";
  const bool unknown = !type && std::uncaught_exceptions() > 0;
  if (!unknown && !std::strstr(name, "bad_alloc") && !std::strstr(name, "OutOfMemory"))
    std::abort();
  std::fprintf(stderr, "sketchsplat: %s\n",
               unknown ? "a destructor failed, most likely for want of memory" : kOutOfMemory);
  ::_exit(kDefect);
}

}  // namespace

std::vector<Verb> all_verbs() {
  return {reconstruct_verb(), batch_verb(),   detect_verb(),     evaluate_verb(),
          export_verb(),      inspect_verb(), synthesize_verb(), bench_verb()};
}

int run_command_line(int argc, const char* const* argv, const std::vector<Verb>& verbs) {
  std::set_terminate(end_without_memory);
  try {
    run(argc, argv, verbs);
    std::cout.flush();
    if (!std::cout) return complain(kNoOutput, "standard output cannot be written");
    return kDone;
  } catch (const UsageError& e) {
    return complain(kWrongUsage, e.what());
  } catch (const CLI::ParseError& e) {
    return complain(kWrongUsage, e.what());
  } catch (const InputError& e) {
    return complain(kBadInput, e.what());
  } catch (const TooLittleError& e) {
    return complain(kTooLittle, e.what());
  } catch (const OutputError& e) {
    return complain(kNoOutput, e.what());
  } catch (const SomeFailedError& e) {
    std::cout.flush();
    return complain(kSomeFailed, e.what());
  } catch (const NotAllInError& e) {
    std::cout.flush();
    return complain(kNotAllIn, e.what());
  } catch (const Interrupted& e) {
    complain(kDefect, e.what());
    std::signal(e.number, SIG_DFL);  // whoever waits for us shall know
    std::raise(e.number);
    return 128 + e.number;
  } catch (const std::bad_alloc&) {
    return complain(kDefect, kOutOfMemory);
  } catch (const cv::Exception& e) {
    if (e.code == cv::Error::StsNoMem) return complain(kDefect, kOutOfMemory);
    return complain(kDefect, std::string("a defect of the program: ") + e.what());
  } catch (const std::exception& e) {
    return complain(kDefect, std::string("a defect of the program: ") + e.what());
  } catch (...) {
    return complain(kDefect, "a defect of the program: an exception without a word");
  }
}

}  // namespace sketchsplat
