#include "command_line.h"

#include <algorithm>
#include <boost/lexical_cast.hpp>
#include <boost/program_options.hpp>
#include <cstdint>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <type_traits>

#include "afm/number_text.h"

namespace afm {
namespace po = boost::program_options;
namespace {

using Texts = std::vector<std::string>;

std::string text_of(const std::string& value) { return value; }
template <class T>
std::string text_of(T value) {
  return number_text(static_cast<double>(value));
}

template <class T>
T parse(const std::string& name, const std::string& text, Within range) {
  const auto refuse = [&](const std::string& why) {
    throw std::invalid_argument("--" + name + " = " + text + ": " + why);
  };
  const std::string kind = std::is_integral<T>::value ? "must be a whole number" : "must be a number";
  T value;
  // an unsigned number would take a minus, and be huge
  const bool minus = std::is_unsigned<T>::value && !text.empty() && text[0] == '-';
  if (minus || !boost::conversion::try_lexical_convert(text, value)) {
    refuse(std::is_unsigned<T>::value ? kind + ", not below 0" : kind);
  }
  const double size = static_cast<double>(value);
  if (range.least == kPositive.least && !(size > 0.0)) refuse("must be above 0");
  if ((range.least > kAny.least || range.most < kAny.most) && !(size >= range.least && size <= range.most)) {
    refuse("must be between " + text_of(range.least) + " and " + text_of(range.most));
  }
  return value;
}
template <>
std::string parse(const std::string&, const std::string& text, Within) {
  return text;
}

}  // namespace

CommandLine::CommandLine(const std::string& tool, const std::string& description)
    : tool_(tool),
      usage_("Usage: " + tool + " [OPTION...]"),
      description_(description),
      options_(std::make_shared<po::options_description>("Options", 110)) {
  options_->add_options()("help", "this text");
}

template <class T>
void CommandLine::option(const std::string& name, T& value, const std::string& help, Within range) {
  const auto take = [this, name, &value, range](const std::string& text) {
    given_.insert(name);
    value = parse<T>(name, text, range);
  };
  const std::string preset = text_of(value);
  options_->add_options()(name.c_str(), po::value<std::string>()->value_name("VALUE")->notifier(take),
                          (preset.empty() ? help : help + " [default: " + preset + "]").c_str());
}

template <class T>
void CommandLine::option(const std::string& name, std::vector<T>& values, const std::string& help, Within range) {
  const auto take = [this, name, &values, range](const Texts& texts) {
    given_.insert(name);
    values.clear();
    for (const std::string& text : texts) {
      std::istringstream rest(text);
      for (std::string part; std::getline(rest, part, ',');) values.push_back(parse<T>(name, part, range));
    }
  };
  options_->add_options()(name.c_str(), po::value<Texts>()->multitoken()->value_name("VALUES")->notifier(take),
                          help.c_str());
}

template void CommandLine::option(const std::string&, double&, const std::string&, Within);
template void CommandLine::option(const std::string&, int&, const std::string&, Within);
template void CommandLine::option(const std::string&, unsigned&, const std::string&, Within);
template void CommandLine::option(const std::string&, std::int64_t&, const std::string&, Within);
template void CommandLine::option(const std::string&, std::uint64_t&, const std::string&, Within);
template void CommandLine::option(const std::string&, std::string&, const std::string&, Within);
template void CommandLine::option(const std::string&, std::vector<double>&, const std::string&, Within);
template void CommandLine::option(const std::string&, Texts&, const std::string&, Within);

void CommandLine::flag(const std::string& name, bool& value, const std::string& help) {
  options_->add_options()(name.c_str(), po::bool_switch(&value), help.c_str());
}

void CommandLine::arguments(const std::string& name, Texts& values, const std::string& help) {
  arguments_ = &values;
  usage_ += " " + name + "...";
  description_ += "\n\n  " + name + "...  " + help;
}

// False where the help was all that was asked for.
bool CommandLine::read(int argc, char** argv) {
  if (std::any_of(argv + 1, argv + argc, [](const std::string& a) { return a == "-h" || a == "--help"; })) {
    std::cout << usage_ << "\n\n" << description_ << "\n\n" << *options_;
    return false;
  }
  // long options only, and none is guessed from its first letters: "-3.4" is a value
  using namespace po::command_line_style;
  const int style = allow_long | long_allow_adjacent | long_allow_next;
  const auto parsed = po::command_line_parser(argc, argv).options(*options_).style(style).run();
  const Texts rest = po::collect_unrecognized(parsed.options, po::include_positional);
  if (arguments_ != nullptr) {
    *arguments_ = rest;
  } else if (!rest.empty()) {
    throw std::invalid_argument(rest[0] + ": belongs to no option");
  }
  po::variables_map found;
  po::store(parsed, found);
  po::notify(found);
  return true;
}

void CommandLine::warn(const std::string& what) const { std::cerr << tool_ << ": warning: " << what << "\n"; }

int CommandLine::run(int argc, char** argv, const std::function<int()>& work, int failure) {
  const auto fail = [&](const std::string& what, int code) {
    std::cout.flush();
    std::cerr << tool_ << ": " << what << "\n";
    return code;
  };
  try {
    const int code = read(argc, argv) ? work() : 0;
    return std::cout.flush() ? code : fail("cannot write the output", failure);
  } catch (const po::error& fault) {
    return fail(std::string(fault.what()) + " (see --help)", 2);
  } catch (const std::invalid_argument& fault) {
    return fail(fault.what(), 2);
  } catch (const std::exception& fault) {
    return fail(fault.what(), failure);
  }
}

}  // namespace afm
