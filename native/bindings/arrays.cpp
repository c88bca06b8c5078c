// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrays.hpp"

namespace py = pybind11;

void refuse(const char* code, const std::string& message) {
  const py::object type = py::module_::import("lsgp.errors").attr("InputError");
  const py::object exception = type(code, message);
  PyErr_SetObject(type.ptr(), exception.ptr());
  throw py::error_already_set();
}

void refuse_shape(const char* name, const py::array& array, const std::string& expected) {
  const auto shape = py::str(array.attr("shape")).cast<std::string>();
  refuse("WRONG_SHAPE", std::string(name) + " has shape " + shape + "; pass " + expected + ".");
}

View<std::int64_t, 1> view_of_sizes(const Places& sizes, std::int64_t least, std::int64_t corner_count) {
  const View<std::int64_t, 1> size("sizes", sizes, {any_length});
  std::int64_t left = corner_count;
  for (const std::int64_t of_polygon : size) {
    // Compared before they are subtracted, so that nothing overflows.
    if (of_polygon < least || of_polygon > left) {
      refuse("WRONG_PARAMETER", "sizes holds " + std::to_string(of_polygon) + "; pass numbers of corners, " +
                                    std::to_string(corner_count) + " together, of each polygon at least " +
                                    std::to_string(least) + ".");
    }
    left -= of_polygon;
  }
  if (left != 0) {
    refuse("WRONG_SHAPE", "sizes adds up to " + std::to_string(corner_count - left) + "; pass those of " +
                              std::to_string(corner_count) + " corners.");
  }
  return size;
}
