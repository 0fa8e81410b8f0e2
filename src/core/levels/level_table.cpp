#include "afm/level_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>

namespace afm {
namespace {

// Relative. Parameters given in SI differ in their last digits from the natural ones, and a grid has at most 6 digits.
constexpr double kSameParameter = 1e-6;
constexpr double kWorthwhileCost = 0.9;      // a choice: a coarser level must save a tenth
constexpr std::size_t kMaxCells = 10000000;  // a cell holds 200 bytes, so 2 GB

const char* const kAxisNames[LevelTable::kAxes] = {"eta",       "gamma",      "cutoff", "frequency_ratio",
                                                   "amplitude", "rest_height"};

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream text(line);
  for (std::string field; std::getline(text, field, ',');) fields.push_back(field);
  return fields;
}

[[noreturn]] void fail(std::size_t line, const std::string& why) {
  throw std::runtime_error("line " + std::to_string(line) + ": " + why);
}

double number(const std::string& text, std::size_t line, const std::string& column) {
  std::size_t used = 0;
  double value = std::numeric_limits<double>::quiet_NaN();
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
  }
  if (used == 0 || used != text.size() || !std::isfinite(value)) {
    fail(line, column + " = '" + text + "' is not a finite number");
  }
  return value;
}

bool is_same(double a, double b) { return std::abs(a - b) <= kSameParameter * std::max(std::abs(a), std::abs(b)); }

// The grid values around `value`; both are the same if it is one of them. False: outside the grid.
bool bracket(const std::vector<double>& axis, double value, std::size_t& low, std::size_t& high) {
  for (std::size_t i = 0; i < axis.size(); ++i) {
    if (is_same(axis[i], value)) {
      low = high = i;
      return true;
    }
  }
  if (axis.empty() || !(value > axis.front() && value < axis.back())) return false;
  high = static_cast<std::size_t>(std::upper_bound(axis.begin(), axis.end(), value) - axis.begin());
  low = high - 1;
  return true;
}

std::size_t place(const std::vector<double>& axis, double value) {
  return static_cast<std::size_t>(std::lower_bound(axis.begin(), axis.end(), value) - axis.begin());
}

bool is_finer(const Level& a, const Level& b) {
  if (a.kind != b.kind) return a.kind == ModelKind::oscillator;
  return a.contact_tolerance < b.contact_tolerance;
}

}  // namespace

bool parse(const std::string& name, ToleranceOf& of) {
  if (name != "friction" && name != "deflection") return false;
  of = name == "friction" ? ToleranceOf::friction : ToleranceOf::deflection;
  return true;
}

const std::vector<std::string>& LevelTable::columns() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all(std::begin(kAxisNames), std::end(kAxisNames));
    for (const char* name : {"model", "contact_tolerance", "k_f_error", "deflection_error", "cost"})
      all.emplace_back(name);
    return all;
  }();
  return names;
}

std::vector<LevelTable::Row> LevelTable::read(std::istream& csv) {
  std::vector<Row> rows;
  std::map<std::string, std::size_t> position;
  std::size_t line = 0;
  for (std::string text; std::getline(csv, text);) {
    ++line;
    if (text.empty() || text[0] == '#') continue;
    const std::vector<std::string> fields = split(text);
    if (position.empty()) {
      for (std::size_t i = 0; i < fields.size(); ++i) position[fields[i]] = i;
      for (const std::string& name : columns()) {
        if (position.count(name) == 0) fail(line, "the head has no column '" + name + "'");
      }
      continue;
    }
    if (fields.size() != position.size()) fail(line, "has not as many fields as the head");
    const auto value = [&](const std::string& name) { return number(fields[position[name]], line, name); };
    Row row;
    for (std::size_t i = 0; i < kAxes; ++i) row.point[i] = value(kAxisNames[i]);
    const std::string& model = fields[position["model"]];
    if (!parse(model, row.level.kind)) fail(line, "model = '" + model + "' is neither oscillator nor hammer");
    row.level.contact_tolerance = value("contact_tolerance");
    if (!has_valid_tolerance(row.level)) fail(line, "contact_tolerance must be 0, or between 1e-9 and 0.01");
    row.error = {value("k_f_error"), value("deflection_error"), value("cost")};
    if (!(row.error.friction >= 0.0 && row.error.deflection >= 0.0 && row.error.cost > 0.0)) {
      fail(line, "errors must not be negative, and the cost above 0");
    }
    rows.push_back(row);
  }
  if (rows.empty()) throw std::runtime_error("holds no row");
  return rows;
}

