// SPDX-License-Identifier: GPL-3.0-or-later
#include "new_arrays.hpp"

py::array_t<double> to_array(const Eigen::VectorXd& values) { return to_array(values.data(), {values.size()}); }

py::array_t<Index> to_array(const lsgp::VertexPairs& pairs) { return to_array(pairs.data(), {pairs.rows(), 2}); }

py::typing::List<IndexArray> to_arrays(const std::vector<std::vector<Index>>& lists) {
  py::typing::List<IndexArray> out;
  for (const std::vector<Index>& list : lists) out.append(to_array(list));
  return out;
}

py::object to_elements(const lsgp::Elements& elements) {
  const auto count = static_cast<py::ssize_t>(elements.indices.size());
  const bool pairs = elements.kind == lsgp::ElementKind::edges;
  return py::module_::import("lsgp.errors")
      .attr("Elements")(lsgp::name(elements.kind),
                        pairs ? to_array(elements.indices.data(), {count / 2, 2}) : to_array(elements.indices));
}

py::list to_findings(const std::vector<lsgp::Finding>& findings) {
  py::list out;
  const py::object type = py::module_::import("lsgp.errors").attr("Finding");
  for (const lsgp::Finding& finding : findings) {
    out.append(type(lsgp::name(finding.code), finding.message, to_elements(finding.elements)));
  }
  return out;
}
