// SPDX-License-Identifier: GPL-3.0-or-later
#include "unwrap/canonical_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <unordered_set>
#include <utility>

#include "mesh/canonical_order.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

namespace {

// Of the distance of the farthest corner from the middle. Turning a position loses about 2^-52, so that of 10,000
// coordinates one in a hundred times one is rounded to another quantum.
constexpr double quantum = 0x1p-32;
// Heights of triangles, in quanta, from which on rounding costs less than float32 does.
constexpr double least_height = 0x1p12;
constexpr double same_place = 1e-9;  // of that distance; above quanta
// Of it, the shortest side from which on turning leaves float32's digits.
constexpr double shortest_turned = 0x1p-28;

using Point = Eigen::RowVector3d;

// Of the corners of triangles that are part of the surface.
Point middle_of(const Surface& surface) {
  Point sum = Point::Zero();
  Index corners = 0;
  for (Index f = 0; f < surface.triangles.rows(); ++f) {
    if (is_collapsed(surface.triangles, f)) continue;
    for (int c = 0; c < 3; ++c) sum += surface.positions.row(surface.triangles(f, c));
    corners += 3;
  }
  return corners > 0 ? Point(sum / corners) : sum;
}

double farthest_from(const Surface& surface, const Point& middle) {
  double farthest = 0;
  for (Index f = 0; f < surface.triangles.rows(); ++f) {
    if (is_collapsed(surface.triangles, f)) continue;
    for (int c = 0; c < 3; ++c) {
      farthest = std::max(farthest, (surface.positions.row(surface.triangles(f, c)) - middle).norm());
    }
  }
  return farthest;
}

// Of those that are not 0.
double shortest_side_of(const Surface& surface) {
  double shortest = std::numeric_limits<double>::infinity();
  for (Index f = 0; f < surface.triangles.rows(); ++f) {
    for (int c = 0; c < 3; ++c) {
      const Point side =
          surface.positions.row(surface.triangles(f, c)) - surface.positions.row(surface.triangles(f, (c + 1) % 3));
      if (side.norm() > 0) shortest = std::min(shortest, side.norm());
    }
  }
  return shortest;
}

double least_height_of(const Surface& surface) {
  double least = std::numeric_limits<double>::infinity();
  for (Index f = 0; f < surface.triangles.rows(); ++f) {
    if (is_collapsed(surface.triangles, f)) continue;
    const auto side = [&](int c) -> Point {
      return surface.positions.row(surface.triangles(f, (c + 1) % 3)) - surface.positions.row(surface.triangles(f, c));
    };
    const double longest = std::max({side(0).norm(), side(1).norm(), side(2).norm()});
    least = std::min(least, longest > 0 ? side(0).cross(side(1)).norm() / longest : 0);
  }
  return least;
}

// Where the order of a component may begin, and its order from there. One-sided ones, which have no mesh, are taken as
// they are.
class ComponentOrder {
 public:
  explicit ComponentOrder(const Component& component)
      : component_(&component), firsts_(component.orientable ? outermost_halfedges(component.mesh) : Array<Index>()) {}

  // Of the places to begin that are alike, those at which a measure of corners is the largest.
  template <typename Measure>
  void prefer(double within, Measure measure) {
    keep_largest(firsts_, within, [&](Index h) { return measure(component_->source_corner(h)); });
  }
  template <typename Measure>
  void prefer_beside(double within, Measure measure) {
    keep_largest(firsts_, within, [&](Index h) { return measure(component_->source_corner(next(h))); });
  }

  Index first_corner() const {
    return component_->orientable ? component_->source_corner(firsts_.front())
                                  : 3 * component_->source_triangle.front();
  }

  // The corners with which triangles begin.
  Array<Index> corners() const {
    Array<Index> out;
    if (component_->orientable) {
      for (const Index h : triangles_from(component_->mesh, firsts_.front()))
        out.push_back(component_->source_corner(h));
    } else {
      for (const Index f : component_->source_triangle) out.push_back(3 * f);
    }
    return out;
  }