LevelTable::LevelTable(std::istream& csv) {
  const std::vector<Row> rows = read(csv);
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < kAxes; ++i) axes_[i].push_back(row.point[i]);
    if (std::find(levels_.begin(), levels_.end(), row.level) == levels_.end()) levels_.push_back(row.level);
  }
  if (levels_.size() > kMaxLevels) throw std::runtime_error("holds more than 8 levels");
  std::sort(levels_.begin(), levels_.end(), is_finer);
  std::size_t size = 1;
  for (std::vector<double>& axis : axes_) {
    std::sort(axis.begin(), axis.end());
    axis.erase(std::unique(axis.begin(), axis.end()), axis.end());
    size *= axis.size();
    if (size > kMaxCells) throw std::runtime_error("spans more than 1e7 points");
  }
  cells_.resize(size);
  for (const Row& row : rows) add(row);
}

void LevelTable::add(const Row& row) {
  std::array<std::size_t, kAxes> at{};
  for (std::size_t i = 0; i < kAxes; ++i) at[i] = place(axes_[i], row.point[i]);
  Cell& cell = cells_[index_of(at)];
  if (std::none_of(cell.known.begin(), cell.known.end(), [](bool known) { return known; })) ++points_;
  const auto level = static_cast<std::size_t>(std::find(levels_.begin(), levels_.end(), row.level) - levels_.begin());
  if (cell.known[level]) throw std::runtime_error("holds a level twice at eta = " + std::to_string(row.point[0]));
  cell.known[level] = true;
  cell.errors[level] = row.error;
}

std::size_t LevelTable::index_of(const std::array<std::size_t, kAxes>& at) const {
  std::size_t index = 0;
  for (std::size_t i = 0; i < kAxes; ++i) index = index * axes_[i].size() + at[i];
  return index;
}

bool LevelTable::find(const Model& model, double eta, std::size_t level, LevelError& worst) const {
  const Point point{std::abs(eta), model.gamma, model.v_c, model.frequency_ratio, model.H, model.y0};
  std::array<std::size_t, kAxes> low{}, high{}, at{};
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (!bracket(axes_[i], point[i], low[i], high[i])) return false;
  }
  worst = {0.0, 0.0, 0.0};
  for (std::size_t corner = 0; corner < (std::size_t{1} << kAxes); ++corner) {
    for (std::size_t i = 0; i < kAxes; ++i) at[i] = (corner >> i & 1) != 0 ? high[i] : low[i];
    const Cell& cell = cells_[index_of(at)];
    if (!cell.known[level]) return false;
    const LevelError& error = cell.errors[level];
    worst = {std::max(worst.friction, error.friction), std::max(worst.deflection, error.deflection),
             std::max(worst.cost, error.cost)};
  }
  return true;
}

LevelChoice LevelTable::choose(const Model& model, double eta, double tolerance, ToleranceOf of,
                               const Level& full) const {
  LevelChoice cheapest{full, std::numeric_limits<double>::quiet_NaN()}, best = cheapest;
  double cost = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    LevelError worst{};
    if (!find(model, eta, i, worst)) continue;
    const double error = of == ToleranceOf::friction ? worst.friction : worst.deflection;
    if (!(error >= best.expected_error)) best = {levels_[i], error};
    if (!(error < tolerance && worst.cost < kWorthwhileCost * cost)) continue;
    cheapest = {levels_[i], error};
    // The mean says little of the time of every bounce by itself: in a rare shower it is a thousand times as much.
    cost = levels_[i].contact_tolerance > 0.0 ? worst.cost : std::numeric_limits<double>::infinity();
  }
  return std::isnan(cheapest.expected_error) ? best : cheapest;
}

}  // namespace afm
