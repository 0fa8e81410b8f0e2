#include "contact_jacobian.h"

#include <algorithm>

#include "dual.h"

namespace afm::detail {

SlideJacobian slide_jacobian(const Model& model, double eta, const SlideState<double>& start, double s) {
  const SpringConstants<Dual3> springs(model);
  SlideState<Dual3> q{Dual3::variable(start.phase, 0), Dual3::variable(start.X, 1), Dual3::variable(start.u, 2)};
  constexpr int kMaxSegments = 100000;  // a guard against an endless loop; a segment is up to 8 tau long
  double left = s;
  for (int i = 0; i < kMaxSegments && left > 0.0; ++i) {
    const SlideSegment<Dual3> segment(springs, Dual3(eta), q);
    const double step = std::min(left, segment.length().value);
    q = segment.at(Dual3(step));
    left -= step;
  }
  return without_held_directions(is_free_along_x(model), derivatives<3>({q.phase, q.X, q.u}));
}

Eigen::Vector3d slide_velocity(const Model& model, double eta, const SlideState<double>& q) {
  const SlideSegment<double> segment(SpringConstants<double>(model), eta, q);
  return {q.u, q.u - eta, 2.0 * segment.displacement()[2]};
}

Eigen::Matrix4d projection_jacobian(const Model& model, const TipState& bounce) {
  const auto p = projected(Dual4(is_free_along_x(model)), Dual4(model.H), section_variables(bounce));
  return derivatives<4>({p.reference.phase, p.reference.X, p.reference.u, p.normal_speed});
}

}  // namespace afm::detail
