// Chooses the cheapest level of the model that a tolerance allows, from errors that the program level_table has
// measured at one set of parameters over the drag velocity.
#pragma once

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
  // The head of a table for this model: a comment with the parameters, and the columns.
  static std::string head(const Model& model);

  // Throws std::runtime_error, which names the wrong line and the reason.
  explicit LevelTable(std::istream& csv);

  // The cheapest level whose error is below the tolerance at the drag velocities around eta; a coarser level must save
  // a tenth. Every bounce by itself is taken only where no other error is below it. If none is, the level with the
  // smallest error. If the table knows nothing of these parameters or of this eta: `full`. No allocation.
  LevelChoice choose(const Model& model, double eta, double tolerance, ToleranceOf of, const Level& full) const;

 private:
  struct Row {
    double eta;
    Level level;
    LevelError error;
  };
  Row read_row(const std::string& text, std::size_t line) const;

  Model model_;            // that was measured
  std::vector<Row> rows_;  // by eta, the finest level first
};

}  // namespace afm
