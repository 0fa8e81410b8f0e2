// Tables with units: what their columns are called, and which numbers stand in them.
#include "common/table_writer.h"

#include <gtest/gtest.h>

#include <limits>
#include <sstream>
#include <stdexcept>

namespace afm {
namespace {

const Units kMica{SiModel{}};
const std::vector<Column> kColumns{
    {"eta", Quantity::velocity, "drag_velocity"}, {"attractor"}, {"k_f", Quantity::friction}};

std::string table(const TableUnits& units, double velocity, double friction) {
  std::ostringstream out;
  TableWriter writer(out, kColumns, units);
  writer.write_header();
  writer << velocity << "chaotic" << friction;
  writer.end_row();
  return out.str();
}

TEST(TableUnits, PlainNumbersAndNamesStayAsTheyAre) {
  EXPECT_EQ(table(TableUnits::plain(), 0.1, 3.0), "eta,attractor,k_f\n0.10000000000000001,chaotic,3\n");
}

TEST(TableWriter, ANotANumberHasNoSign) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(table(TableUnits::plain(), -nan, nan), "eta,attractor,k_f\nnan,chaotic,nan\n");
}

TEST(TableUnits, NamesTellTheUnit) {
  EXPECT_EQ(TableUnits::si().header(kColumns), "drag_velocity_m_per_s,attractor,k_f_kg_per_s");
  EXPECT_EQ(TableUnits::into_natural(kMica).header(kColumns), "drag_velocity_a_per_tau,attractor,k_f_m_tip_per_tau");
  std::vector<Column> columns;
  for (std::size_t i = 0; i < kQuantities; ++i) columns.push_back({"q", static_cast<Quantity>(i)});
  EXPECT_EQ(TableUnits::si().header(columns), "q,q_m,q_s,q_m_per_s,q_j,q_n,q_kg_per_s,q_k,q_per_s");
  EXPECT_EQ(TableUnits::into_natural(kMica).header(columns),
            "q,q_a,q_tau,q_a_per_tau,q_m_tip_a2_per_tau2,"
            "q_m_tip_a_per_tau2,q_m_tip_per_tau,q_m_tip_a2_per_tau2,q_per_tau");
}

TEST(TableUnits, EveryQuantityComesBack) {
  for (std::size_t i = 0; i < kQuantities; ++i) {
    const auto quantity = static_cast<Quantity>(i);
    const TableUnits si = TableUnits::into_si(kMica), natural = TableUnits::into_natural(kMica);
    EXPECT_DOUBLE_EQ(si.convert(quantity, 0.3), 0.3 * si_factor(quantity, kMica));
    EXPECT_DOUBLE_EQ(si.invert(quantity, si.convert(quantity, 0.3)), 0.3);
    EXPECT_DOUBLE_EQ(natural.convert(quantity, si.convert(quantity, 0.3)), 0.3);
    EXPECT_DOUBLE_EQ(natural.invert(quantity, natural.convert(quantity, 0.3)), 0.3);
  }
}

TEST(TableUnits, RoomTemperatureIsTheOneOfTheDocuments) {
  EXPECT_NEAR(TableUnits::into_natural(kMica).convert(Quantity::temperature, 300.0), 0.926, 5e-4);
}

TEST(TableWriter, ARowHasACellForEveryColumn) {
  std::ostringstream out;
  TableWriter writer(out, kColumns, TableUnits::plain());
  writer << 1.0 << "chaotic";
  EXPECT_THROW(writer.end_row(), std::logic_error);
  writer << 2.0;
  writer.end_row();
  EXPECT_EQ(out.str(), "1,chaotic,2\n");
  writer << 1.0 << "chaotic" << 2.0;
  EXPECT_THROW(writer << 3.0, std::logic_error);
}

}  // namespace
}  // namespace afm
