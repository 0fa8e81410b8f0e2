// Built where SUNDIALS was not found.
#include "method.h"

namespace afm {
namespace rivals {

std::vector<MethodSpec> cvode_specs() { return {}; }

}  // namespace rivals
}  // namespace afm
