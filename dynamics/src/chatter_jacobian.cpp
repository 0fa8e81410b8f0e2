// A chatter sequence in dual numbers, which carry their derivatives by the state after its first bounce: the law of the
// tip (core/contact/chatter_law.h).
#include <algorithm>
#include <cmath>

#include "contact_jacobian.h"
#include "core/contact/chatter_law.h"
#include "core/contact/projection.h"
#include "dual.h"

namespace afm::detail {

template <std::size_t N>
Dual<N> portable_exp(const Dual<N>& x) {
  const double value = portable_exp(x.value);
  return chain(value, value, x);
}
template <std::size_t N>
Dual<N> portable_log(const Dual<N>& x) {
  return chain(portable_log(x.value), 1.0 / x.value, x);
}

// To the bounce nearest to `duration` after the start. The reference slide begins anew where its series ends, as in
// Tip.
SectionJacobian<double> chatter_jacobian(const Model& model, const ChatterLaw& law, double eta, const TipState& start,
                                         double duration) {
  const Dual4 free(is_free_along_x(model));
  const SpringConstants<Dual4> springs(model);
  const ProjectedOf<Dual4> first = projected(free, springs.H, section_variables(start));
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
