// How nearly each point of the section returns after some impacts: where periodic orbits may be (FIG. 4).
#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <vector>

#include "afm/dynamics/poincare_map.h"
#include "common/point_options.h"
#include "common/progress_bar.h"
#include "common/table_writer.h"

namespace {

const char kDescription[] =
    "Scans the box of the section in which the attractor lies, on a grid over all four coordinates, for points\n"
    "that come back after --length impacts. Rows: surface phase and gap rate after the impact; extension and lab\n"
    "velocity u, w at which the return is nearest there; and how near, in parts of the box.";

using Q = afm::Quantity;

const std::vector<afm::Column> kColumns{{"phase"},          {"gap_rate", Q::velocity}, {"extension", Q::length},
                                        {"u", Q::velocity}, {"w", Q::velocity},        {"distance"}};

struct Options {
  afm::PointOptions dynamics;
  int length = 2, points = 80, depth = 24;
};

using Box = std::array<std::array<double, 2>, 4>;  // of phase, X, u, g1

constexpr double kNoReturn = std::numeric_limits<double>::infinity();

std::array<double, 4> coordinates(const afm::TipState& s) { return {s.phase, s.X, s.u, s.g1}; }

// The box of a long run. Where the attractor lies across the crest it is the whole cell.
Box find_box(const afm::PoincareMap& map) {
  constexpr int kTransient = 1000, kRun = 100000;
  constexpr double kLeastSide = 1e-6;  // a choice: above the rounding of a point
  Box box;
  box.fill({kNoReturn, -kNoReturn});
  afm::TipState now{0.5, 0.0, map.eta(), 0.0, 0.5 * (1.0 + std::abs(map.eta()))};
  for (int i = 0; i < kTransient + kRun; ++i) {
    const afm::MapStep step = map(now);
    if (step.outcome != afm::MapOutcome::impact)
      throw std::runtime_error("the tip has ended in contact: there is no section");
    now = step.after;
    const std::array<double, 4> q = coordinates(now);
    for (std::size_t k = 0; k < 4 && i >= kTransient; ++k) {
      box[k] = {std::min(box[k][0], q[k]), std::max(box[k][1], q[k])};
    }
  }
  if (box[0][1] - box[0][0] < kLeastSide && box[3][1] - box[3][0] < kLeastSide) {
    throw std::runtime_error("the tip has ended on an orbit of one impact: a point has no box to scan");
  }
  return box;
}

double return_distance(const afm::PoincareMap& map, const Box& box, const afm::TipState& start, int length) {
  afm::TipState now = start;
  double cells = 0.0;
  for (int i = 0; i < length; ++i) {
    const afm::MapStep step = map(now);
    if (step.outcome != afm::MapOutcome::impact) return kNoReturn;
    now = step.after;
    cells += step.dt * std::abs(map.eta());
  }
  if (cells < 0.5) return kNoReturn;  // bounces without speed come back at once
  Eigen::Vector4d d = section_difference(now, start);
  for (std::size_t k = 0; k < 4; ++k) {
    const double side = box[k][1] - box[k][0];
    if (side > 0.0) d[static_cast<Eigen::Index>(k)] /= side;  // the hammer's box has no extension and no velocity
  }
  return d.norm();
}

double at(const std::array<double, 2>& side, int i, int points) {
  return side[0] + (side[1] - side[0]) * (i + 0.5) / points;
}

// The nearest return over extension and velocity at one phase and gap rate.
void scan_column(const afm::PoincareMap& map, const Box& box, const Options& o, int i, int j, afm::TableWriter& to) {
  double nearest = kNoReturn;
  afm::TipState best{at(box[0], i, o.points), 0.0, 0.0, 0.0, at(box[3], j, o.points)}, q = best;
  for (int k = 0; k < o.depth; ++k) {
    for (int l = 0; l < o.depth; ++l) {
      q.X = at(box[1], k, o.depth);
      q.u = at(box[2], l, o.depth);
      const double d = return_distance(map, box, q, o.length);
      if (d < nearest) {
        nearest = d;
        best = q;
      }
    }
  }
  if (nearest == kNoReturn) best.X = best.u = std::numeric_limits<double>::quiet_NaN();
  const afm::FreeState lab = to_free_state(map.model().H, best);
  to << lab.phase << best.g1 << lab.X << lab.u << lab.w << nearest;
  to.end_row();
}

int run(const afm::CommandLine& app, Options o) {
  take_si(app, o.dynamics);
  if (o.dynamics.eta == 0.0) throw std::invalid_argument("eta = 0: without drag there is no orbit but rest");
  const afm::PoincareMap map(checked_model(o.dynamics), o.dynamics.eta);
  if (section_dimension(map.model()) == 2) o.depth = 1;
  const Box box = find_box(map);
  afm::ProgressBar bar(static_cast<std::size_t>(o.points), 0);
  afm::TableWriter table(std::cout, kColumns, afm::table_units(o.dynamics.si));
  table.write_header();
  for (int i = 0; i < o.points; ++i) {
    for (int j = 0; j < o.points; ++j) scan_column(map, box, o, i, j, table);
    table.flush();
    bar.show(static_cast<std::size_t>(i) + 1);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  afm::CommandLine app("return_scan", kDescription);
  Options options;
  add_options(app, options.dynamics);
  add_si_options(app, options.dynamics);
  app.option("length", options.length, "impacts until the return", {1, 32});
  app.option("points", options.points, "of the grid over phase and over gap rate", {2, 1000});
  app.option("depth", options.depth, "of the grid over extension and over velocity", {2, 1000});
  return app.run(argc, argv, [&] { return run(app, options); });
}