  std::size_t size() const { return component_->source_triangle.size(); }

 private:
  const Component* component_;  // not null
  Array<Index> firsts_;
};

// The x axis points to the first corner of some, the y axis from it to the first of those that are the farthest away.
// Nothing where all are on a line.
struct Pose {
  Point middle = Point::Zero();
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();
  double size = 1;

  Point of(const Point& given) const { return (given - middle) / size * frame; }
};

Pose pose_of(const Surface& surface, const Point& middle, double size, const Array<Index>& corners) {
  const auto at = [&](Index corner) -> Point {
    return surface.positions.row(surface.triangles.data()[corner]) - middle;
  };
  Pose out;
  const double first = at(corners.front()).norm();
  if (!(first > same_place * size)) return out;
  const Eigen::Vector3d axis = at(corners.front()).transpose() / first;
  const auto aside = [&](Index corner) -> Eigen::Vector3d {
    const Eigen::Vector3d from_middle = at(corner).transpose() / size;
    return from_middle - from_middle.dot(axis) * axis;
  };
  double most = 0;
  for (const Index corner : corners) most = std::max(most, aside(corner).norm());
  if (!(most > same_place)) return out;
  const Index farthest = *std::find_if(corners.begin(), corners.end(),
                                       [&](Index corner) { return aside(corner).norm() >= most - same_place; });
  out.middle = middle;
  out.size = size;
  out.frame.col(0) = axis;
  out.frame.col(1) = aside(farthest).normalized();
  out.frame.col(2) = out.frame.col(0).cross(out.frame.col(1));
  return out;
}

// The rows in ascending order of their pairs, whatever the order of a pair's vertices.
Array<Index> rows_in_order(const VertexPairs& pairs) {
  Array<std::tuple<Index, Index, Index>> keys;
  for (Index row = 0; row < pairs.rows(); ++row) {
    const auto [low, high] = std::minmax(pairs(row, 0), pairs(row, 1));
    keys.emplace_back(low, high, row);
  }
  std::sort(keys.begin(), keys.end());
  Array<Index> out;
  for (const auto& key : keys) out.push_back(std::get<2>(key));
  return out;
}

}  // namespace

