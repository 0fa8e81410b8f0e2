#include "command_line.h"

#include <algorithm>
#include <boost/algorithm/string/join.hpp>
#include <boost/lexical_cast.hpp>
#include <boost/program_options.hpp>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <type_traits>

#include "afm/number_text.h"
#include "csv.h"
#include "decimal_range.h"

namespace afm {
namespace po = boost::program_options;
namespace {

using Texts = std::vector<std::string>;

// Also a whole number that is written like 1e8, up to 2^53: above it a double is not every whole number.
template <class T>
bool convert(const std::string& text, T& value) {
  if (boost::conversion::try_lexical_convert(text, value)) return true;
  double number = 0.0;
  if (!std::is_integral<T>::value || !boost::conversion::try_lexical_convert(text, number)) return false;
  const double most = std::min(0x1p53, static_cast<double>(std::numeric_limits<T>::max()));
  const double least = std::is_unsigned<T>::value ? 0.0 : -most;
  if (!(number >= least && number <= most) || number != std::floor(number)) return false;
  value = static_cast<T>(number);
  return true;
}

template <class T>
T parse(const std::string& name, const std::string& text, Within range) {
  const auto require = [&](bool is_so, const std::string& what) {
    if (!is_so) throw std::invalid_argument("--" + name + " = " + text + ": must be " + what);
  };
  const std::string kind = std::is_integral<T>::value ? "a whole number" : "a number";
  T value{};
  // lexical_cast takes a minus for an unsigned number, which is huge then
  double number = 0.0;
  if (std::is_unsigned<T>::value && boost::conversion::try_lexical_convert(text, number))
    require(text[0] != '-', kind + ", not below 0");
  require(convert(text, value), kind);
  const double size = static_cast<double>(value);
  if (range.least == kPositive.least) require(size > 0.0, "above 0");
  if (range.least > kAny.least || range.most < kAny.most) {
    require(size >= range.least && size <= range.most,
            "between " + number_text(range.least) + " and " + number_text(range.most));
  }
  return value;
}

std::vector<double> parse_ranges(const std::string& name, const std::string& text) {
  std::vector<double> values;
  try {
    for (const std::string& part : split_fields(text)) {
      for (const double value : parse_range(part)) values.push_back(value);
    }
  } catch (const std::invalid_argument& fault) {
    throw std::invalid_argument(name + " = " + text + ": " + fault.what());
  }
  return values;
}

std::string with_default(const std::string& help, const std::string& value) {
  return value.empty() ? help : help + " [default: " + value + "]";
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
  const auto take = [=, &value](const std::string& text) { value = parse<T>(name, text, range); };
  options_->add_options()(name.c_str(), po::value<std::string>()->value_name("VALUE")->notifier(take),
                          with_default(help, number_text(static_cast<double>(value))).c_str());
}
template void CommandLine::option(const std::string&, double&, const std::string&, Within);
template void CommandLine::option(const std::string&, int&, const std::string&, Within);
template void CommandLine::option(const std::string&, unsigned&, const std::string&, Within);
template void CommandLine::option(const std::string&, std::int64_t&, const std::string&, Within);
template void CommandLine::option(const std::string&, std::uint64_t&, const std::string&, Within);

void CommandLine::option(const std::string& name, std::string& value, const std::string& help) {
  options_->add_options()(name.c_str(), po::value(&value)->value_name("VALUE"), with_default(help, value).c_str());
}

void CommandLine::option(const std::string& name, Texts& values, const std::string& help) {
  const auto take = [&values](const Texts& texts) { values = split_fields(boost::algorithm::join(texts, ",")); };
  options_->add_options()(name.c_str(), po::value<Texts>()->multitoken()->value_name("VALUES")->notifier(take),
                          help.c_str());
}

void CommandLine::ranges(const std::string& name, std::vector<double>& values, const std::string& standard,
                         const std::string& help) {
  if (!standard.empty()) values = parse_ranges(name, standard);
  const auto take = [&values, name](const Texts& texts) {
    values = parse_ranges(name, boost::algorithm::join(texts, ","));
  };
  options_->add_options()(name.c_str(), po::value<Texts>()->multitoken()->value_name("VALUES")->notifier(take),
                          with_default(help, standard).c_str());
}

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
  for (const po::option& option : parsed.options) {
    if (given_.insert(option.string_key).second || option.position_key >= 0) continue;
    throw std::invalid_argument("option '--" + option.string_key + "' cannot be specified more than once (see --help)");
  }
  const Texts rest = po::collect_unrecognized(parsed.options, po::include_positional);
  if (arguments_ == nullptr && !rest.empty()) throw std::invalid_argument(rest[0] + ": belongs to no option");
  if (arguments_ != nullptr) *arguments_ = rest;
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
