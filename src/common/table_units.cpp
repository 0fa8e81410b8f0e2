#include "table_units.h"

namespace afm {
namespace {

struct QuantityUnits {
  double (*si)(const Units&);  // one natural unit
  const char* si_suffix;
  const char* natural_suffix;
};

// In the order of Quantity.
constexpr QuantityUnits kUnits[kQuantities] = {
    {[](const Units&) { return 1.0; }, "", ""},
    {[](const Units& u) { return u.length(); }, "_m", "_a"},
    {[](const Units& u) { return u.time(); }, "_s", "_tau"},
    {[](const Units& u) { return u.velocity(); }, "_m_per_s", "_a_per_tau"},
    {[](const Units& u) { return u.energy(); }, "_j", "_m_tip_a2_per_tau2"},
    {[](const Units& u) { return u.force(); }, "_n", "_m_tip_a_per_tau2"},
    {[](const Units& u) { return u.friction(); }, "_kg_per_s", "_m_tip_per_tau"},
    {[](const Units& u) { return u.temperature(); }, "_k", "_m_tip_a2_per_tau2"},  // kT in natural units
    {[](const Units& u) { return 1.0 / u.time(); }, "_per_s", "_per_tau"},
};

}  // namespace

double si_factor(Quantity quantity, const Units& units) { return kUnits[static_cast<std::size_t>(quantity)].si(units); }

double TableUnits::unit(Quantity quantity) const { return units_ ? si_factor(quantity, *units_) : 1.0; }

double TableUnits::convert(Quantity quantity, double value) const {
  return suffix_ == Suffix::natural ? value / unit(quantity) : value * unit(quantity);
}

double TableUnits::invert(Quantity quantity, double value) const {
  return suffix_ == Suffix::natural ? value * unit(quantity) : value / unit(quantity);
}

std::string TableUnits::name(const Column& column) const {
  if (suffix_ == Suffix::none) return column.name;
  const QuantityUnits& units = kUnits[static_cast<std::size_t>(column.quantity)];
  const std::string suffix = suffix_ == Suffix::si ? units.si_suffix : units.natural_suffix;
  return (suffix.empty() || column.name_with_unit.empty() ? column.name : column.name_with_unit) + suffix;
}

std::string TableUnits::header(const std::vector<Column>& columns) const {
  std::string text;
  for (const Column& column : columns) text += (text.empty() ? "" : ",") + name(column);
  return text;
}

}  // namespace afm
