#include "method.h"

namespace afm {
namespace rivals {

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

}  // namespace rivals
}  // namespace afm
