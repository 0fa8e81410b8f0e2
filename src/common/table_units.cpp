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

template <class Of>
auto each(const Of& of) {
  std::array<decltype(of(kUnits[0])), kQuantities> all{};
  for (std::size_t i = 0; i < kQuantities; ++i) all[i] = of(kUnits[i]);
  return all;
}

std::array<double, kQuantities> ones() {
  return each([](const QuantityUnits&) { return 1.0; });
}
std::array<double, kQuantities> si_units(const Units& units) {
  return each([&](const QuantityUnits& q) { return q.si(units); });
}
std::array<std::string, kQuantities> no_suffix() { return {}; }
std::array<std::string, kQuantities> si_suffix() {
  return each([](const QuantityUnits& q) { return std::string(q.si_suffix); });
}
std::array<std::string, kQuantities> natural_suffix() {
  return each([](const QuantityUnits& q) { return std::string(q.natural_suffix); });
}

}  // namespace

double si_factor(Quantity quantity, const Units& units) { return kUnits[static_cast<std::size_t>(quantity)].si(units); }

TableUnits TableUnits::plain() { return {ones(), false, no_suffix()}; }
TableUnits TableUnits::si() { return {ones(), false, si_suffix()}; }
TableUnits TableUnits::into_si(const Units& units) { return {si_units(units), false, si_suffix()}; }
TableUnits TableUnits::into_natural(const Units& units) { return {si_units(units), true, natural_suffix()}; }

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
