// SUNDIALS' CVODE with its own root finding, begun again after each impact: Adams' methods with fixed-point iteration,
// or backward differences with Newton's and the exact Jacobian. With minima the gap rate is a second root function: it
// makes CVODE evaluate the gap at its minima.
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <stdexcept>

#include "impact_law.h"

namespace afm::rivals {
namespace {

Point point_of(N_Vector v) {
  const double* d = N_VGetArrayPointer(v);
  return {d[0], d[1], d[2], d[3]};
}
void assign(N_Vector v, const Point& p) { std::copy(p.begin(), p.end(), N_VGetArrayPointer(v)); }

int rate(double, N_Vector v, N_Vector dvdt, void* user) {
  assign(dvdt, static_cast<const Oscillator*>(user)->rate(point_of(v)));
  return 0;
}
int gap(double s, N_Vector v, double* g, void* user) {
  *g = static_cast<const Oscillator*>(user)->gap(point_of(v), s);
  return 0;
}
int gap_and_rate(double s, N_Vector v, double* g, void* user) {
  const Oscillator& o = *static_cast<const Oscillator*>(user);
  const Point p = point_of(v);
  g[0] = o.gap(p, s);
  g[1] = o.gap_rate(p, s);
  return 0;
}
int jacobian(double, N_Vector, N_Vector, SUNMatrix J, void* user, N_Vector, N_Vector, N_Vector) {
  const Oscillator& o = *static_cast<const Oscillator*>(user);
  SM_ELEMENT_D(J, 0, 1) = SM_ELEMENT_D(J, 2, 3) = 1.0;
  SM_ELEMENT_D(J, 1, 0) = -o.wh2;
  SM_ELEMENT_D(J, 3, 2) = -o.wv2;
  return 0;
}

void check(int flag, const char* what) {
  if (flag < 0) throw std::runtime_error(std::string("CVODE: ") + what);
}

class Cvode {
 public:
  Cvode(int method, double tolerance, bool minima) {
    SUNContext_Create(nullptr, &context_);
    state_ = N_VNew_Serial(4, context_);
    assign(state_, {0.0, 0.0, 0.0, 0.0});
    cvode_ = CVodeCreate(method, context_);
    check(CVodeInit(cvode_, rate, 0.0, state_), "CVodeInit");
    check(CVodeSStolerances(cvode_, tolerance, tolerance), "CVodeSStolerances");
    if (method == CV_ADAMS) {
      fixed_point_ = SUNNonlinSol_FixedPoint(state_, 0, context_);
      check(CVodeSetNonlinearSolver(cvode_, fixed_point_), "CVodeSetNonlinearSolver");
    } else {
      matrix_ = SUNDenseMatrix(4, 4, context_);
      linear_ = SUNLinSol_Dense(state_, matrix_, context_);
      check(CVodeSetLinearSolver(cvode_, linear_, matrix_), "CVodeSetLinearSolver");
      check(CVodeSetJacFn(cvode_, jacobian), "CVodeSetJacFn");
    }
    int directions[] = {-1, 1};  // the gap falls, its rate rises
    check(CVodeRootInit(cvode_, minima ? 2 : 1, minima ? gap_and_rate : gap), "CVodeRootInit");
    check(CVodeSetRootDirection(cvode_, directions), "CVodeSetRootDirection");
    check(CVodeSetMaxNumSteps(cvode_, 1000000), "CVodeSetMaxNumSteps");
    CVodeSetErrFile(cvode_, nullptr);
    CVodeSetNoInactiveRootWarn(cvode_);
  }
  ~Cvode() {
    CVodeFree(&cvode_);
    if (fixed_point_ != nullptr) SUNNonlinSolFree(fixed_point_);
    if (linear_ != nullptr) SUNLinSolFree(linear_);
    if (matrix_ != nullptr) SUNMatDestroy(matrix_);
    N_VDestroy(state_);
    SUNContext_Free(&context_);
  }
  Cvode(const Cvode&) = delete;
  Cvode& operator=(const Cvode&) = delete;

  Hit next_impact(const Model& model, double eta, const TipState& start, double horizon) {
    Oscillator o(model, eta, start);
    assign(state_, o.begin);
    CVodeReInit(cvode_, 0.0, state_);
    CVodeSetUserData(cvode_, &o);
    CVodeSetMaxStep(cvode_, grid(o));  // it looks for roots between steps only
    const double first_look = o.first_look(grid(o));
    // a bounce shorter than its usual first step would be stepped over, and its root with it
    CVodeSetInitStep(cvode_, first_look < grid(o) ? first_look : 0.0);
    for (double s = 0.0;;) {
      const int flag = CVode(cvode_, horizon, state_, &s, CV_NORMAL);
      const Point p = point_of(state_);
      if (flag < 0) return {Hit::gave_up, s, o.tip_state(p, s), 0.0};
      if (flag != CV_ROOT_RETURN) return {Hit::none, horizon, o.tip_state(p, horizon), 0.0};
      int found[2] = {0, 0};
      CVodeGetRootInfo(cvode_, found);
      if (found[0] == 0) continue;  // a minimum above the surface
      if (s >= first_look && o.gap_rate(p, s) < 0.0) return reflect(o, p, s);
    }
  }

 private:
  SUNContext context_ = nullptr;
  N_Vector state_ = nullptr;
  void* cvode_ = nullptr;
  SUNNonlinearSolver fixed_point_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver linear_ = nullptr;
};

MethodSpec spec(const char* name, int method, bool minima, std::vector<double> settings) {
  return {name, std::move(settings), 1e-10,
          [=](double tolerance) { return make_method<Cvode>(method, tolerance, minima); }};
}

}  // namespace

std::vector<MethodSpec> cvode_specs() {
  return {spec("cvode_adams", CV_ADAMS, false, {1e-4, 1e-6, 1e-8, 1e-10, 1e-12}),
          spec("cvode_adams_minima", CV_ADAMS, true, {1e-4, 1e-6, 1e-8, 1e-10, 1e-12}),
          spec("cvode_bdf", CV_BDF, false, {1e-4, 1e-6, 1e-8, 1e-10})};
}

}  // namespace afm::rivals
