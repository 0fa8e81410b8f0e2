// The levels of `model: auto`: the file they are taken from, and which one is taken.
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "parameters.h"

namespace afm::node {
namespace {

std::string read_file(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  if (file) text << file.rdbuf();
  if (!file) throw std::runtime_error(std::string("cannot be read: ") + std::strerror(errno));
  return text.str();
}

}  // namespace

void load_levels(Parameters& p, Faults& faults) {
  const auto fault = [&](const std::string& reason) {
    faults.push_back({"level_table", '"' + p.level_table + '"', reason});
  };
  if (p.level_table.empty()) {
    return fault(
        "model auto takes its levels from this file: give config/levels.csv, as emulator.launch does, or one that the "
        "program level_table made");
  }
  try {
    const std::string text = read_file(p.level_table);
    std::istringstream csv(text);
    p.levels = std::make_shared<const LevelTable>(csv);
  } catch (const std::exception& error) {
    fault(error.what());
  }
}

Level full_level(const Parameters& p) {
  Level level{ModelKind::oscillator, p.contact_tolerance};
  parse(p.model, level.kind);  // auto, or a fault that is reported elsewhere
  return level;
}

LevelChoice choose_level(const Parameters& p, const Model& model, double eta) {
  const Level full = full_level(p);
  const bool heated = p.bath.quality_factor > 0.0 || p.bath.lateral_quality_factor > 0.0;
  if (!p.levels || heated) return {full, std::numeric_limits<double>::quiet_NaN()};
  ToleranceOf of = ToleranceOf::friction;
  parse(p.tolerance_of, of);
  return p.levels->choose(model, eta, p.tolerance, of, full);
}

}  // namespace afm::node
