// The command line of a tool: its options, its help and its exit code, by Boost.Program_options. The headers of that
// take longer to compile than a tool, and are included in command_line.cpp alone.
#pragma once

#include <functional>
#include <limits>
#include <set>
#include <string>
#include <vector>

namespace afm {

// The bounds of an option, both included.
struct Within {
  double least, most;
};
constexpr Within kAny{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
constexpr Within kPositive{std::numeric_limits<double>::min(), std::numeric_limits<double>::infinity()};

class CommandLine {
 public:
  CommandLine(std::string tool, std::string description)
      : tool_(std::move(tool)), description_(std::move(description)) {}

  // --name VALUE: a number, a text, or a list of them with spaces or commas between. The value that it holds now is the
  // default; the help shows it.
  template <class T>
  void option(const std::string& name, T& value, const std::string& help, Within range = kAny);
  void flag(const std::string& name, bool& value, const std::string& help);
  // The value that stands without an option.
  void arguments(const std::string& name, std::vector<std::string>& values, const std::string& help);
  // An option, or the arguments, that must be given.
  void require(const std::string& name) { required_.push_back(name); }
  // The end of the help.
  void footer(const std::string& text) { footer_ = text; }
  // True if the option stands on the command line; false before run() has read it.
  bool is_given(const std::string& name) const { return given_.count(name) > 0; }

  // What the user should know of, on standard error; the work goes on.
  void warn(const std::string& what) const;

  // Reads the options, then works. Exit code 0 for --help; 2 for a wrong option and for std::invalid_argument from the
  // work; `failure` for other exceptions, and where the standard output cannot be written; else what the work returns.
  int run(int argc, char** argv, const std::function<int()>& work, int failure = 1);

 private:
  enum class Takes { nothing, one, many };
  struct Option {
    std::string name, help;
    Takes takes;
    std::function<void(const std::vector<std::string>&)> take;
  };
  bool read(int argc, char** argv);

  std::string tool_, description_, footer_, arguments_;
  std::vector<Option> options_;
  std::vector<std::string> required_;
  std::set<std::string> given_;
};

}  // namespace afm
