// The command line of a tool: its options, its help and its exit code. Boost.Program_options does the work, in
// command_line.cpp alone: its headers take longer to compile than a tool.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace afm {

// What an option may be, both ends included.
struct Within {
  double least, most;
};
constexpr Within kAny{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
constexpr Within kPositive{std::numeric_limits<double>::min(), std::numeric_limits<double>::infinity()};

class CommandLine {
 public:
  CommandLine(std::string tool, std::string description);
  ~CommandLine();

  // --name VALUE. The value that it holds now is the default, and is shown in the help. A list takes several values,
  // with spaces or commas between them.
  void option(const std::string& name, double& value, const std::string& help, Within range = kAny);
  void option(const std::string& name, int& value, const std::string& help, Within range = kAny);
  void option(const std::string& name, unsigned& value, const std::string& help, Within range = kAny);
  void option(const std::string& name, std::int64_t& value, const std::string& help, Within range = kAny);
  void option(const std::string& name, std::uint64_t& value, const std::string& help, Within range = kAny);
  void option(const std::string& name, std::string& value, const std::string& help);
  void option(const std::string& name, std::vector<double>& values, const std::string& help);
  void option(const std::string& name, std::vector<std::string>& values, const std::string& help);
  void flag(const std::string& name, bool& value, const std::string& help);

  // What stands without an option.
  void arguments(const std::string& name, std::vector<std::string>& values, const std::string& help);
  // An option, or the arguments, that must be given.
  void require(const std::string& name);
  // Whether the option stands on the command line; false before run() has read it.
  bool is_given(const std::string& name) const;
  // What the help ends with.
  void footer(const std::string& text);

  // Reads the options, then works. Exit code 0 for --help; 2 for a wrong option and for std::invalid_argument from the
  // work; 1 for other exceptions, and where the standard output cannot be written; else what the work returns.
  int run(int argc, char** argv, const std::function<int()>& work);

 private:
  struct Parts;

  template <class T>
  void add_number(const std::string& name, T& value, const std::string& help, Within range);
  void add(const std::string& name, const std::string& help, const std::string& default_text,
           const std::function<void(const std::string&)>& take);
  void add_list(const std::string& name, const std::string& help,
                const std::function<void(const std::vector<std::string>&)>& take);
  bool read(int argc, char** argv);
  void print_help() const;

  std::unique_ptr<Parts> parts_;
};

}  // namespace afm
