// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/mirror.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <utility>

#include "base/checkpoint.hpp"
#include "mesh/point_tree.hpp"

namespace lsgp {

namespace {

constexpr double tolerance = 0.1;        // mean edge lengths between a vertex and the image of another
constexpr double near_tolerance = 0.02;  // of the diagonal of the surface's box, between its mirror image and itself
constexpr double paired_within = 0.5;    // mean edge lengths between a vertex and the image of another, then
constexpr double least_matched = 0.98;   // of the vertices of a symmetric surface
constexpr double likely_matched = 0.9;   // of some of them
constexpr double least_moved = 0.1;      // of the vertices, whose images are others
constexpr Index most_samples = 500;      // that judge a plane before all vertices do
// Of these, so many tell whether a plane is worth fitting to all: half of them have to be near their images, where in a
// likely plane nine tenths are, give or take three of a hundred.
constexpr std::size_t first_samples = 100;
constexpr double hopeful = 0.5;
constexpr int most_fits = 20;  // of a plane
constexpr double operations_a_search = 500;

// The distance of a point from a triangle.
double distance_to(const Eigen::RowVector3d& at, const Eigen::Matrix3d& corners) {
  const Eigen::RowVector3d a = corners.row(0), u = corners.row(1) - corners.row(0), v = corners.row(2) - corners.row(0);
  const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm(), det = uu * vv - uv * uv;
  const double pu = (at - a).dot(u), pv = (at - a).dot(v);
  const double s = vv * pu - uv * pv, t = uu * pv - uv * pu;
  if (det > 0 && s >= 0 && t >= 0 && s + t <= det) return (at - a - s / det * u - t / det * v).norm();
  double least = std::numeric_limits<double>::infinity();
  for (int c = 0; c < 3; ++c) {
    const Eigen::RowVector3d from = corners.row(c), along = corners.row((c + 1) % 3) - corners.row(c);
    const double length = std::max(along.squaredNorm(), 1e-300);
    const double step = std::clamp((at - from).dot(along) / length, 0.0, 1.0);
    least = std::min(least, (at - from - step * along).norm());
  }
  return least;
}

// A surface that is compared with its mirror images.
class MirroredSurface {
 public:
  explicit MirroredSurface(const MetricMesh& surface)
      : mesh_(surface.mesh),
        geometry_(surface.geometry),
        tree_(surface.mesh.positions),
        edge_(surface.geometry.length.mean()) {
    const HalfedgeMesh& mesh = surface.mesh;
    const Eigen::RowVector3d low = mesh.positions.colwise().minCoeff(), high = mesh.positions.colwise().maxCoeff();
    extent_ = (high - low).norm();
    const Index n = mesh.vertex_count(), count = std::min(n, most_samples);
    for (Index i = 0; i < count; ++i) {
      samples_.push_back(static_cast<Index>(static_cast<std::int64_t>(i) * n / count));
    }
  }

  Array<MirrorPlane> likely_planes() const {
    const Positions& positions = mesh_.positions;
    const Eigen::RowVector3d center = geometry_.vertex_area.transpose() * positions / geometry_.total_area;
    const Positions centered = positions.rowwise() - center;
    const Eigen::Matrix3d spread = centered.transpose() * geometry_.vertex_area.asDiagonal() * centered;
    const Eigen::Matrix3d principal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors();
    Array<MirrorPlane> planes;
    for (int i = 0; i < 3; ++i) planes.push_back({center.transpose(), Eigen::Vector3d::Unit(i)});
    for (int i = 0; i < 3; ++i) planes.push_back({center.transpose(), principal.col(i)});
    return planes;
  }

  // The images in the plane in which most vertices have one, or empty; those in a plane in which the surface lies come
  // last.
  Mirroring exact_images(const Array<MirrorPlane>& planes) const {
    Mirroring best;
    std::pair<bool, Index> most{false, needed(mesh_.vertex_count()) - 1};
    for (const MirrorPlane& plane : planes) {
      const auto is_matched = [&](Index v) { return near_image(plane, v) != none; };
      if (!is_likely(is_matched)) continue;
      PerVertex<Index> images = mutual_images(plane);
      const Index matched = count_matched(images);
      const std::pair worth{moves(images), matched};
      if (matched < needed(mesh_.vertex_count()) || worth <= most) continue;
      most = worth;
      best = {plane, std::move(images)};
    }
    return best;
  }