CanonicalSurface::CanonicalSurface(const Surface& given) {
  std::vector<Finding> unsaid;
  const Topology topology = build_topology(given, {}, unsaid);
  const Point middle = middle_of(given);
  const auto position = [&](Index corner) -> Point { return given.positions.row(given.triangles.data()[corner]); };
  const auto distance = [&](Index corner) { return (position(corner) - middle).norm(); };
  Array<ComponentOrder> orders;
  for (const Component& component : topology.components) orders.emplace_back(component);
  const double size = farthest_from(given, middle);
  Pose pose;
  if (!orders.empty() && shortest_side_of(given) >= shortest_turned * size) {
    Array<ComponentOrder> from_middle = orders;
    double farthest = 0;
    for (ComponentOrder& order : from_middle) {
      order.prefer(same_place * size, distance);
      order.prefer_beside(same_place * size, distance);
      farthest = std::max(farthest, distance(order.first_corner()));
    }
    // The largest of those that reach as far.
    std::stable_sort(from_middle.begin(), from_middle.end(),
                     [](const ComponentOrder& a, const ComponentOrder& b) { return a.size() > b.size(); });
    const auto outermost = std::find_if(from_middle.begin(), from_middle.end(), [&](const ComponentOrder& order) {
      return distance(order.first_corner()) >= farthest - same_place * size;
    });
    pose = pose_of(given, middle, size, outermost->corners());
  }
  size_ = pose.size;
  // Places to begin that are alike are told apart by their directions, so that components that are moved copies begin
  // at the same one.
  for (ComponentOrder& order : orders) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto along = [&](Index corner) { return pose.of(position(corner))[axis]; };
      order.prefer(same_place, along);
      order.prefer_beside(same_place, along);
    }
  }
  // The larger components first, those as large by where they begin.
  const auto place = [&](const ComponentOrder& order) {
    // Far above rounding; of components closer to each other the order is left to chance.
    constexpr double apart = 1e-6;
    const Eigen::Array<double, 1, 3> at = (pose.of(position(order.first_corner())).array() / apart).round();
    return std::tuple(-static_cast<double>(order.size()), at[0], at[1], at[2]);
  };
  std::stable_sort(orders.begin(), orders.end(),
                   [&](const ComponentOrder& a, const ComponentOrder& b) { return place(a) < place(b); });
  Array<Index> corners;
  PerVertex<Index> anchor(given.positions.rows(), none);  // of its component
  for (const ComponentOrder& order : orders) {
    for (const Index corner : order.corners()) {
      corners.push_back(corner);
      for (Index at = corner, c = 0; c < 3; ++c, at = next(at)) {
        anchor[given.triangles.data()[at]] = given.triangles.data()[order.first_corner()];
      }
    }
  }
  number(given, corners);
  carry(given, pose.frame);
  for (Eigen::Index v = 0; v < given.positions.rows(); ++v) {
    surface_.positions.row(v) = pose.of(given.positions.row(source_vertex_[v]));
  }
  if (!(least_height_of(surface_) > least_height * quantum)) return;
  // Seen from where its component begins, so that moved copies remain copies.
  const auto rounded = [](const Point& point) -> Point { return (point / quantum).array().round() * quantum; };
  const Positions exact = surface_.positions;
  for (Eigen::Index v = 0; v < exact.rows(); ++v) {
    const Index source = anchor[source_vertex_[v]];
    const Point from = source == none ? Point(Point::Zero()) : Point(exact.row(own_vertex_[source]));
    surface_.positions.row(v) = rounded(from) + rounded(exact.row(v) - from);
  }
}

// corners: with which triangles begin, in their order; those in no component follow.
void CanonicalSurface::number(const Surface& given, const Array<Index>& corners) {
  const Index vertex_count = static_cast<Index>(given.positions.rows());
  const Index triangle_count = static_cast<Index>(given.triangles.rows());
  own_vertex_.assign(vertex_count, none);
  PerTriangle<char> is_numbered(triangle_count, 0);
  const auto take = [&](Index vertex) {
    if (own_vertex_[vertex] != none) return;
    own_vertex_[vertex] = static_cast<Index>(source_vertex_.size());
    source_vertex_.push_back(vertex);
  };
  const auto append = [&](Index corner) {
    is_numbered[corner / 3] = 1;
    source_corner_.push_back(corner);
    for (int c = 0; c < 3; ++c, corner = next(corner)) take(given.triangles.data()[corner]);
  };
  for (const Index corner : corners) append(corner);
  Array<std::pair<std::array<Index, 3>, Index>> others;
  for (Index f = 0; f < triangle_count; ++f) {
    if (is_numbered[f]) continue;
    std::array<Index, 3> own{};
    for (std::size_t c = 0; c < 3; ++c) {
      const Index known = own_vertex_[given.triangles(f, static_cast<Eigen::Index>(c))];
      own[c] = known == none ? vertex_count : known;
    }
    others.emplace_back(own, 3 * f);
  }
  std::sort(others.begin(), others.end());
  for (const auto& [own, corner] : others) append(corner);
  for (Index v = 0; v < vertex_count; ++v) take(v);
}

