// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds of a cone's curvature at each site within which maps agree with the prediction of the log scale.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "sites/log_scale_variance.hpp"

namespace lsgp {

class CurvatureBounds {
 public:
  // given: (n) curvature of cones whose angle is prescribed, NaN elsewhere.
  CurvatureBounds(const MetricMesh& surface, const Array<Site>& sites, const Eigen::VectorXd& given);

  // Bounds of a site's curvature, both of its cones together.  reach: how far a cone's curvature may be from the angle
  // defect that its vertex has anyway, in units of pi. From 1 on the bounds of its angle widen as well.
  double low(int site, double reach) const;
  double high(int site, double reach) const;

  double defect(int site) const { return defect_[site]; }  // of each of its vertices

 private:
  Eigen::VectorXd defect_, least_defect_, flat_, triangles_, given_;  // (sites)
  Eigen::VectorXi cones_;
};

constexpr double usual_reach = 0.6, wider_reach = 0.75, widest_reach = 8;

}  // namespace lsgp