  // The same for the plane in which the surface is nearest to its own image, and in which it does not lie.
  Mirroring near_images(const Array<MirrorPlane>& planes) const {
    Mirroring best;
    double least = std::numeric_limits<double>::infinity();
    for (const MirrorPlane& plane : planes) {
      if (!is_likely([&](Index v) { return is_near(plane, v); })) continue;
      PerVertex<Index> images = paired(plane);
      if (!moves(images)) continue;
      Index matched = 0;
      double sum = 0;
      for (Index v = 0; v < mesh_.vertex_count(); ++v) {
        const double distance = gap(plane, v);
        matched += distance <= near_tolerance * extent_;
        sum += geometry_.vertex_area[v] * distance * distance;
        checkpoint(operations_a_search);
      }
      if (matched < needed(mesh_.vertex_count()) || !(sum < least)) continue;
      least = sum;
      best = {plane, std::move(images)};
    }
    return best;
  }

  // False where the surface lies in the plane of these images.
  static bool moves(const PerVertex<Index>& images) {
    Index moved = 0;
    for (std::size_t v = 0; v < images.size(); ++v) moved += images[v] != none && images[v] != static_cast<Index>(v);
    return moved >= least_moved * static_cast<double>(images.size());
  }

  // Moves a plane to where the images of samples are nearest to the surface, of few where hardly any of these get near
  // it by that.
  MirrorPlane fitted(const MirrorPlane& plane) const {
    if (samples_.size() <= first_samples) return fitted(plane, samples_);
    // By the golden section, since vertices are numbered row by row on a grid.
    const double section = (std::sqrt(5.0) - 1) / 2;
    Array<Index> few;
    for (std::size_t i = 0; i < first_samples; ++i) {
      const double place = section * static_cast<double>(i);
      few.push_back(
          samples_[static_cast<std::size_t>((place - std::floor(place)) * static_cast<double>(samples_.size()))]);
    }
    const MirrorPlane first = fitted(plane, few);
    const auto near = std::count_if(few.begin(), few.end(), [&](Index v) { return is_near(first, v); });
    return static_cast<double>(near) < hopeful * first_samples ? first : fitted(plane, samples_);
  }

 private:
  bool is_near(const MirrorPlane& plane, Index v) const { return gap(plane, v) <= near_tolerance * extent_; }

  // Nearest points and the best plane for them in turn (iterative closest points).
  MirrorPlane fitted(MirrorPlane plane, const Array<Index>& samples) const {
    Array<Index> image = samples;
    Positions from(image.size(), 3), to(image.size(), 3);
    for (std::size_t i = 0; i < image.size(); ++i)
      from.row(static_cast<Eigen::Index>(i)) = mesh_.positions.row(image[i]);
    for (int fit = 0; fit < most_fits; ++fit) {
      for (std::size_t i = 0; i < image.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        image[i] = tree_.nearest(reflected(plane, from.row(row)), image[i]).point;
        to.row(row) = mesh_.positions.row(image[i]);
      }
      const Eigen::RowVector3d middle = (from + to).colwise().mean() / 2;
      const Eigen::Matrix3d product = (from.rowwise() - middle).transpose() * (to.rowwise() - middle);
      const Eigen::Matrix3d both = product + product.transpose();
      const Eigen::Vector3d normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(both).eigenvectors().col(0);
      const MirrorPlane next{middle.transpose(), normal};
      const bool is_still = (reflected(next, from.row(0)) - reflected(plane, from.row(0))).norm() < 1e-6 * extent_;
      plane = next;
      if (is_still) break;
    }
    return plane;
  }

  static Index needed(Index count) { return static_cast<Index>(std::ceil(least_matched * count)); }
  static Index count_matched(const PerVertex<Index>& images) {
    return static_cast<Index>(images.size()) - static_cast<Index>(std::count(images.begin(), images.end(), none));
  }

  template <typename Test>
  bool is_likely(Test is_matched) const {
    const double least = likely_matched * static_cast<double>(samples_.size());
    std::ptrdiff_t left = ssize(samples_) - static_cast<std::ptrdiff_t>(std::ceil(least));
    return std::all_of(samples_.begin(), samples_.end(), [&](Index v) { return is_matched(v) || left-- > 0; });
  }

