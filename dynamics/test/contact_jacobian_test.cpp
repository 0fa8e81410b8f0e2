#include "contact_jacobian.h"

#include <gtest/gtest.h>

#include <vector>

#include "afm/tip.h"
#include "support/models.h"
#include "support/quad_impacts.h"

namespace afm {

using namespace detail;

namespace {

// One contact of a running tip, the flight after it, and the impact that ends that.
struct Episode {
  double eta;
  SlideState<double> begin;
  double slide, flight;  // [tau]
  TipState release;
};

std::vector<Episode> episodes(const Model& model, double eta, std::size_t wanted) {
  std::vector<Episode> found;
  constexpr double kTolerance = 1e-8;  // so that the tip is released at the exact time
  Tip tip(model, eta, start_at(eta), kTolerance);
  for (int i = 0; i < 200000 && found.size() < wanted; ++i) {
    if (tip.advance(kEndOfTime) != Outcome::contact) continue;
    const TipState s = tip.tip_state();
    const ModelTime begun = tip.now();
    if (tip.advance(kEndOfTime) != Outcome::released) continue;
    const ModelTime released = tip.now();
    const TipState release = tip.tip_state();
    tip.advance(kEndOfTime);
    if (tip.last_impact().kind != ImpactKind::impact) continue;
    found.push_back({eta, {s.phase, s.X, s.u}, released - begun, tip.now() - released, release});
  }
  EXPECT_EQ(found.size(), wanted) << "eta " << eta;
  return found;
}

// The slide until the pressure is nothing, in parts a quarter as long as the series allow; then the flight to the next
// impact.
class QuadContact {
 public:
  QuadContact(const Model& model, const Episode& episode)
      : springs_(model),
        impacts_(model, episode.eta),
        eta_(episode.eta),
        slide_(episode.slide),
        flight_(episode.flight) {}

  std::array<Quad, 3> slide(const std::array<Quad, 3>& from, Quad left) const {
    SlideState<Quad> q{from[0], from[1], from[2]};
    while (left != 0) {
      const SlideSegment<Quad> part(springs_, eta_, q);
      const Quad step = std::min<Quad>(left, part.length() / 4);
      q = part.at(step);
      left -= step;
    }
    return {q.phase, q.X, q.u};
  }

  QuadPoint slide_and_fly(const std::array<Quad, 3>& from) {
    Quad time = slide_;
    for (Quad error = 1; abs(error) > 1e-28;) {
      const std::array<Quad, 3> q = slide(from, time);
      const auto p = SlideSegment<Quad>(springs_, eta_, {q[0], q[1], q[2]}).reaction();
      error = p[0] / p[1];
      time -= error;
    }
    const std::array<Quad, 3> q = slide(from, time);
    return impacts_.next({q[0], q[1], q[2], 0}, flight_);
  }

 private:
  SpringConstants<Quad> springs_;
  QuadImpacts impacts_;
  Quad eta_, slide_, flight_;
};

std::array<Quad, 3> quad_slide(const SlideState<double>& s) { return {s.phase, s.X, s.u}; }

constexpr double kEtas[] = {0.5, 3.0, 5.0};

// A slide, its release and a flight, to just after the next impact. Of the three directions one, along the slide, is
// lost.
TEST(ContactJacobian, IsTheDerivativeAcrossAWholeContact) {
  for (const double eta : kEtas) {
    const Model model = model_with_cutoff(0.001);
    for (const Episode& episode : episodes(model, eta, 6)) {
      QuadContact exact(model, episode);
      const auto map = [&](const std::array<Quad, 3>& q) { return exact.slide_and_fly(q); };
      const auto truth = quad_differences<4>(map, quad_slide(episode.begin), Quad(1e-12));
      const Flight<double> flight(SpringConstants<double>(model), eta, episode.release);
      const SectionJacobian<double> flown = section_jacobian(model, flight, episode.flight, flight.gap(episode.flight));
      const Eigen::Matrix<double, 4, 3> J =
          flown.leftCols<3>() * slide_jacobian(model, eta, episode.begin, episode.slide);
      ASSERT_LE(relative_distance(J, truth), 1e-9) << "eta " << eta;
      const Eigen::Vector3d along = slide_velocity(model, eta, episode.begin);
      ASSERT_LE((J * along).norm(), 1e-7 * J.norm() * along.norm());
    }
  }
}

TEST(ProjectionJacobian, IsTheDerivativeOfTheProjection) {
  const Model model;
  const TipState start{0.2, 0.01, 2.7, 0.0, 0.4};
  constexpr double kStep = 1e-6;
  double TipState::*const parts[] = {&TipState::phase, &TipState::X, &TipState::u, &TipState::g1};
  const Eigen::Matrix4d J = projection_jacobian(model, start);
  for (int j = 0; j < 4; ++j) {
    TipState up = start, down = start;
    up.*parts[j] += kStep;
    down.*parts[j] -= kStep;
    const Projection high = project_onto_surface(model, up), low = project_onto_surface(model, down);
    const Eigen::Vector4d column(high.reference.phase - low.reference.phase, high.reference.X - low.reference.X,
                                 high.reference.u - low.reference.u, high.normal_speed - low.normal_speed);
    EXPECT_LE((column / (2.0 * kStep) - J.col(j)).norm(), 1e-8) << j;
  }
}

}  // namespace
}  // namespace afm
