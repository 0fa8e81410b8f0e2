// Chooses the cheapest level of the model that a tolerance allows. It uses a table of measured errors over a grid of
// parameters, which the program level_table makes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <istream>
#include <string>
#include <vector>

#include "level.h"

namespace afm {

// The quantity that a tolerance limits: K_f, or the distribution of the vertical deflection. Both are relative errors;
// of the distribution it is the mean distance of equal quantiles over its rms.
enum class ToleranceOf : std::uint8_t { friction, deflection };
bool parse(const std::string& name, ToleranceOf& of);  // "friction" or "deflection"; false where the name is neither

// Errors against the finest level that was measured there. The cost is the time for a tau over that of the oscillator
// at the default contact tolerance.
struct LevelError {
  double friction, deflection, cost;
};

struct LevelChoice {
  Level level;
  double expected_error;  // of the quantity that the tolerance limits; NaN: unknown
};

class LevelTable {
 public:
  static constexpr std::size_t kAxes = 6;       // |eta|, gamma, v_c, omega_h / omega_v, H, y0
  static constexpr std::size_t kMaxLevels = 8;  // room; config/levels.csv has 6

  // Throws std::runtime_error, which names the wrong line and the reason.
  explicit LevelTable(std::istream& csv);

  // The columns that a table must have, in any order.
  static const std::vector<std::string>& columns();

  const std::vector<Level>& levels() const { return levels_; }  // finest first
  std::size_t points() const { return points_; }

  // The worst errors at the grid points around these parameters. False if a level has no data at one of these points;
  // then it is not used. No allocation.
  bool find(const Model& model, double eta, std::size_t level, LevelError& worst) const;

  // The cheapest level whose error is below the tolerance; a coarser level must save a tenth. Every bounce by itself is
  // taken only where no other error is below it. If none is, the level with the smallest error. If no level has data,
  // `full`. No allocation.
  LevelChoice choose(const Model& model, double eta, double tolerance, ToleranceOf of, const Level& full) const;

 private:
  using Point = std::array<double, kAxes>;
  struct Cell {
    std::array<LevelError, kMaxLevels> errors;
    std::array<bool, kMaxLevels> known{};
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