  bool are_alike(Index a, Index b) const {
    return (mesh_.loop_of_vertex[a] == none) == (mesh_.loop_of_vertex[b] == none);
  }

  Index near_image(const MirrorPlane& plane, Index v) const {
    const PointTree::Nearest found = tree_.nearest(reflected(plane, mesh_.positions.row(v)));
    return found.point != none && found.distance < tolerance * edge_ ? found.point : none;
  }

  PerVertex<Index> mutual_images(const MirrorPlane& plane) const {
    PerVertex<Index> image(mesh_.vertex_count());
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      image[v] = near_image(plane, v);
      checkpoint(operations_a_search);
    }
    PerVertex<Index> mutual = image;
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      if (image[v] == none || image[image[v]] != v || !are_alike(v, image[v])) mutual[v] = none;
    }
    return mutual;
  }

  // The distance of a vertex's image from the triangles around the vertex nearest to it, and those beside them.
  double gap(const MirrorPlane& plane, Index v) const {
    const Eigen::RowVector3d at = reflected(plane, mesh_.positions.row(v));
    const Index nearest = tree_.nearest(at).point;
    double least = std::numeric_limits<double>::infinity();
    if (nearest == none) return least;
    const auto measure = [&](Index f) {
      Eigen::Matrix3d corners;
      for (int c = 0; c < 3; ++c) corners.row(c) = mesh_.positions.row(mesh_.triangles(f, c));
      least = std::min(least, distance_to(at, corners));
    };
    mesh_.for_each_outgoing(nearest, [&](Index h) {
      measure(h / 3);
      const Index across = mesh_.twin[next(h)];
      if (across != none) measure(across / 3);
    });
    return least;
  }

  // Every vertex with that nearest to its image, the nearest pairs first.
  PerVertex<Index> paired(const MirrorPlane& plane) const {
    Array<std::tuple<double, Index, Index>> pairs;
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      const PointTree::Nearest found = tree_.nearest(reflected(plane, mesh_.positions.row(v)));
      const bool near = found.point != none && found.distance < paired_within * edge_;
      if (near && are_alike(v, found.point)) pairs.emplace_back(found.distance, v, found.point);
      checkpoint(operations_a_search);
    }
    std::sort(pairs.begin(), pairs.end());
    PerVertex<Index> image(mesh_.vertex_count(), none);
    for (const auto& [distance, v, other] : pairs) {
      if (image[v] != none || image[other] != none) continue;
      image[v] = other;
      image[other] = v;
    }
    return image;
  }

  const HalfedgeMesh& mesh_;
  const Geometry& geometry_;
  PointTree tree_;
  double edge_, extent_ = 0;
  Array<Index> samples_;
};

MirrorPlane with_unit_normal(MirrorPlane plane) {
  plane.normal = plane.normal.stableNormalized();
  return plane;
}

double mean_edge(const HalfedgeMesh& mesh) {
  double sum = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    sum += (mesh.positions.row(mesh.target(h)) - mesh.positions.row(mesh.origin(h))).norm();
  }
  return sum / std::max<Index>(mesh.halfedge_count(), 1);
}

// The vertex of `other` at the image of each vertex of `mesh`; empty unless all have one.
PerVertex<Index> images_on(const HalfedgeMesh& other, const HalfedgeMesh& mesh, const MirrorPlane& plane) {
  const PointTree tree(other.positions);
  const double most = tolerance * mean_edge(mesh);
  PerVertex<Index> image(mesh.vertex_count());
  PerVertex<char> is_image(other.vertex_count(), 0);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const PointTree::Nearest found = tree.nearest(reflected(plane, mesh.positions.row(v)));
    if (found.point == none || !(found.distance < most) || is_image[found.point]) return {};
    if ((mesh.loop_of_vertex[v] == none) != (other.loop_of_vertex[found.point] == none)) return {};
    is_image[found.point] = 1;
    image[v] = found.point;
    checkpoint(operations_a_search);
  }
  return image;
}

}  // namespace

Eigen::RowVector3d reflected(const MirrorPlane& plane, const Eigen::RowVector3d& at) {
  const Eigen::RowVector3d normal = plane.normal.transpose();
  return at - 2 * (at - plane.point.transpose()).dot(normal) * normal;
}

