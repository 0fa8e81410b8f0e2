// The module afm._afm. Its Python face, with the documentation, is in python/afm.
#include "convert.h"

PYBIND11_MODULE(_afm, m) {
  m.doc() = "The library of afm_emulator; use it through the package afm.";
  afm::python::add_errors();
  afm::python::add_model(m);
  afm::python::add_tip(m);
  afm::python::add_ensemble(m);
  afm::python::add_run(m);
  afm::python::add_tables(m);
#ifdef AFM_DYNAMICS
  afm::python::add_studies(m);
#endif
}
