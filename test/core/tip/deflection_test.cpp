// Rows of samples are bit for bit the samples taken one by one: in flight, after small turns and large, on guides, in
// lanes of any number and wherever the grid began.
#include "core/tip/deflection.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "afm/detail/sample_grid.h"

namespace {

using namespace afm;

bool identical(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

struct Row {
  std::vector<double> vertical, lateral;
  double lowest;
};

Row one_by_one(const Tip& tip, const SampleGrid& grid, std::uint64_t first, std::size_t n) {
  Row row{{}, {}, std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < n; ++i) {
    const Deflection d = tip.deflection(grid.time(first + i));
    row.vertical.push_back(d.vertical);
    row.lateral.push_back(d.lateral);
    row.lowest = std::min(row.lowest, d.gap);
  }
  return row;
}

void expect_identical(const Row& a, const Row& b) {
  for (std::size_t i = 0; i < b.vertical.size(); ++i) {
    ASSERT_TRUE(identical(a.vertical[i], b.vertical[i])) << "sample " << i << " of " << b.vertical.size();
    ASSERT_TRUE(identical(a.lateral[i], b.lateral[i])) << "sample " << i << " of " << b.vertical.size();
  }
  ASSERT_EQ(a.vertical.size(), b.vertical.size());
  ASSERT_EQ(a.lowest, b.lowest);
}

Row in_a_row(const Tip& tip, const SampleGrid& grid, std::uint64_t first, std::size_t n) {
  Row row{std::vector<double>(n), std::vector<double>(n), 0.0};
  row.lowest = tip.deflections(grid, first, n, row.vertical.data(), row.lateral.data());
  return row;
}

struct Arcs {
  int flights = 0, guides = 0, samples = 0;
};

// Every arc of a run, at so many times of a grid that begins at the origin or with the arc; and one more than lanes.
Arcs expect_rows(const Model& model, double eta, double duration, ModelTime begin) {
  Arcs arcs;
  Tip tip(model, eta, FreeState{0.25, 0.0, 0.2, eta, 0.0});
  const SampleGrid whole{0.0127, 7, begin};
  std::size_t n = 1;
  for (ModelTime now; now < ModelTime{} + duration; now = tip.now(), n = n % 19 + 1) {
    const ModelTime end = tip.segment_end();
    const double length = end - now;
    const SampleGrid part{0.999 * length / static_cast<double>(n), 0, now};
    expect_identical(in_a_row(tip, part, 0, n), one_by_one(tip, part, 0, n));
    if (length > 0.1) {
      std::uint64_t first = 7;
      while (whole.time(first) < now) first += 1 + static_cast<std::uint64_t>(0.5 * (now - whole.time(first)) / 0.0127);
      const std::size_t most = static_cast<std::size_t>(0.9 * length / 0.0127);
      expect_identical(in_a_row(tip, whole, first, most), one_by_one(tip, whole, first, most));
    }
    tip.in_flight() ? ++arcs.flights : ++arcs.guides;
    arcs.samples += static_cast<int>(n);
    tip.advance_segment({std::int64_t{1} << 60, 0.0});
  }
  return arcs;
}

TEST(Deflection, RowsAreTheSamplesOneByOne) {
  Arcs sum;
  for (const double eta : {0.0, 0.2, 0.5, 1.0, -2.0, 3.0, 3.4, 5.0, 30.0}) {
    for (const ModelKind kind : {ModelKind::oscillator, ModelKind::hammer}) {
      Model model;
      model.kind = kind;
      const Arcs arcs = expect_rows(model, eta, 60.0, {0, eta == 0.5 ? 0.625 : 0.0});
      sum.flights += arcs.flights;
      sum.guides += arcs.guides;
      if (HasFatalFailure()) FAIL() << "eta " << eta;
    }
  }
  EXPECT_GT(sum.flights, 500);
  EXPECT_GT(sum.guides, 500);
}

// Whatever number of lanes, of a flight and of a piece of contact.
TEST(Deflection, AnyNumberOfLanesGivesTheSame) {
  const Mechanics<double> mechanics{Model{}};
  const Flight<double> flight(mechanics, 3.4, TipState{0.6, 0.01, 3.0, 0.0, 1.5});
  const SlideSegment<double> slide(mechanics, 0.7, {0.4, 0.002, 0.9});
  for (const int width : {4, 8}) {
    const lanes::Sampler in_lanes = lanes::sampler_in(width);
    if (in_lanes == nullptr) GTEST_SKIP() << "this machine has no lanes";
    for (std::size_t n = 1; n < 40; ++n) {
      std::vector<double> vertical(n), lateral(n);
      const auto check = [&](lanes::SampleRow row, double period, const auto& at) {
        row.clock = {period, 0.0, 0.0, 0.0};
        row.first = 3.0, row.n = n, row.vertical = vertical.data(), row.lateral = lateral.data();
        const double lowest = in_lanes(row);
        double expected = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < n; ++i) {
          const ModelTime t = multiply(3 + i, period);
          const Deflection d = at(static_cast<double>(t.tau) + t.phase);
          ASSERT_TRUE(identical(vertical[i], d.vertical) && identical(lateral[i], d.lateral)) << i << " of " << n;
          expected = std::min(expected, d.gap);
        }
        ASSERT_EQ(lowest, expected);
      };
      check(row_of(flight), 0.003, [&](double s) { return flight_deflection(flight, s); });
      check(row_of(flight), 0.31, [&](double s) { return flight_deflection(flight, s); });
      const Mechanics<double>& m = slide.mechanics();
      const SlidePath<double> path{slide.start().phase, slide.start().X, slide.eta(), m.H, m.y0, slide.displacement()};
      check(row_of(path), 0.001, [&](double s) { return slide_deflection(path, s); });
    }
  }
}

// Where doubles would not hold the count, the samples are taken one by one; far out in time nothing is lost either.
TEST(Deflection, FarAlongTheGrid) {
  Tip tip(Model{}, 3.4, FreeState{0.25, 0.0, 0.2, 3.4, 0.0});
  while (tip.now().tau < 50) tip.advance({50, 0.0});
  for (const std::int64_t far : {std::int64_t{1} << 30, std::int64_t{1} << 49, std::int64_t{1} << 58}) {
    const double period = far > (std::int64_t{1} << 50) ? 1000.0 : 0.01;
    const SampleGrid grid{period, 1000, {tip.now().tau - far, 0.375}};
    const std::uint64_t first = 1000 + static_cast<std::uint64_t>(static_cast<double>(far) / period);
    expect_identical(in_a_row(tip, grid, first, 13), one_by_one(tip, grid, first, 13));
  }
}

}  // namespace
