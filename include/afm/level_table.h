// Which level of the model is the cheapest that a tolerance allows, from a table of measured errors over a grid of
// parameters. The table is made by the program level_table.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <istream>
#include <string>
#include <vector>

#include "level.h"

namespace afm {

// What a tolerance is about: K_f, or the distribution of the vertical deflection (mean distance of equal quantiles over
// its rms). Both relative.
enum class ToleranceOf : std::uint8_t { friction, deflection };
bool parse(const std::string& name, ToleranceOf& of);  // "friction" or "deflection"; false where the name is neither

// Against the finest level that was measured there. The cost is the time for a tau over that of the full model: the
// oscillator at the default contact tolerance.
struct LevelError {
  double friction, deflection, cost;
};

struct LevelChoice {
  Level level;
  double expected_error;  // of what the tolerance is about; NaN: not known
};

class LevelTable {
 public:
  static constexpr std::size_t kAxes = 6;  // |eta|, gamma, v_c, omega_h / omega_v, H, y0
  static constexpr std::size_t kMostLevels = 8;

  // Throws std::runtime_error that says which line is wrong, and why.
  explicit LevelTable(std::istream& csv);

  // The columns that it reads, in any order.
  static const std::vector<std::string>& columns();

  const std::vector<Level>& levels() const { return levels_; }  // finest first
  std::size_t points() const { return points_; }

  // The worst at the grid points around these parameters, or at the one that they are. False where one of them, or this
  // level there, is not in the table: nothing is known. Allocates nothing.
  bool find(const Model& model, double eta, std::size_t level, LevelError& worst) const;

  // The cheapest level whose error is below the tolerance; a coarser one must save a tenth. Where none is, the one with
  // the least error; where nothing is known, `full`. Allocates nothing.
  LevelChoice choose(const Model& model, double eta, double tolerance, ToleranceOf of, const Level& full) const;

 private:
  using Point = std::array<double, kAxes>;
  struct Cell {
    std::array<LevelError, kMostLevels> errors;
    std::array<bool, kMostLevels> known{};
  };
  struct Row {
    Point point;
    Level level;
    LevelError error;
  };

  static std::vector<Row> read(std::istream& csv);
  void add(const Row& row);
  std::size_t index_of(const std::array<std::size_t, kAxes>& at) const;

  std::array<std::vector<double>, kAxes> axes_;
  std::vector<Level> levels_;
  std::vector<Cell> cells_;
  std::size_t points_ = 0;
};

}  // namespace afm
