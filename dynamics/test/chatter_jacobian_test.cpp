// The Jacobian of a chatter sequence against the product of those of its bounces, which jacobian_test.cpp compares
// with quad precision.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <vector>

#include "afm/landing.h"
#include "afm/reflection.h"
#include "afm/tip.h"
#include "contact_jacobian.h"
#include "support/models.h"
#include "support/quad_impacts.h"
#include "trials/burst_trials.h"

namespace afm {

using namespace detail;

namespace {

// So many bounces, one by one.
struct Bounces {
  SectionJacobian<double> J;
  double duration;  // [tau]
};

Bounces bounce(const Model& model, double eta, TipState now, std::uint32_t count) {
  Bounces bounces{SectionJacobian<double>::Identity(), 0.0};
  for (std::uint32_t i = 0; i < count; ++i) {
    const Flight<double> flight(SpringConstants<double>(model), eta, now);
    const Landing<double> landing = find_landing(model, flight, 8.0);
    EXPECT_EQ(landing.outcome, SearchOutcome::impact);
    bounces.J = section_jacobian(model, flight, landing.s, landing.jet) * bounces.J;
    bounces.duration += landing.s;
    now = reflect(model, eta, landing.jet).after;
  }
  return bounces;
}

struct Burst {
  TipState start;  // after its first bounce
  double duration;
  std::uint32_t count;
};

// The next burst that ends with a bounce; not at the threshold of contact, where it ends as it begins.
Burst next_burst(BurstTrials& trials) {
  constexpr std::uint32_t kMostBounces = 400;
  for (;;) {
    const TipState start = trials.next_burst().value();
    Tip tip = trials.tip();
    const ModelTime begin = tip.now();
    const bool bounces = tip.advance(begin + 1000.0) == Outcome::impact && tip.tip_state().g1 > 0.0;
    const std::uint32_t count = tip.last_impact().count;
    if (bounces && begin < tip.now() && count <= kMostBounces) return {start, tip.now() - begin, count};
  }
}

// Relative errors of the Jacobians of the first bursts, the smallest first.
std::vector<double> errors(const Model& model, double eta) {
  constexpr std::size_t kBursts = 6;
  const ChatterLaw law(model, kDefaultContactTolerance);
  BurstTrials trials(model, eta, kDefaultContactTolerance, 1, 0);
  std::vector<double> found;
  while (found.size() < kBursts) {
    const Burst burst = next_burst(trials);
    const auto J = chatter_jacobian(model, law, eta, burst.start, burst.duration);
    found.push_back(relative_distance(J, bounce(model, eta, burst.start, burst.count).J));
  }
  std::sort(found.begin(), found.end());
  return found;
}

// The error of the law for each bounce adds up. Of twelve sequences at each of these points, of up to 400 bounces, half
// were good to 1.4e-4, and all to 8e-3. The hammer makes longer bounces at eta = 0.5: half were good to 8.4e-4. A law
// without the cutoff above it is off by all of itself.
void expect_derivatives(ModelKind kind) {
  for (const double v_c : {0.3, 0.03, 0.01, 0.003}) {
    for (const double eta : {0.5, 3.0, 5.0, 7.0}) {
      const std::vector<double> error = errors(model_with(0.7, v_c, kind), eta);
      const double most = kind == ModelKind::hammer && eta == 0.5 ? 1e-3 : 4e-4;
      EXPECT_LE(error[error.size() / 2], most) << "eta " << eta << ", cutoff " << v_c;
      for (const double e : error) EXPECT_LE(e, 1e-2) << "eta " << eta << ", cutoff " << v_c;
    }
  }
}

TEST(BurstJacobian, IsThatOfTheBouncesThatTheTipMakes) { expect_derivatives(ModelKind::oscillator); }
TEST(BurstJacobian, OfTheHammerToo) { expect_derivatives(ModelKind::hammer); }

// A part of a burst has the Jacobian of that part, whichever bounce it ends with.
TEST(BurstJacobian, IsThatOfAnyNumberOfItsBounces) {
  const Model model = model_with_cutoff(0.3);
  const double eta = 3.0;
  const ChatterLaw law(model, kDefaultContactTolerance);
  for (const double g1 : {0.002, 0.005, 0.01}) {
    for (const std::uint32_t count : {5, 50}) {
      const TipState start{0.4, 0.001, 3.1, 0.0, g1};
      const Bounces truth = bounce(model, eta, start, count);
      const SectionJacobian<double> J = chatter_jacobian(model, law, eta, start, truth.duration);
      EXPECT_LE(relative_distance(J, truth.J), 3e-4) << "gap rate " << g1 << ", bounces " << count;
      // a product of four such numbers
      EXPECT_NEAR(J.determinant(), truth.J.determinant(), 4.0 * 4e-4 * truth.J.determinant());
    }
  }
}

}  // namespace
}  // namespace afm
