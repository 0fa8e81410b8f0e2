// The largest error seen by an audit.
#pragma once

#include <cmath>

namespace afm::audit {

// Raises `worst` to |error|. An error that is no number is the worst.
inline void note(double& worst, double error) {
  if (!(std::abs(error) <= worst)) worst = std::abs(error);
}

}  // namespace afm::audit
