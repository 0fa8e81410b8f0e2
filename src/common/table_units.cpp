#include "table_units.h"

namespace afm {
namespace {

const std::array<std::string, kQuantities> kNoSuffix{};
// In the order of Quantity.
const std::array<std::string, kQuantities> kSiSuffix{"",   "_m",        "_s", "_m_per_s", "_j",
                                                     "_n", "_kg_per_s", "_k", "_per_s"};
const std::array<std::string, kQuantities> kNaturalSuffix{
    "", "_a", "_tau", "_a_per_tau", "_m_tip_a2_per_tau2", "_m_tip_a_per_tau2", "_m_tip_per_tau", "_m_tip_a2_per_tau2", "_per_tau"};

std::array<double, kQuantities> si_units(const Units& units) {
  std::array<double, kQuantities> unit{};
  for (std::size_t i = 0; i < kQuantities; ++i) unit[i] = si_factor(static_cast<Quantity>(i), units);
  return unit;
}

std::array<double, kQuantities> ones() {
  std::array<double, kQuantities> unit{};
  unit.fill(1.0);
  return unit;
}

}  // namespace

double si_factor(Quantity quantity, const Units& units) {
  switch (quantity) {
    case Quantity::number: return 1.0;
    case Quantity::length: return units.length();
    case Quantity::time: return units.time();
    case Quantity::velocity: return units.velocity();
    case Quantity::energy: return units.energy();
    case Quantity::force: return units.force();
    case Quantity::friction: return units.friction();
    case Quantity::temperature: return units.temperature();
    case Quantity::rate: return 1.0 / units.time();
  }
  return 1.0;
}

TableUnits TableUnits::plain() { return {ones(), false, kNoSuffix}; }
TableUnits TableUnits::si() { return {ones(), false, kSiSuffix}; }
TableUnits TableUnits::into_si(const Units& units) { return {si_units(units), false, kSiSuffix}; }
TableUnits TableUnits::into_natural(const Units& units) { return {si_units(units), true, kNaturalSuffix}; }

double TableUnits::convert(Quantity quantity, double value) const {
  const double unit = unit_[index(quantity)];
  if (unit == 1.0) return value;
  return divides_ ? value / unit : value * unit;
}

double TableUnits::invert(Quantity quantity, double value) const {
  const double unit = unit_[index(quantity)];
  if (unit == 1.0) return value;
  return divides_ ? value * unit : value / unit;
}

std::string TableUnits::name(const Column& column) const {
  const std::string& suffix = suffix_[index(column.quantity)];
  return (suffix.empty() || column.name_with_unit.empty() ? column.name : column.name_with_unit) + suffix;
}

std::string TableUnits::header(const std::vector<Column>& columns) const {
  std::string text;
  for (const Column& column : columns) text += (text.empty() ? "" : ",") + name(column);
  return text;
}

}  // namespace afm