// All but the positions.
void CanonicalSurface::carry(const Surface& given, const Eigen::Matrix3d& frame) {
  surface_.positions.resize(given.positions.rows(), 3);
  surface_.triangles.resize(given.triangles.rows(), 3);
  for (Eigen::Index f = 0; f < given.triangles.rows(); ++f) {
    Index corner = source_corner_[f];
    for (Eigen::Index c = 0; c < 3; ++c, corner = next(corner)) {
      surface_.triangles(f, c) = own_vertex_[given.triangles.data()[corner]];
    }
  }
  surface_.may_collapse = given.may_collapse;
  if (given.edges) {
    const VertexPairs own = renumbered(*given.edges);
    const Array<Index> rows = rows_in_order(own);
    surface_.edges = own(rows, Eigen::all);
    if (given.cut_costs.size() > 0) surface_.cut_costs = given.cut_costs(rows);
  }
  surface_.seams = of(given.seams);
  surface_.borders = of(given.borders);
  surface_.features = of(given.features);
  const auto permuted = [&](const Eigen::VectorXd& at_vertices) {
    return at_vertices.size() > 0 ? Eigen::VectorXd(at_vertices(source_vertex_)) : at_vertices;
  };
  surface_.importance = permuted(given.importance);
  surface_.scale = permuted(given.scale);
  surface_.directions.resize(given.directions.rows(), 3);
  for (Eigen::Index f = 0; f < given.directions.rows(); ++f) {
    surface_.directions.row(f) = given.directions.row(source_corner_[f] / 3) * frame;
  }
}

VertexPairs CanonicalSurface::renumbered(VertexPairs pairs) const {
  for (Index& vertex : pairs.reshaped()) vertex = own_vertex_[vertex];
  return pairs;
}

VertexPairs CanonicalSurface::of(const VertexPairs& given) const {
  const VertexPairs own = renumbered(given);
  return own(rows_in_order(own), Eigen::all);
}

