#include "contact_jacobian.h"

#include <algorithm>
#include <limits>

#include "core/contact/chatter_law.h"
#include "core/contact/projection.h"
#include "dual.h"

namespace afm::detail {

Eigen::Matrix3d slide_jacobian(const Model& model, double eta, const SlideState<double>& start, double s) {
  const SpringConstants<Dual3> springs(model);
  SlideState<Dual3> q{Dual3::variable(start.phase, 0), Dual3::variable(start.X, 1), Dual3::variable(start.u, 2)};
  constexpr int kMaxSegments = 100000;  // a guard against an endless loop: under a load a tau has some hundreds
  double left = s;
  for (int i = 0; i < kMaxSegments && left > 0.0; ++i) {
    const SlideSegment<Dual3> segment(springs, Dual3(eta), q);
    const double step = std::min(left, segment.length().value);
    q = segment.at(Dual3(step));
    left -= step;
  }
  if (left > 0.0) return Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN());
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

template <std::size_t N>
Dual<N> portable_exp(const Dual<N>& x) {
  const double value = portable_exp(x.value);
  return chain(value, value, x);
}
template <std::size_t N>
Dual<N> portable_log(const Dual<N>& x) {
  return chain(portable_log(x.value), 1.0 / x.value, x);
}

// A chatter sequence in dual numbers, which carry their derivatives by the state after its first bounce: the law of the
// tip (core/contact/chatter_law.h), to the bounce nearest to `duration` after the start. The reference slide begins
// anew where its series ends, as in Tip.
SectionJacobian<double> chatter_jacobian(const Model& model, const ChatterLaw& law, double eta, const TipState& start,
                                         double duration) {
  const Dual4 free(is_free_along_x(model));
  const SpringConstants<Dual4> springs(model);
  const ProjectionOf<Dual4> first = projected(free, springs.H, section_variables(start));
  SlideState<Dual4> state = first.reference;
  ChatterRunOf<Dual4> run{ChatterEnd::time, Dual4(0.0), {first.normal_speed, Dual4(0.0)}};
  for (double left = duration;;) {
    const SlideSegment<Dual4> reference(springs, Dual4(eta), state);
    const ChatterIntegration<Dual4> integration(law.constants(), reference);
    const double until = std::min(left, reference.length().value);
    run = integration.follow(until, {run.chatter.v, run.chatter.n}, false);
    left -= until;
    const bool ends = !(left > 0.0) || run.end != ChatterEnd::time;
    if (ends) run = integration.exit_at(integration.begin(run.s, run.chatter), run.chatter.n.value);
    state = displaced_reference_of(springs.H, reference.at(run.s), run.chatter);
    if (!ends) continue;
    const BounceState<Dual4> end = launched(free, springs.H, state, run.chatter.v);
    return without_held_directions(is_free_along_x(model), derivatives<4>({end.phase, end.X, end.u, end.g1}));
  }
}

}  // namespace afm::detail
