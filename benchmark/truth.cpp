#include "truth.h"

#include <algorithm>
#include <cmath>

#include "afm/flight.h"
#include "core/search/impact_search.h"

namespace afm {
namespace {

Quad restitution(const Model& m, const Quad& speed) {
  if (speed >= m.v_c) return Quad(m.gamma);
  return 1 - (1 - Quad(m.gamma)) * speed / m.v_c;
}

double turns_apart(const Quad& a, const Quad& b) {
  const Quad difference = a - b;
  return std::abs(static_cast<double>(difference - round(difference)));
}

double distance(const Quad& a, const Quad& b) { return std::abs(static_cast<double>(a - b)); }

}  // namespace

TrueImpact next_impact_in_quad(const Model& model, double eta, const TipState& start, double horizon) {
  const SpringConstants<Quad> springs(model);
  const Landing<Quad> landing = detail::find_impact(Flight<Quad>(springs, Quad(eta), start), Quad(horizon));
  TrueImpact t{};
  t.impact = landing.outcome == SearchOutcome::impact;
  t.dt = landing.s;
  if (!t.impact) return t;
  const FlightState<Quad>& q = landing.jet.state;
  const SurfaceJet<Quad> surface = surface_jet(springs.H, q.phase);
  const Quad n2 = 1 + surface.h1 * surface.h1, g1 = landing.jet.g1;
  const Quad speed = -g1 / sqrt(n2), e = restitution(model, speed);
  t.phase = q.phase - floor(q.phase);
  t.X = q.X;
  t.u = eta + q.U + (1 + e) * surface.h1 * g1 / n2;
  t.w = surface.h1 * t.u - e * g1;
  t.after = {wrap_phase(static_cast<double>(t.phase)), static_cast<double>(t.X), static_cast<double>(t.u), 0.0,
             static_cast<double>(-e * g1)};
  return t;
}

double error_of(const rivals::Hit& hit, const TrueImpact& truth, const Model& model, double eta) {
  const double slope = surface_jet(model.H, hit.after.phase).h1;
  const Quad w = Quad(hit.after.g1) + Quad(slope) * hit.after.u;
  Quad phase = truth.phase, X = truth.X, u = truth.u, true_w = truth.w;
  if (hit.contact > 0.0) {
    const FlightState<Quad> q =
        Flight<Quad>(SpringConstants<Quad>(model), Quad(eta), truth.after).at(Quad(hit.contact));
    phase = q.phase;
    X = q.X;
    u = eta + q.U;
    true_w = q.W;
  }
  return std::max({distance(hit.dt - hit.contact, truth.dt), turns_apart(hit.after.phase, phase),
                   distance(hit.after.X, X), distance(hit.after.u, u), distance(w, true_w)});
}

}  // namespace afm
