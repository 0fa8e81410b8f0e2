#include "command_line.h"

#include <algorithm>
#include <boost/lexical_cast.hpp>
#include <boost/program_options.hpp>
#include <exception>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <type_traits>

#include "afm/number_text.h"

namespace afm {
namespace po = boost::program_options;
namespace {

constexpr unsigned kColumns = 110;  // of the help
// Long options only, and none is guessed from its first letters: "-3.4" is a value.
constexpr int kStyle = po::command_line_style::allow_long | po::command_line_style::long_allow_adjacent |
                       po::command_line_style::long_allow_next;

// Holds arguments where none are expected.
const std::string kUnexpected = "unexpected";

[[noreturn]] void refuse(const std::string& name, const std::string& text, const std::string& reason) {
  throw std::invalid_argument("--" + name + " = " + text + ": " + reason);
}

template <class T>
std::string text_of(const T& value) {
  if constexpr (std::is_floating_point<T>::value) return number_text(value);
  std::ostringstream text;
  text << value;
  return text.str();
}

template <class T>
T number(const std::string& name, const std::string& text, Within range) {
  constexpr const char* kKind = std::is_unsigned<T>::value   ? "must be a whole number, not below 0"
                                : std::is_integral<T>::value ? "must be a whole number"
                                                             : "must be a number";
  T value;
  // an unsigned number would take a minus, and be huge
  const bool minus = std::is_unsigned<T>::value && !text.empty() && text[0] == '-';
  if (minus || !boost::conversion::try_lexical_convert(text, value)) refuse(name, text, kKind);
  const double size = static_cast<double>(value);
  if (range.least == kPositive.least && !(size > 0.0)) refuse(name, text, "must be above 0");
  const bool any = range.least == kAny.least && range.most == kAny.most;
  if (!any && !(size >= range.least && size <= range.most)) {
    refuse(name, text, "must be between " + text_of(range.least) + " and " + text_of(range.most));
  }
  return value;
}

// At spaces the shell has split already.
std::vector<std::string> split(const std::vector<std::string>& texts) {
  std::vector<std::string> parts;
  for (const std::string& text : texts) {
    std::istringstream rest(text);
    for (std::string part; std::getline(rest, part, ',');) parts.push_back(part);
  }
  return parts;
}

bool asks_for_help(int argc, char** argv) {
  return std::any_of(argv + 1, argv + argc, [](const std::string& a) { return a == "-h" || a == "--help"; });
}

}  // namespace

struct CommandLine::Parts {
  std::string tool, description, footer, arguments;
  po::options_description options{"Options", kColumns};
  po::options_description hidden;  // the arguments, which are no option
  std::vector<std::string> required;
  po::variables_map found;
};

CommandLine::CommandLine(std::string tool, std::string description) : parts_(std::make_unique<Parts>()) {
  parts_->tool = std::move(tool);
  parts_->description = std::move(description);
  parts_->options.add_options()("help", "this text");
}

CommandLine::~CommandLine() = default;

void CommandLine::add(const std::string& name, const std::string& help, const std::string& default_text,
                      const std::function<void(const std::string&)>& take) {
  const std::string shown = default_text.empty() ? help : help + " [default: " + default_text + "]";
  auto* value = po::value<std::string>()->notifier(take)->value_name("VALUE");
  parts_->options.add_options()(name.c_str(), value, shown.c_str());
}

void CommandLine::add_list(const std::string& name, const std::string& help,
                           const std::function<void(const std::vector<std::string>&)>& take) {
  auto* value = po::value<std::vector<std::string>>()->multitoken()->notifier(take)->value_name("VALUES");
  parts_->options.add_options()(name.c_str(), value, help.c_str());
}

template <class T>
void CommandLine::add_number(const std::string& name, T& value, const std::string& help, Within range) {
  add(name, help, text_of(value),
      [name, &value, range](const std::string& text) { value = number<T>(name, text, range); });
}

void CommandLine::option(const std::string& name, double& value, const std::string& help, Within range) {
  add_number(name, value, help, range);
}
void CommandLine::option(const std::string& name, int& value, const std::string& help, Within range) {
  add_number(name, value, help, range);
}
void CommandLine::option(const std::string& name, unsigned& value, const std::string& help, Within range) {
  add_number(name, value, help, range);
}
void CommandLine::option(const std::string& name, std::int64_t& value, const std::string& help, Within range) {
  add_number(name, value, help, range);
}
void CommandLine::option(const std::string& name, std::uint64_t& value, const std::string& help, Within range) {
  add_number(name, value, help, range);
}

void CommandLine::option(const std::string& name, std::string& value, const std::string& help) {
  add(name, help, value, [&value](const std::string& text) { value = text; });
}

void CommandLine::option(const std::string& name, std::vector<double>& values, const std::string& help) {
  add_list(name, help, [name, &values](const std::vector<std::string>& texts) {
    values.clear();
    for (const std::string& text : split(texts)) values.push_back(number<double>(name, text, kAny));
  });
}

void CommandLine::option(const std::string& name, std::vector<std::string>& values, const std::string& help) {
  add_list(name, help, [&values](const std::vector<std::string>& texts) { values = split(texts); });
}

void CommandLine::flag(const std::string& name, bool& value, const std::string& help) {
  parts_->options.add_options()(name.c_str(), po::bool_switch(&value), help.c_str());
}

void CommandLine::arguments(const std::string& name, std::vector<std::string>& values, const std::string& help) {
  parts_->arguments = name;
  parts_->description += "\n\n  " + name + "...  " + help;
  parts_->hidden.add_options()(name.c_str(), po::value(&values));
}

void CommandLine::require(const std::string& name) { parts_->required.push_back(name); }

bool CommandLine::is_given(const std::string& name) const {
  const auto option = parts_->found.find(name);
  return option != parts_->found.end() && !option->second.defaulted();
}

void CommandLine::footer(const std::string& text) { parts_->footer = text; }

void CommandLine::print_help() const {
  const Parts& p = *parts_;
  std::cout << "Usage: " << p.tool << " [OPTION...]" << (p.arguments.empty() ? "" : " " + p.arguments + "...") << "\n\n"
            << p.description << "\n\n"
            << p.options;
  if (!p.footer.empty()) std::cout << "\n" << p.footer << "\n";
}

// False where the help was all that was asked for.
bool CommandLine::read(int argc, char** argv) {
  if (asks_for_help(argc, argv)) {
    print_help();
    return false;
  }
  po::options_description all;
  all.add(parts_->options).add(parts_->hidden);
  const std::string& arguments = parts_->arguments.empty() ? kUnexpected : parts_->arguments;
  if (parts_->arguments.empty()) all.add_options()(kUnexpected.c_str(), po::value<std::vector<std::string>>());
  po::positional_options_description positional;
  positional.add(arguments.c_str(), -1);
  po::variables_map& found = parts_->found;
  po::store(po::command_line_parser(argc, argv).options(all).positional(positional).style(kStyle).run(), found);
  if (found.count(kUnexpected) > 0) {
    throw std::invalid_argument(found[kUnexpected].as<std::vector<std::string>>()[0] + ": belongs to no option");
  }
  for (const std::string& name : parts_->required) {
    if (found.count(name) == 0) throw std::invalid_argument(name + ": must be given");
  }
  po::notify(found);
  return true;
}

int CommandLine::run(int argc, char** argv, const std::function<int()>& work) {
  const auto fail = [&](const char* what, int code) {
    std::cout.flush();
    std::cerr << parts_->tool << ": " << what << "\n";
    return code;
  };
  try {
    const int code = read(argc, argv) ? work() : 0;
    std::cout.flush();
    return std::cout ? code : fail("cannot write the output", 1);
  } catch (const po::error& fault) {
    return fail((std::string(fault.what()) + " (see --help)").c_str(), 2);
  } catch (const std::invalid_argument& fault) {
    return fail(fault.what(), 2);
  } catch (const std::exception& fault) {
    return fail(fault.what(), 1);
  }
}

}  // namespace afm
