// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace sketchsplat {

/// The command line was used wrongly; one sentence. Exit status 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// An enum member seen as an index into Field::choices.
struct Choice {
  std::function<int()> get;
  std::function<void(int)> set;
};

/// One member of an options struct as users see it: the flag, its line in --help, its record in
/// report.json and its row in OPTIONS.md are all made from this.
struct Field {
  std::string name;  ///< "merge-px": flag --merge-px, key in the report
  std::variant<bool*, int*, double*, std::string*, Choice> value;
  std::string unit;  ///< "px", "s"; empty if it has none; what stands for the value if it is text
  double low = -std::numeric_limits<double>::infinity();  ///< closed range of a number
  double high = std::numeric_limits<double>::infinity();
  std::vector<std::string> choices;  ///< allowed texts; "maps:NAME" allows any text after "maps:"
  bool many = false;       ///< the text is "none", or some of the choices with commas between
  std::string help;        ///< one line, no full stop
  std::string group;       ///< heading in --help
  std::string initial;     ///< text of the value when it was listed: the default
  std::string short_name;  ///< "o": also -o; empty if there is none
  bool required = false;
  std::string unless;  ///< a required option need not be given if this one is
  bool positional = false;
  bool several = false;         ///< a text that may be given many times, joined by '\n'
  bool takes_more = false;      ///< all values up to the next flag, not one at a time
  bool value_optional = false;  ///< "--name" alone is a text "-"
  bool alone = false;           ///< a flag that is a task of its own: nothing else is required then
  bool expert = false;          ///< shown by --help-all, not by --help
  std::function<void()> applied;  ///< called after a user's value was assigned; may be empty
};

/// Lists the members of option structs, one line each. The structs need not know.
class Fields {
 public:
  /// Fields that follow are of this group. `expert`: see Field.
  void group(const std::string& heading, bool expert = false) {
    group_ = heading, expert_ = expert;
  }

  /// `low` to `high`: the closed range.
  Field& add(const std::string& name, std::variant<int*, double*> value, const std::string& unit,
             double low, double high, const std::string& help);
  Field& add(const std::string& name, bool* value, const std::string& help);
  /// `placeholder` is what --help shows for the value: FILE, DIR.
  Field& add(const std::string& name, std::string* value, const std::string& placeholder,
             const std::string& help);
  Field& choose(const std::string& name, std::string* value,
                const std::vector<std::string>& choices, const std::string& help);
  /// Some of `choices`, or "none": a text of them in the order of `choices`, with commas between.
  Field& pick(const std::string& name, std::string* value, const std::vector<std::string>& choices,
              const std::string& help);
  /// `choices` in the order of the enum's values, which count from 0.
  template <typename Enum>
  Field& choose(const std::string& name, Enum* value, const std::vector<std::string>& choices,
                const std::string& help) {
    return push(name, Choice{[value] { return int(*value); }, [value](int i) { *value = Enum(i); }},
                choices, help);
  }

  std::vector<Field> list;

 private:
  Field& push(const std::string& name, decltype(Field::value) value,
              const std::vector<std::string>& choices, const std::string& help);
  std::string group_ = "Options";
  bool expert_ = false;
};

/// The values of a text that may be given several times.
std::vector<std::string> lines_of(const std::string& text);

/// The value as text: what a user would type to get it.
std::string text_of(const Field& field);

/// Parses, checks the range and assigns. Throws UsageError with name, what is allowed, what it got.
/// Nothing is assigned then.
void assign(const Field& field, const std::string& text);

/// What is allowed, in words: "a whole number from 1 to 50", "one of step, obj".
std::string allowed(const Field& field);

/// "[px, 0.1 to 10, default 1]": what stands behind the help line.
std::string facts(const Field& field);

/// Field by its name; null if there is none.
const Field* find_field(const std::vector<Field>& fields, const std::string& name);

/// Is it one of the words of a text that was made by Fields::pick()?
bool picked(const std::string& text, const std::string& word);

/// The candidate that is nearest to a mistyped word, or nothing if none is near.
std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates);

/// The complaint that a verb has no option that is called so (as given, with or without dashes):
/// with the choice of Fields::pick() that replaces it, or the name that was probably meant.
std::string unknown_option(const std::vector<Field>& fields, const std::string& given,
                           const std::string& verb);

/// All values as one JSON object (as text), in the order of the list.
std::string fields_json(const std::vector<Field>& fields);

}  // namespace sketchsplat
