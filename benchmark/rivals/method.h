// One interface for every method of the comparison: from a start to the next impact.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "afm/model.h"
#include "afm/state.h"

namespace afm::rivals {

struct Hit {
  // none: the horizon came first; gave_up: the method said that it cannot go on; diverged: it left all bounds
  enum Kind { impact, none, gave_up, diverged };
  Kind kind;
  double dt;             // [tau]
  TipState after;        // after the impact, or at the horizon
  double energy_loss;    // [m_tip a^2/tau^2]
  double contact = 0.0;  // an impact that takes time began so long before dt [tau]
};

// To the next impact. A start with gap 0 is a start just after an impact.
using Method = std::function<Hit(const Model& model, double eta, const TipState& start, double horizon)>;

// Of a class that keeps something from one flight to the next.
template <class T, class... Arguments>
Method make_method(const Arguments&... arguments) {
  return [kept = std::make_shared<T>(arguments...)](const auto&... flight) { return kept->next_impact(flight...); };
}

struct MethodSpec {
  std::string name;
  std::vector<double> settings;  // steps or tolerances, coarse to fine
  double usual;                  // the one a careful user would choose
  std::function<Method(double setting)> make;
};

// Those that this program was built with, ours first.
const std::vector<MethodSpec>& methods();
const MethodSpec* find_method(const std::string& name);

// Whether a name is among those that were chosen; without any all are.
bool is_chosen(const std::vector<std::string>& chosen, const std::string& name);
// Throws std::invalid_argument for a chosen name that is none of those that there are.
void check_names(const std::string& option, const std::vector<std::string>& chosen,
                 const std::vector<std::string>& there_are);

MethodSpec exact_spec();
MethodSpec certified_plain_spec();
MethodSpec sampled_spec();
MethodSpec sampled_minima_spec();
MethodSpec dopri5_spec();
MethodSpec dopri5_minima_spec();
MethodSpec bulirsch_stoer_spec();
std::vector<MethodSpec> cvode_specs();  // where SUNDIALS was found
MethodSpec heyoka_spec();               // where heyoka was found
MethodSpec siconos_spec();              // where Siconos was found
MethodSpec rk4_spec();
MethodSpec moreau_jean_spec();
MethodSpec semi_implicit_euler_spec();
MethodSpec penalty_spec();

}  // namespace afm::rivals
