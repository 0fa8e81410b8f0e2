// The units of a table: SI, or natural ones (lattice spacing a, period tau, tip mass m_tip), and how columns show them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "afm/units.h"

namespace afm {

enum class Quantity : std::size_t { number, length, time, velocity, energy, force, friction, temperature, rate };
constexpr std::size_t kQuantities = 9;

// One natural unit of the quantity in SI.
double si_factor(Quantity quantity, const Units& units);

struct Column {
  std::string name;
  Quantity quantity = Quantity::number;
  std::string name_with_unit = {};  // where it is another: eta is the drag velocity
};

class TableUnits {
 public:
  // Numbers and names stay as they are.
  static TableUnits plain() { return {Suffix::none, {}}; }
  // Numbers stay; names end in their SI unit, such as _m_per_s.
  static TableUnits si() { return {Suffix::si, {}}; }
  // Natural numbers become SI numbers, names as in si().
  static TableUnits into_si(const Units& units) { return {Suffix::si, units}; }
  // SI numbers become natural numbers; names end in _a_per_tau ...
  static TableUnits into_natural(const Units& units) { return {Suffix::natural, units}; }

  double convert(Quantity quantity, double value) const;
  double invert(Quantity quantity, double value) const;  // from the table's units back
  std::string name(const Column& column) const;
  std::string header(const std::vector<Column>& columns) const;  // with commas between, without a line end

 private:
  enum class Suffix : std::uint8_t { none, si, natural };
  TableUnits(Suffix suffix, const std::optional<Units>& units) : suffix_(suffix), units_(units) {}
  double unit(Quantity quantity) const;

  Suffix suffix_;
  std::optional<Units> units_;  // none: numbers stay as they are
};

}  // namespace afm
