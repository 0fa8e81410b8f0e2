# Quad precision, for tests and measurements: GCC's libquadmath where there is one; without it Boost computes in
# software.
include(CheckCXXSourceCompiles)
set(CMAKE_REQUIRED_LIBRARIES quadmath)
check_cxx_source_compiles("#include <boost/multiprecision/float128.hpp>
  int main() { return boost::multiprecision::float128(0) < 1 ? 0 : 1; }" AFM_HAVE_QUADMATH)
unset(CMAKE_REQUIRED_LIBRARIES)
add_library(afm_quad INTERFACE)
if(AFM_HAVE_QUADMATH)
  target_compile_definitions(afm_quad INTERFACE AFM_QUADMATH)
  target_link_libraries(afm_quad INTERFACE quadmath)
endif()
