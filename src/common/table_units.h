// The units of a table: SI, or natural ones (lattice spacing a, period tau, tip mass m_tip), and how columns show them.
#pragma once

#include <array>
#include <cstddef>
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
  static TableUnits plain();                           // numbers and names stay as they are
  static TableUnits si();                              // numbers stay; names end in their SI unit, such as _m_per_s
  static TableUnits into_si(const Units& units);       // natural numbers become SI numbers, names as in si()
  static TableUnits into_natural(const Units& units);  // SI numbers become natural numbers; names end in _a_per_tau ...

  double convert(Quantity quantity, double value) const;
  double invert(Quantity quantity, double value) const;  // from the table's units back
  std::string name(const Column& column) const;
  std::string header(const std::vector<Column>& columns) const;  // with commas between, without a line end

 private:
  using Factors = std::array<double, kQuantities>;
  using Suffixes = std::array<std::string, kQuantities>;
  TableUnits(const Factors& unit, bool divides, const Suffixes& suffix)
      : unit_(unit), divides_(divides), suffix_(suffix) {}
  static std::size_t index(Quantity quantity) { return static_cast<std::size_t>(quantity); }

  Factors unit_;  // 1: not converted
  bool divides_;
  Suffixes suffix_;
};

}  // namespace afm
