// The command line of a tool: its options, its help and its exit code, by Boost.Program_options. The headers of that
// take longer to compile than a tool, and are included in command_line.cpp alone.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace boost {
namespace program_options {
class options_description;
}
}  // namespace boost

namespace afm {

// The bounds of an option, both included.
struct Within {
  double least, most;
};
constexpr Within kAny{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
constexpr Within kPositive{std::numeric_limits<double>::min(), std::numeric_limits<double>::infinity()};

class CommandLine {
 public:
  CommandLine(const std::string& tool, const std::string& description);

  // --name VALUE: a number or a text. The value that it holds now is the default; the help shows it.
  template <class T>
  void option(const std::string& name, T& value, const std::string& help, Within range = kAny);
  void option(const std::string& name, std::string& value, const std::string& help);
  // --name VALUES: texts, with spaces or commas between.
  void option(const std::string& name, std::vector<std::string>& values, const std::string& help);
  // --name VALUES: numbers and ranges FROM:TO:STEP (decimal_range.h), with spaces or commas between. `standard` is the
  // default as such a text; empty: what `values` holds.
  void ranges(const std::string& name, std::vector<double>& values, const std::string& standard,
              const std::string& help);
  void flag(const std::string& name, bool& value, const std::string& help);
  // The value that stands without an option.
  void arguments(const std::string& name, std::vector<std::string>& values, const std::string& help);
  // True if the option or flag stands on the command line; false before run() has read it.
  bool is_given(const std::string& name) const { return given_.count(name) > 0; }

  // What the user should know of, on standard error; the work goes on.
  void warn(const std::string& what) const;

  // Reads the options, then works. Exit code 0 for --help; 2 for a wrong option and for std::invalid_argument from the
  // work; `failure` for other exceptions, and where the standard output cannot be written; else what the work returns.
  int run(int argc, char** argv, const std::function<int()>& work, int failure = 1);

 private:
  bool read(int argc, char** argv);

  std::string tool_, usage_, description_;
  std::shared_ptr<boost::program_options::options_description> options_;
  std::vector<std::string>* arguments_ = nullptr;
  std::set<std::string> given_;
};

}  // namespace afm
