#include <algorithm>
#include <stdexcept>

#include "method.h"

namespace afm::rivals {

const std::vector<MethodSpec>& methods() {
  static const std::vector<MethodSpec> all = [] {
    std::vector<MethodSpec> list{exact_spec(),  certified_plain_spec(), sampled_spec(),       sampled_minima_spec(),
                                 dopri5_spec(), dopri5_minima_spec(),   bulirsch_stoer_spec()};
#ifdef AFM_HAVE_HEYOKA
    list.push_back(heyoka_spec());
#endif
#ifdef AFM_HAVE_CVODE
    for (MethodSpec& spec : cvode_specs()) list.push_back(std::move(spec));
#endif
#ifdef AFM_HAVE_SICONOS
    list.push_back(siconos_spec());
#endif
    for (MethodSpec spec : {rk4_spec(), moreau_jean_spec(), semi_implicit_euler_spec(), penalty_spec()}) {
      list.push_back(std::move(spec));
    }
    return list;
  }();
  return all;
}

const MethodSpec* find_method(const std::string& name) {
  for (const MethodSpec& spec : methods()) {
    if (spec.name == name) return &spec;
  }
  return nullptr;
}

bool is_chosen(const std::vector<std::string>& chosen, const std::string& name) {
  return chosen.empty() || std::find(chosen.begin(), chosen.end(), name) != chosen.end();
}

void check_names(const std::string& option, const std::vector<std::string>& chosen,
                 const std::vector<std::string>& there_are) {
  for (const std::string& name : chosen) {
    if (is_chosen(there_are, name)) continue;
    std::string all;
    for (const std::string& other : there_are) all += " " + other;
    throw std::invalid_argument("--" + option + " " + name + ": unknown, or not built in; there are:" + all);
  }
}

}  // namespace afm::rivals
