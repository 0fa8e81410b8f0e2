#include "command_line.h"

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

template <class T>
std::string text_of(const T& value) {
  if constexpr (std::is_floating_point<T>::value) return number_text(value);
  std::ostringstream text;
  text << value;
  return text.str();
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

// One value from the one text, or a list from texts with commas in them.
template <class T>
void take(const std::string& name, const Texts& texts, T& value, Within range) {
  value = parse<T>(name, texts[0], range);
}
template <class T>
void take(const std::string& name, const Texts& texts, std::vector<T>& values, Within range) {
  values.clear();
  for (const std::string& text : texts) {
    std::istringstream rest(text);
    for (std::string part; std::getline(rest, part, ',');) values.push_back(parse<T>(name, part, range));
  }
}

template <class T>
std::string with_default(const std::string& help, const T& value) {
  const std::string text = text_of(value);
  return text.empty() ? help : help + " [default: " + text + "]";
}
template <class T>
std::string with_default(const std::string& help, const std::vector<T>&) {
  return help;
}

template <class T>
constexpr bool kIsList = false;
template <class T>
constexpr bool kIsList<std::vector<T>> = true;

}  // namespace

template <class T>
void CommandLine::option(const std::string& name, T& value, const std::string& help, Within range) {
  options_.push_back({name, with_default(help, value), kIsList<T> ? Takes::many : Takes::one,
                      [name, &value, range](const Texts& texts) { take(name, texts, value, range); }});
}
template void CommandLine::option(const std::string&, double&, const std::string&, Within);
template void CommandLine::option(const std::string&, int&, const std::string&, Within);
template void CommandLine::option(const std::string&, unsigned&, const std::string&, Within);
template void CommandLine::option(const std::string&, std::int64_t&, const std::string&, Within);
template void CommandLine::option(const std::string&, std::uint64_t&, const std::string&, Within);
template void CommandLine::option(const std::string&, std::string&, const std::string&, Within);
template void CommandLine::option(const std::string&, std::vector<double>&, const std::string&, Within);
template void CommandLine::option(const std::string&, std::vector<std::string>&, const std::string&, Within);

void CommandLine::flag(const std::string& name, bool& value, const std::string& help) {
  options_.push_back({name, help, Takes::nothing, [&value](const Texts&) { value = true; }});
}

void CommandLine::arguments(const std::string& name, std::vector<std::string>& values, const std::string& help) {
  arguments_ = name;
  description_ += "\n\n  " + name + "...  " + help;
  options_.push_back({name, "", Takes::many, [&values](const Texts& texts) { values = texts; }});
}

// False where the help was all that was asked for.
bool CommandLine::read(int argc, char** argv) {
  po::options_description shown("Options", 110), hidden;
  shown.add_options()("help", "this text");
  for (const Option& o : options_) {
    auto* value = po::value<Texts>()->value_name(o.takes == Takes::many ? "VALUES" : "VALUE");
    if (o.takes == Takes::nothing) value->zero_tokens();
    if (o.takes == Takes::many) value->multitoken();
    (o.name == arguments_ ? hidden : shown).add_options()(o.name.c_str(), value, o.help.c_str());
  }
  for (const std::string& argument : Texts(argv + 1, argv + argc)) {
    if (argument != "-h" && argument != "--help") continue;
    std::cout << "Usage: " << tool_ << " [OPTION...]" << (arguments_.empty() ? "" : " " + arguments_ + "...") << "\n\n"
              << description_ << "\n\n"
              << shown << (footer_.empty() ? "" : "\n" + footer_ + "\n");
    return false;
  }
  const std::string rest = arguments_.empty() ? "rest" : arguments_;
  if (arguments_.empty()) hidden.add_options()("rest", po::value<Texts>());
  po::variables_map found;
  // long options only, and none is guessed from its first letters: "-3.4" is a value
  using namespace po::command_line_style;
  const int style = allow_long | long_allow_adjacent | long_allow_next;
  const auto all = po::options_description().add(shown).add(hidden);
  const auto positional = po::positional_options_description().add(rest.c_str(), -1);
  po::store(po::command_line_parser(argc, argv).options(all).positional(positional).style(style).run(), found);
  if (arguments_.empty() && found.count(rest) > 0) {
    throw std::invalid_argument(found[rest].as<Texts>()[0] + ": belongs to no option");
  }
  for (const std::string& name : required_) {
    if (found.count(name) == 0) throw std::invalid_argument(name + ": must be given");
  }
  for (const Option& o : options_) {
    if (found.count(o.name) == 0) continue;
    const Texts& texts = found[o.name].as<Texts>();
    if (o.takes == Takes::one && texts.size() > 1) {
      throw po::error("option '--" + o.name + "' cannot be specified more than once");
    }
    given_.insert(o.name);
    o.take(texts);
  }
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