Cones CanonicalSurface::of(const Cones& given) const {
  Array<std::pair<Index, std::optional<double>>> own;
  for (std::size_t i = 0; i < given.vertices.size(); ++i) {
    own.emplace_back(own_vertex_[given.vertices[i]], given.angles[i]);
  }
  std::stable_sort(own.begin(), own.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  Cones out;
  for (const auto& [vertex, angle] : own) {
    out.vertices.push_back(vertex);
    out.angles.push_back(angle);
  }
  return out;
}

AutoUnwrapOptions CanonicalSurface::of(const AutoUnwrapOptions& given) const {
  AutoUnwrapOptions out = given;
  out.sharp = of(given.sharp);
  if (!out.map) return out;
  Options& of_map = out.map->of_map;
  for (auto& [vertex, turning] : of_map.loop_turning) {
    if (vertex >= 0 && vertex < ssize(own_vertex_)) vertex = own_vertex_[vertex];  // others are refused later
  }
  const bool has_size = of_map.seamless && of_map.seamless->tile_size;
  if (has_size && *of_map.seamless->tile_size > 0) *of_map.seamless->tile_size /= size_;  // others are refused later
  return out;
}

void CanonicalSurface::restore(std::vector<Index>& vertices) const {
  for (Index& vertex : vertices) vertex = source_vertex_[vertex];
}

void CanonicalSurface::restore(VertexPairs& pairs) const {
  for (Index& vertex : pairs.reshaped()) vertex = source_vertex_[vertex];
}

void CanonicalSurface::restore_sorted_triangles(std::vector<Index>& triangles) const {
  for (Index& triangle : triangles) triangle = source_corner_[triangle] / 3;
  std::sort(triangles.begin(), triangles.end());
}

// first: which come first.
void CanonicalSurface::restore_sorted(const std::vector<Index>& first, std::vector<Index>& cones,
                                      std::vector<double>& angles) const {
  restore(cones);
  const std::unordered_set<Index> is_first(first.begin(), first.end());
  Array<std::tuple<bool, Index, double>> keys;
  for (std::size_t i = 0; i < cones.size(); ++i) keys.emplace_back(is_first.count(cones[i]) == 0, cones[i], angles[i]);
  std::sort(keys.begin(), keys.end());
  for (std::size_t i = 0; i < keys.size(); ++i) std::tie(std::ignore, cones[i], angles[i]) = keys[i];
}

void CanonicalSurface::restore(Elements& elements) const {
  if (elements.kind == ElementKind::triangles) return restore_sorted_triangles(elements.indices);
  restore(elements.indices);
  if (elements.kind == ElementKind::vertices) std::sort(elements.indices.begin(), elements.indices.end());
}

void CanonicalSurface::restore(std::vector<Finding>& findings) const {
  for (Finding& finding : findings) restore(finding.elements);
}

void CanonicalSurface::restore(Eigen::VectorXd& at_vertices) const {
  const Eigen::VectorXd own = at_vertices;
  for (Eigen::Index v = 0; v < own.size(); ++v) at_vertices[source_vertex_[v]] = own[v];
}

void CanonicalSurface::restore(SeamlessReport& report) const {
  report.tile_size *= size_;
  for (SeamlessCut& cut : report.cuts) {
    cut.tail = source_vertex_[cut.tail];
    cut.head = source_vertex_[cut.head];
  }
  for (std::vector<Index>* vertices :
       {&report.flat_cones, &report.merged_cones, &report.relaxed_cones, &report.creases}) {
    restore(*vertices);
  }
}

void CanonicalSurface::restore(CornerUv& corner_uv) const {
  const CornerUv own = corner_uv;
  for (Eigen::Index f = 0; f < ssize(source_corner_); ++f) {
    Index corner = source_corner_[f];
    for (Eigen::Index c = 0; c < 3; ++c, corner = next(corner)) corner_uv.row(corner) = own.row(3 * f + c);
  }
}

void CanonicalSurface::restore(Result& result) const {
  const std::vector<Index> own_island = result.island;
  const Eigen::VectorXd own_errors = result.direction_errors;
  for (Eigen::Index f = 0; f < ssize(own_island); ++f) {
    const Index source = source_corner_[f] / 3;
    element(result.island, source) = element(own_island, f);
    if (own_errors.size() > 0) result.direction_errors[source] = own_errors[f];
  }
  restore(result.corner_uv);
  Array<Index> number(own_island.size(), none);
  Index islands = 0;
  for (Index& island : result.island) {
    if (island < 0) continue;
    if (number[island] == none) number[island] = islands++;
    island = number[island];
  }
  restore(result.cut_edges);
  restore(result.required_cuts);
  for (std::vector<Index>& path : result.cut_paths) {
    restore(path);
    if (path.size() < 2 || path.front() != path.back()) continue;
    // Loops begin at their lowest vertex.
    path.pop_back();
    std::rotate(path.begin(), std::min_element(path.begin(), path.end()), path.end());
    path.push_back(path.front());
  }
  restore_sorted({}, result.cones, result.cone_angles);
  for (std::vector<Index>* triangles : {&result.flipped, &result.overlapping}) restore_sorted_triangles(*triangles);
  restore(result.wrong_angle_sums);
  std::sort(result.wrong_angle_sums.begin(), result.wrong_angle_sums.end());
  restore(result.log_scale);
  if (result.seamless) restore(*result.seamless);
  if (result.features) {
    for (ReleasedFeature& feature : result.features->released) restore(feature.path);
  }
  restore(result.warnings);
}

void CanonicalSurface::restore(const Cones& given, Unwrapped& unwrapped) const {
  restore(unwrapped.result);
  restore(unwrapped.borders);
  if (unwrapped.packed_quickly) restore(*unwrapped.packed_quickly);
  if (!unwrapped.placement) return;
  restore_sorted(given.vertices, unwrapped.placement->cones, unwrapped.placement->cone_angles);
  restore(unwrapped.placement->log_scale);
  restore(unwrapped.placement->warnings);
}

Error CanonicalSurface::restored(const Error& error) const {
  Elements elements = error.elements();
  restore(elements);
  return {error.code(), error.what(), std::move(elements)};
}

}  // namespace lsgp