PerVertex<MirrorSide> find_mirror_sides(const HalfedgeMesh& mesh, const Mirroring& mirroring) {
  constexpr double nearer = 0.9;  // mirror images are equally near
  const auto height = [&](Index v) {
    return (mesh.positions.row(v) - mirroring.plane.point.transpose()).dot(mirroring.plane.normal);
  };
  PerVertex<MirrorSide> side(mesh.vertex_count());
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    side[v] = mirroring.image[v] == v ? MirrorSide::plane : height(v) < 0 ? MirrorSide::other : MirrorSide::own;
  }
  Array<Index> near;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    Index a = mesh.origin(h), b = mesh.target(h);
    if (side[a] == MirrorSide::other) std::swap(a, b);
    if (side[a] != MirrorSide::own || side[b] != MirrorSide::other) continue;
    near.push_back(-height(b) < nearer * height(a) ? b : a);
  }
  for (const Index v : near) side[v] = MirrorSide::plane;
  return side;
}

Index mirrored_halfedge(const HalfedgeMesh& mesh, const Mirroring& mirroring, Index h) {
  const Index from = mirroring.image[mesh.origin(h)], to = mirroring.image[mesh.target(h)];
  Index out = none;
  if (from == none || to == none) return out;
  mesh.for_each_outgoing(from, [&](Index g) {
    if (mesh.target(g) == to) out = g;
  });
  return out;
}

bool are_mirrored(const Mirroring& mirroring, const Array<Index>& vertices) {
  if (mirroring.empty()) return false;
  PerVertex<char> is_one(mirroring.image.size(), 0);
  for (const Index v : vertices) is_one[v] = 1;
  return std::all_of(vertices.begin(), vertices.end(),
                     [&](Index v) { return mirroring.image[v] != none && is_one[mirroring.image[v]]; });
}

Mirroring find_mirror_images(const MetricMesh& surface, const std::optional<MirrorPlane>& plane) {
  const MirroredSurface mirrored(surface);
  Array<MirrorPlane> planes = plane ? Array<MirrorPlane>{with_unit_normal(*plane)} : mirrored.likely_planes();
  Mirroring exact = mirrored.exact_images(planes);
  if (MirroredSurface::moves(exact.image) && !exact.empty()) return exact;
  if (!plane) {
    for (MirrorPlane& likely : planes) likely = mirrored.fitted(likely);
  }
  Mirroring near = mirrored.near_images(planes);
  return near.empty() ? exact : near;
}

PerComponent<MirroredComponent> find_mirrored_components(const PerComponent<Component>& components,
                                                         const std::optional<MirrorPlane>& plane) {
  const auto count = static_cast<Eigen::Index>(components.size());
  PerComponent<MirroredComponent> out(count);
  Positions centers = Positions::Zero(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    if (components[i].orientable) centers.row(i) = components[i].mesh.positions.colwise().mean();
  }
  Array<MirrorPlane> planes;
  if (plane) planes.push_back(with_unit_normal(*plane));
  for (int i = 0; i < 3 && !plane; ++i) planes.push_back({Eigen::Vector3d::Zero(), Eigen::Vector3d::Unit(i)});
  for (int i = 0; i < 3 && !plane; ++i) {
    planes.push_back({centers.colwise().mean().transpose(), Eigen::Vector3d::Unit(i)});
  }
  const PointTree tree(centers);
  for (Index i = 0; i < static_cast<Index>(count); ++i) {
    const HalfedgeMesh& mesh = components[i].mesh;
    for (const MirrorPlane& tried : planes) {
      const Index other = tree.nearest(reflected(tried, centers.row(i))).point;
      const bool is_earlier = other != none && other < i && out[other].of == none;
      if (!is_earlier || mesh.vertex_count() == 0) continue;
      const HalfedgeMesh& twin = components[other].mesh;
      if (twin.vertex_count() != mesh.vertex_count() || twin.triangle_count() != mesh.triangle_count()) continue;
      out[i].image = images_on(mesh, twin, tried);
      if (out[i].image.empty()) continue;
      out[i].of = other;
      break;
    }
  }
  return out;
}

}  // namespace lsgp
