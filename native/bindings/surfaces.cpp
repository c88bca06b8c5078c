// SPDX-License-Identifier: GPL-3.0-or-later
#include "surfaces.hpp"

std::vector<Index> to_vector(const char* name, const IndexArray& array) {
  const View<Index, 1> view(name, array, {any_length});
  return {view.begin(), view.end()};
}

Eigen::VectorXd to_vector_of_numbers(const char* name, const FloatArray& array) {
  const View<double, 1> view(name, array, {any_length});
  return Eigen::Map<const Eigen::VectorXd>(view.data(), view.size());
}

lsgp::CornerUv to_corner_uv(const FloatArray& array, py::ssize_t triangle_count) {
  const View<double, 3> view("corner_uv", array, {triangle_count, 3, 2});
  return Eigen::Map<const lsgp::CornerUv>(view.data(), 3 * view.length(), 2);
}

lsgp::Surface to_surface(const SurfaceArrays& arrays) {
  const auto& [positions, triangles, edges, seams, importance, cut_costs, borders, directions, features, may_collapse,
               scale] = arrays;
  lsgp::Surface surface;
  surface.positions = to_matrix<lsgp::Positions>("positions", positions);
  surface.triangles = to_matrix<lsgp::Triangles>("triangles", triangles);
  if (edges) surface.edges = to_matrix<lsgp::VertexPairs>("edges", *edges);
  surface.seams = to_matrix<lsgp::VertexPairs>("seams", seams);
  surface.borders = to_matrix<lsgp::VertexPairs>("borders", borders);
  surface.features = to_matrix<lsgp::VertexPairs>("features", features);
  surface.importance = to_vector_of_numbers("importance", importance);
  surface.cut_costs = to_vector_of_numbers("cut_costs", cut_costs);
  surface.directions = to_matrix<lsgp::Positions>("directions", directions);
  surface.may_collapse = may_collapse;
  surface.scale = to_vector_of_numbers("scale", scale);
  return surface;
}

lsgp::Cones to_cones(const ConeArrays& arrays) {
  const auto& [vertices, angles, has_angle] = arrays;
  const View<double, 1> angle("angles", angles, {any_length});
  const View<bool, 1> is_given("has_angle", has_angle, {angle.length()});
  lsgp::Cones cones{to_vector("cones", vertices), {}};
  for (py::ssize_t i = 0; i < angle.length(); ++i) {
    cones.angles.push_back(is_given(i) ? std::optional<double>(angle(i)) : std::nullopt);
  }
  return cones;
}

lsgp::Pins to_pins(const PinArrays& arrays) {
  const auto& [corners, uv] = arrays;
  return {to_vector("pinned corners", corners), to_matrix<lsgp::CornerUv>("pinned uv", uv)};
}
