// SPDX-License-Identifier: MIT
// In: verbs with their options. Out: the command line that they make, its help and exit statuses.
// This folder may not include the method or what is written of it.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "pipelines/base/fields.h"
#include "pipelines/base/progress.h"
#include "pipelines/options/common_options.h"

namespace sketchsplat {

struct OpenOptions;

/// Exit status of the program.
enum ExitStatus {
  kDone = 0,
  kDefect = 1,
  kWrongUsage = 2,
  kBadInput = 3,
  kTooLittle = 4,
  kNoOutput = 5,
  kSomeFailed = 6,
  kNotAllIn = 7,
};

/// An inspected part is not within its tolerances; one sentence. Exit status 7.
struct NotAllInError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Some scenes of a batch are not done; one sentence with their names. Exit status 6.
struct SomeFailedError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// One word after the program's name. `fields` point into storage that `run` keeps alive.
struct Verb {
  std::string name;
  std::string summary;                ///< one line
  std::vector<std::string> examples;  ///< whole command lines
  std::vector<Field> fields;          ///< values are assigned in this order, after the defaults
  std::function<void(const CommonOptions&, Progress*)> run;  ///< throws; writes results to stdout
};

/// Parses the command line, runs the verb, maps exceptions to one line on stderr and an ExitStatus.
int run_command_line(int argc, const char* const* argv, const std::vector<Verb>& verbs);

/// All verbs and their options as Markdown tables: OPTIONS.md.
std::string options_markdown(const std::vector<Verb>& verbs);

/// --format and --allow-outside of the verbs that read scenes, for experts.
void list_open_fields(OpenOptions* options, Fields* fields);

// The verbs, a file each (cli_<verb>.cc).
Verb reconstruct_verb();
Verb detect_verb();
Verb evaluate_verb();
Verb export_verb();
Verb inspect_verb();
Verb synthesize_verb();
Verb bench_verb();
Verb batch_verb();
std::vector<Verb> all_verbs();

/// The file of the plug-in that makes synthetic scenes.
std::string synthesis_plugin_path();

}  // namespace sketchsplat
