#include "afm/level_table.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "afm/number_text.h"
#include "core/not_numbers.h"

namespace afm {
namespace {

constexpr double kSameParameter = 1e-6;  // relative: parameters given in SI differ in their last digits
constexpr double kWorthwhileCost = 0.9;  // a choice: a coarser level must save a tenth
const char kHead[] = "# parameters:", kColumns[] = "eta,model,contact_tolerance,k_f_error,deflection_error,cost";

bool is_same(double a, double b) { return std::abs(a - b) <= kSameParameter * std::max(std::abs(a), std::abs(b)); }

// The parameters that a table is measured at.
constexpr struct {
  const char* name;
  double Model::*value;
} kParameters[] = {{"gamma", &Model::gamma},
                   {"cutoff", &Model::v_c},
                   {"frequency_ratio", &Model::frequency_ratio},
                   {"amplitude", &Model::H},
                   {"rest_height", &Model::y0}};

bool is_same(const Model& a, const Model& b) {
  return std::all_of(std::begin(kParameters), std::end(kParameters),
                     [&](const auto& p) { return is_same(a.*p.value, b.*p.value); });
}

// False: the text has not these parameters in this order.
bool read(const std::string& text, Model& model) {
  std::istringstream in(text);
  std::string name;
  for (const auto& p : kParameters) {
    if (!(in >> name >> model.*p.value) || name != p.name) return false;
  }
  return true;
}

[[noreturn]] void fail(std::size_t line, const std::string& why) {
  throw std::runtime_error("line " + std::to_string(line) + ": " + why);
}

auto order(double eta, const Level& level) {
  return std::make_tuple(eta, level.kind != ModelKind::oscillator, level.contact_tolerance);
}

}  // namespace

bool parse(const std::string& name, ToleranceOf& of) {
  if (name != "friction" && name != "deflection") return false;
  of = name == "friction" ? ToleranceOf::friction : ToleranceOf::deflection;
  return true;
}

std::string LevelTable::head(const Model& m) {
  std::string text = kHead;
  for (const auto& p : kParameters) text += std::string(" ") + p.name + " " + number_text(m.*p.value);
  return text + "\n" + kColumns + "\n";
}

LevelTable::Row LevelTable::read_row(const std::string& text, std::size_t line) const {
  std::istringstream in(text);
  Row row{};
  char comma[4] = {};
  std::string kind;
  in >> row.eta >> comma[0];
  std::getline(in, kind, ',');
  in >> row.level.contact_tolerance >> comma[1] >> row.error.friction >> comma[2] >> row.error.deflection >> comma[3] >>
      row.error.cost;
  if (!in || !in.eof() || std::string(comma, 4) != ",,,,") fail(line, "'" + text + "' is not " + kColumns);
  if (!parse(kind, row.level.kind)) fail(line, "model = '" + kind + "' is neither oscillator nor hammer");
  if (!is_contact_tolerance(row.level.contact_tolerance))
    fail(line, "contact_tolerance must be 0, or between 1e-9 and 0.01");
  if (!(row.error.friction >= 0.0 && row.error.deflection >= 0.0 && row.error.cost > 0.0)) {
    fail(line, "errors must not be negative, and the cost above 0");
  }
  return row;
}

LevelTable::LevelTable(std::istream& csv) {
  std::size_t line = 0;
  bool has_parameters = false, has_columns = false;
  for (std::string text; std::getline(csv, text);) {
    ++line;
    if (text.rfind(kHead, 0) == 0) {
      has_parameters = read(text.substr(sizeof kHead - 1), model_);
    } else if (text == kColumns) {
      has_columns = true;
    } else if (!text.empty() && text[0] != '#') {
      if (!has_columns) fail(line, std::string("the head is not ") + kColumns);
      rows_.push_back(read_row(text, line));
    }
  }
  if (!has_parameters)
    throw std::runtime_error("does not say for which parameters it was measured ('# parameters: ...')");
  if (rows_.empty()) throw std::runtime_error("holds no row");
  const auto before = [](const Row& a, const Row& b) { return order(a.eta, a.level) < order(b.eta, b.level); };
  std::sort(rows_.begin(), rows_.end(), before);
  const auto twice =
      std::adjacent_find(rows_.begin(), rows_.end(), [&](const Row& a, const Row& b) { return !before(a, b); });
  if (twice != rows_.end()) throw std::runtime_error("holds a level twice at eta = " + number_text(twice->eta));
}

LevelChoice LevelTable::choose(const Model& model, double eta, double tolerance, ToleranceOf of,
                               const Level& full) const {
  const double speed = std::abs(eta);
  double low = kNaN, high = kNaN;  // the drag velocities around eta, or eta itself
  for (const Row& row : rows_) {
    if (row.eta <= speed || is_same(row.eta, speed)) low = row.eta;
    if (!(high >= speed || is_same(high, speed))) high = row.eta;
  }
  if (is_same(low, speed)) high = low;
  LevelChoice cheapest{full, kNaN}, best = cheapest;
  if (!is_same(model, model_) || !(high >= low)) return cheapest;
  if (high < speed && !is_same(high, speed)) return cheapest;
  double cost = std::numeric_limits<double>::infinity();
  for (const Row& row : rows_) {
    if (row.eta != low) continue;
    const auto there =
        std::find_if(rows_.begin(), rows_.end(), [&](const Row& r) { return r.eta == high && r.level == row.level; });
    if (there == rows_.end()) continue;
    const double error = of == ToleranceOf::friction ? std::max(row.error.friction, there->error.friction)
                                                     : std::max(row.error.deflection, there->error.deflection);
    const double dearest = std::max(row.error.cost, there->error.cost);
    if (!(error >= best.expected_error)) best = {row.level, error};
    if (!(error < tolerance && dearest < kWorthwhileCost * cost)) continue;
    cheapest = {row.level, error};
    // the mean says little of the time of every bounce by itself: in a rare sequence it is a thousand times as much
    cost = row.level.contact_tolerance > 0.0 ? dearest : std::numeric_limits<double>::infinity();
  }
  return std::isnan(cheapest.expected_error) ? best : cheapest;
}

}  // namespace afm
