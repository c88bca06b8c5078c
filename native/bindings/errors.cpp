// SPDX-License-Identifier: GPL-3.0-or-later
#include "errors.hpp"

#include <pybind11/pybind11.h>

#include <exception>
#include <new>

#include "lsgp/lsgp.hpp"
#include "new_arrays.hpp"

namespace {

const char* exception_name(lsgp::ErrorKind kind) {
  switch (kind) {
    case lsgp::ErrorKind::input: return "InputError";
    case lsgp::ErrorKind::topology: return "TopologyError";
    case lsgp::ErrorKind::curvature: return "CurvatureError";
    case lsgp::ErrorKind::solver: return "SolverError";
    case lsgp::ErrorKind::cancelled: return "Cancelled";
  }
  return "LsgpError";
}

// Or what Python raises meanwhile, as KeyboardInterrupt.
void raise_in_python(const lsgp::Error& error) {
  try {
    const py::object type = py::module_::import("lsgp.errors").attr(exception_name(lsgp::error_kind(error.code())));
    const py::object exception = type(lsgp::name(error.code()), error.what(), to_elements(error.elements()));
    PyErr_SetObject(type.ptr(), exception.ptr());
  } catch (py::error_already_set& raised) {
    raised.restore();
  }
}

}  // namespace

void translate_errors() {
  // Of this module alone: other modules have a std::bad_alloc, too.
  py::register_local_exception_translator([](std::exception_ptr pending) {
    try {
      if (pending) std::rethrow_exception(pending);
    } catch (const lsgp::Error& error) {
      raise_in_python(error);
    } catch (const py::cast_error&) {  // an option of another type, or a number that does not fit
      py::set_error(PyExc_TypeError, "An option has a type that it cannot have, or a number beyond its range.");
    } catch (const std::bad_alloc&) {
      raise_in_python({lsgp::Code::out_of_memory,
                       "There is not enough memory. Unwrap fewer faces at once, or close other programs."});
    }
  });
}
