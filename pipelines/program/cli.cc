// SPDX-License-Identifier: MIT
#include "pipelines/command/cli.h"

#include <cxxabi.h>
#include <omp.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <map>
#include <opencv2/core.hpp>
#include <typeinfo>

#include "datasets/types/errors.h"
#include "pipelines/base/atomic_file.h"
#include "pipelines/base/version.h"
#include "pipelines/batch/run.h"
#include "pipelines/command/cli_help.h"

namespace sketchsplat {
namespace {

constexpr char kOutOfMemory[] = "out of memory";

using Texts = std::map<std::string, std::string>;  // option -> what the user gave

// Belongs to one run, not to a way of working: no file of options may hold it.
bool is_of_one_run(const Field& field) {
  return field.positional || field.required || field.alone || field.name == "log" ||
         field.name == "save-config" || field.name == "dry-run";
}

// Lets CLI11 collect the texts of these fields; values are parsed by assign(), in one place.
void register_fields(CLI::App* app, const std::vector<Field>& fields) {
  for (const Field& field : fields) {
    const std::string short_name = field.short_name.empty() ? "" : "-" + field.short_name + ",";
    CLI::Option* option = nullptr;
    if (field.name == "config")
      option = app->set_config("--config")->take_last();
    else if (std::holds_alternative<bool*>(field.value))
      option = app->add_flag(short_name + "--" + field.name + ",!--no-" + field.name);
    else
      option = app->add_option(field.positional ? field.name : short_name + "--" + field.name);
    if (field.several)
      option->expected(1, -1)->take_all()->allow_extra_args(field.positional || field.takes_more);
    else
      option->take_last();
    if (field.value_optional) option->expected(0, 1);
    if (field.name != "config") option->configurable(!is_of_one_run(field));
  }
}

// Of the command line and, if that leaves an option out, of the file of --config.
Texts texts_of(const CLI::App& app, const std::vector<Field>& fields) {
  Texts texts;
  for (const Field& field : fields) {
    const CLI::Option* option = app.get_option(field.positional ? field.name : "--" + field.name);
    if (option->count() == 0) continue;
    std::string& all = texts[field.name];
    for (const std::string& text : option->reduced_results())
      all += (all.empty() ? "" : "\n") + text;
    if (field.value_optional && all.empty()) all = "-";
  }
  return texts;
}

void assign_texts(const std::vector<Field>& fields, const Texts& texts) {
  for (const Field& field : fields) {
    const auto given = texts.find(field.name);
    if (given == texts.end()) continue;
    assign(field, given->second);
    if (field.applied) field.applied();
  }
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
  if (extra.size() > 1 && extra[0] == '-') throw UsageError(unknown_option(fields, extra, verb));
  throw UsageError("unexpected argument " + extra + " (see sketchsplat " + verb + " --help)");
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
  bool help = false, help_all = false, version = false, markdown = false;
  std::vector<CLI::App*> subcommands;

  Parser(const std::vector<Verb>& verbs, const std::vector<Field>& common) {
    app.set_help_flag();
    app.add_flag("-h,--help", help);
    app.add_flag("--help-all", help_all);
    app.add_flag("--version", version);
    app.add_flag("--options-markdown", markdown);
    app.allow_extras();
    app.allow_config_extras(CLI::config_extras_mode::error);
    register_fields(&app, common);
    for (const Verb& verb : verbs) {
      CLI::App* sub = app.add_subcommand(verb.name);
      sub->set_help_flag();
      sub->fallthrough();
      register_fields(sub, verb.fields);
      subcommands.push_back(sub);
    }
  }

  void parse(int argc, const char* const* argv) {
    const auto file = [&] { return app.get_option("--config")->results().back(); };
    try {
      app.parse(argc, argv);
    } catch (const CLI::FileError&) {
      throw InputError(file(), "a file of options", "none that can be read");
    } catch (const CLI::ConfigError& e) {
      throw InputError(file(), "lines NAME = VALUE, those of a verb below a line [VERB]", e.what());
    }
  }
};

// Assigns all options and does the work of the verb.
void run_verb(const Verb& verb, const Parser& parser, const CLI::App& sub, CommonOptions* common,
              const std::vector<Field>& common_fields) {
  const Texts texts = texts_of(sub, verb.fields);
  check_required(verb, texts);
  try {
    assign_texts(common_fields, texts_of(parser.app, common_fields));
    assign_texts(verb.fields, texts);
  } catch (const UsageError& e) {
    if (common->config.empty()) throw;
    throw UsageError(e.what() + std::string(", on the command line or in ") + common->config);
  }
  if (!common->save_config.empty())
    write_text(common->save_config, "[" + verb.name + "]\n" + sub.config_to_str());
  if (common->threads > 0) omp_set_num_threads(common->threads);
  Progress progress(progress_mode(*common), common->verbose && !common->quiet);
  progress.use_color(Progress::stderr_has_color());
  if (!common->log.empty()) progress.log_to(common->log);
  try {
    verb.run(*common, &progress);
  } catch (const std::exception& e) {
    progress.log(e.what());
    throw;
  }
  progress.repeat_warnings();
}

void run(int argc, const char* const* argv, const std::vector<Verb>& verbs) {
  CommonOptions common;
  Fields common_fields;
  list_fields(&common, &common_fields);
  Parser parser(verbs, common_fields.list);
  parser.parse(argc, argv);

  const Verb* verb = nullptr;
  const CLI::App* sub = nullptr;
  for (size_t i = 0; i < verbs.size(); ++i)
    if (parser.subcommands[i]->parsed()) verb = &verbs[i], sub = parser.subcommands[i];
  const std::vector<std::string> extras = parser.app.remaining(true);
  // "sketchsplat help reconstruct", as in COLMAP.
  const bool help_word = argc > 1 && std::string(argv[1]) == "help";
  const bool help = parser.help || parser.help_all;

  if (parser.version) {
    std::cout << "sketchsplat " << program_version() << "\ncommit " << program_commit() << "\nwith "
              << library_versions() << "\n";
  } else if (parser.markdown) {
    std::cout << options_markdown(verbs);
  } else if ((help || help_word) && verb) {
    std::cout << verb_help(*verb, common_fields.list, parser.help_all);
  } else if ((help && extras.empty()) || (help_word && extras.size() == 1)) {
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
    run_verb(*verb, parser, *sub, &common, common_fields.list);
  }
}

int complain(ExitStatus status, const std::string& text) {
  const bool color = Progress::stderr_has_color();
  std::fprintf(stderr, color ? "\033[31msketchsplat:\033[0m %s\n" : "sketchsplat: %s\n",
               one_line(text).c_str());
  return status;
}

// Some libraries allocate in destructors (Open CASCADE's sessions, JSON, Ceres' timers), which no
// exception can leave. The compiler does not always name the exception. Any other one is a defect
// and should leave a core file.
[[noreturn]] void end_without_memory() {
  const std::type_info* const type = abi::__cxa_current_exception_type();
  const char* const name = type ? type->name() : "";
  const bool unknown = !type && std::uncaught_exceptions() > 0;
  if (!unknown && !std::strstr(name, "bad_alloc") && !std::strstr(name, "OutOfMemory"))
    std::abort();
  std::fprintf(stderr, "sketchsplat: %s\n",
               unknown ? "a destructor failed, most likely out of memory" : kOutOfMemory);
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
    std::signal(e.number, SIG_DFL);  // so that the parent process sees it
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
    return complain(kDefect, "a defect of the program: an unknown exception");
  }
}

}  // namespace sketchsplat
