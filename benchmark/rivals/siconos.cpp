// Siconos' event-driven simulation, begun again after each impact: LSODAR integrates and finds where the gap closes.
#include <BlockVector.hpp>
#include <EventDriven.hpp>
#include <EventsManager.hpp>
#include <Interaction.hpp>
#include <LCP.hpp>
#include <LagrangianDS.hpp>
#include <LagrangianRheonomousR.hpp>
#include <LsodarOSI.hpp>
#include <NewtonImpactNSL.hpp>
#include <NonSmoothDynamicalSystem.hpp>
#include <SiconosException.hpp>
#include <TimeDiscretisation.hpp>
#include <iostream>

#include "impact_law.h"

extern "C" void xsetf_(const int* messages);  // of ODEPACK

namespace afm::rivals {
namespace {

// The springs in the comoving frame. Without a mass matrix Siconos need not solve with one.
class Springs : public LagrangianDS {
 public:
  Springs(const Oscillator& o, double height)
      : LagrangianDS(std::make_shared<SiconosVector>(2, height), std::make_shared<SiconosVector>(2, 0.0)), o_(o) {
    _forces = std::make_shared<SiconosVector>(2);
  }
  void computeForces(double, SP::SiconosVector q, SP::SiconosVector) override {
    (*_forces)(0) = -o_.wh2 * (*q)(0);
    (*_forces)(1) = -o_.wv2 * (*q)(1);
  }

 private:
  const Oscillator& o_;
};

// The gap, its gradient and what its rate has besides: the surface passes under the comoving frame.
class Surface : public LagrangianRheonomousR {
 public:
  explicit Surface(const Oscillator& o) : o_(o) { _hDot = std::make_shared<SiconosVector>(1); }
  void computeh(double s, const BlockVector& q, BlockVector&, SiconosVector& y) override {
    y(0) = o_.gap({q(0), 0.0, q(1), 0.0}, s);
  }
  void computeJachq(double s, const BlockVector& q, BlockVector&) override {
    (*_jachq)(0, 0) = -slope(s, q);
    (*_jachq)(0, 1) = 1.0;
  }
  void computehDot(double s, const BlockVector& q, BlockVector&) override { (*_hDot)(0) = -slope(s, q) * o_.eta; }

 private:
  double slope(double s, const BlockVector& q) const { return o_.slope(o_.c + o_.eta * s + q(0)); }

  const Oscillator& o_;
};

class Flights : public EventDriven {
 public:
  using EventDriven::EventDriven;
  void begin_again(double horizon) {
    _eventsManager = std::make_shared<EventsManager>(std::make_shared<TimeDiscretisation>(0.0, horizon));
    _eventsManager->initialize(2.0 * horizon);
    setIstate(1);
  }
  double reached() const { return _tout; }
};

// It explains its failures on standard output, where the table may go.
class Silence {
 public:
  Silence() : buffer_(std::cout.rdbuf(nullptr)) {}
  ~Silence() { std::cout.rdbuf(buffer_); }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  std::streambuf* buffer_;
};

class SiconosEvents {
 public:
  explicit SiconosEvents(double tolerance) : oscillator_(Model{}, 1.0, TipState{0.0, 0.0, 1.0, 1.0, 0.0}) {
    const int none = 0;
    xsetf_(&none);
    springs_ = std::make_shared<Springs>(oscillator_, 1.0);  // clear of the surface
    const auto system = std::make_shared<NonSmoothDynamicalSystem>(0.0, 1e9);
    system->insertDynamicalSystem(springs_);
    system->link(std::make_shared<Interaction>(std::make_shared<NewtonImpactNSL>(oscillator_.model.gamma),
                                               std::make_shared<Surface>(oscillator_)),
                 springs_);
    flights_ = std::make_shared<Flights>(system, std::make_shared<TimeDiscretisation>(0.0, 1.0));
    lsodar_ = std::make_shared<LsodarOSI>();
    flights_->insertIntegrator(lsodar_);
    flights_->insertNonSmoothProblem(std::make_shared<LCP>(), SICONOS_OSNSP_ED_IMPACT);
    flights_->insertNonSmoothProblem(std::make_shared<LCP>(), SICONOS_OSNSP_ED_SMOOTH_ACC);
    flights_->initialize();
    lsodar_->setTol(1, tolerance, tolerance);
    lsodar_->setIntData(5, 1);  // the options below are read
    lsodar_->setMaxNstep(1000000);
  }
  ~SiconosEvents() { flights_->clear(); }
  SiconosEvents(const SiconosEvents&) = delete;
  SiconosEvents& operator=(const SiconosEvents&) = delete;

  Hit next_impact(const Model& model, double eta, const TipState& start, double horizon) {
    const Oscillator& o = oscillator_ = Oscillator(model, eta, start);
    for (unsigned i = 0; i < 2; ++i) {
      (*springs_->q())(i) = o.begin[2 * i];
      (*springs_->velocity())(i) = o.begin[2 * i + 1];
    }
    const double first_look = o.first_look(grid(o));
    // first step, for a short bounce; longest step, for it looks for roots between steps only
    lsodar_->getRwork()[4] = first_look < grid(o) ? first_look : 0.0;
    lsodar_->getRwork()[5] = grid(o);
    flights_->begin_again(horizon);
    try {
      const Silence silence;
      flights_->advanceToEvent();
    } catch (const Siconos::exception&) {
      return {Hit::gave_up, 0.0, start, 0.0};  // it does not tell how far it came
    }
    const double s = flights_->reached();
    if (flights_->istate() < 3) return {Hit::none, horizon, o.tip_state(point(), horizon), 0.0};
    return reflect(o, point(), s);
  }

 private:
  Point point() const {
    const SiconosVector &q = *springs_->q(), &v = *springs_->velocity();
    return {q(0), v(0), q(1), v(1)};
  }

  Oscillator oscillator_;
  std::shared_ptr<Springs> springs_;
  std::shared_ptr<Flights> flights_;
  std::shared_ptr<LsodarOSI> lsodar_;
};

}  // namespace

MethodSpec siconos_spec() {
  return {"siconos", {1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14}, 1e-10, [](double tolerance) {
            return make_method<SiconosEvents>(tolerance);
          }};
}

}  // namespace afm::rivals
